# Thin front for CMake; every target first makes sure the packages are there.
PREFIX ?= /usr/local
MESH   ?=
QUADS  ?= 5000
PARTS  ?=
FIGURES ?=
JOBS   ?= $(shell nproc 2>/dev/null || echo 2)
# The one for which setup-debian.sh installs numpy.
PYTHON ?= $(firstword $(wildcard /usr/bin/python3) python3)

.PHONY: build setup browser demo check bench results corpus gallery format check-format install packages clean

build: setup
	cmake --preset release >/dev/null
	cmake --build build -j $(JOBS)

setup:
	@sh cmake/setup-debian.sh

# For the tests of --report, which are skipped without.
browser:
	-@sh cmake/setup-debian.sh chromium

# MESH=file.obj: remesh that; otherwise the knot of the 2007 paper, irregular and noisy.
demo: build
	@sh bindings/cli/demo.sh build/bin/quadcover "$(MESH)" "$(QUADS)"

# Formatting; clang without warnings; unit tests under ASan and UBSan, those of everything parallel under
# TSan; then all tests of the release build, whose summary is the last thing printed.
check: build browser check-format
	cmake --preset clang >/dev/null
	cmake --build build-clang -j $(JOBS)
	cmake --preset asan-ubsan >/dev/null
	cmake --build build-asan-ubsan -j $(JOBS)
	cd build-asan-ubsan && ctest -R '^unit/' -j $(JOBS) --output-on-failure
	cmake --preset tsan >/dev/null
	cmake --build build-tsan -j $(JOBS)
	cd build-tsan && ctest -R '^unit/(base|sparse|pipeline|field)' -j $(JOBS) --output-on-failure
	cd build && ctest -j $(JOBS) --output-on-failure

# The sparse factorisation against its peers (docs/performance.md is rewritten). A quarter of an hour; needs the
# meshes of QC_TEST_DATA and an otherwise idle machine.
bench: build
	sh tests/bench/common/page.sh docs/performance.md bench_sparse \
	    build/bin/bench_sparse --markdown --json build/bench_sparse.json

# The numbers of the thesis beside ours (docs/results.md and its figures are rewritten). A quarter of an hour;
# PARTS="table-6.1 acceptance" for some of it.
results: build
	sh tests/bench/thesis/results.sh build/bin docs/results.md docs/images/results $(PARTS)

# 300 generated models remeshed, and their part of docs/results.md; half an hour on two cores. Taken up where it was
# interrupted.
corpus: build
	$(PYTHON) tests/bench/corpus/corpus.py build/corpus --jobs $(JOBS)
	sh tests/bench/thesis/results.sh build/bin docs/results.md docs/images/results corpus

# The figures of the papers made again: docs/gallery/reports/index.html, small pictures and docs/gallery/README.md.
# FIGURES="2007-02 thesis-4.4-best" for some.
gallery: build browser
	python3 docs/gallery/make.py build/bin/quadcover $(FIGURES)

# Formatting of all tracked sources by .clang-format.
format check-format: setup
	sh cmake/format.sh $@

install: build
	cmake --install build --prefix "$(PREFIX)"

# Debian packages: build/packages/*.deb (docs/packages.md).
packages: build
	rm -f build/packages/*.deb
	cd build && cpack

clean:
	rm -rf build build-debug build-clang build-asan-ubsan build-tsan demo
