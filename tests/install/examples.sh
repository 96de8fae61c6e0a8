#!/bin/sh
# examples.sh PREFIX: builds the installed examples against the SDK below PREFIX, by find_package and
# by pkg-config, runs them on made surfaces and checks what they promise. Environment: CMAKE, CC, CXX
# (or none), PKG_CONFIG (or none), LIBDIR, and flags of a sanitizer in CFLAGS, CXXFLAGS, LDFLAGS.
set -eu
prefix=$1 examples=$1/share/quadcover/examples
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
quadcover=$prefix/bin/quadcover
export LD_LIBRARY_PATH="$prefix/$LIBDIR" PKG_CONFIG_PATH="$prefix/$LIBDIR/pkgconfig"
die() { echo "FAILED: $*"; exit 1; }
quiet() { "$@" > "$scratch/log" 2>&1 || { cat "$scratch/log"; die "$*"; }; }

# Each folder is a project; the same sources by pkg-config, without a warning.
by_cmake=$scratch/cmake by_pkg_config=$scratch/pkg-config
mkdir "$by_pkg_config"
for folder in "$examples"/*/; do
    name=$(basename "$folder")
    if [ -z "$CXX" ] && [ -f "$folder/$name.cpp" ]; then continue; fi
    quiet "$CMAKE" -S "$folder" -B "$scratch/build/$name" -DCMAKE_PREFIX_PATH="$prefix" \
        -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_RUNTIME_OUTPUT_DIRECTORY="$by_cmake"
    quiet "$CMAKE" --build "$scratch/build/$name"
    [ -n "$PKG_CONFIG" ] || continue
    for source in "$folder"*.c "$folder"*.cpp; do
        case $source in
        *'*'*) continue ;;
        *.cpp) compiler="$CXX -std=c++17 ${CXXFLAGS:-}" ;;
        *) compiler="$CC -std=c11 ${CFLAGS:-}" ;;
        esac
        program=$by_pkg_config/$(basename "${source%.*}")
        quiet $compiler -Wall -Wextra -Wpedantic -Werror "$source" -o "$program" \
            $("$PKG_CONFIG" --cflags --libs qc) -lm
    done
done
[ -n "$PKG_CONFIG" ] || by_pkg_config=

"$quadcover" shape genus --genus 2 --resolution 2500 -o "$scratch/double.obj"
"$quadcover" shape torus --resolution 2500 -o "$scratch/torus.obj"
"$quadcover" remesh "$scratch/double.obj" -o "$scratch/program.obj" --uv "$scratch/uv.obj" \
    --quads 500 --mode fast --progress none
"$quadcover" extract "$scratch/uv.obj" -o "$scratch/extracted.obj"
geometry() { grep -v '^#' "$1"; }

# Mean of cos(4 angle) between the edges of quads and the parallels of the torus: 1 when they follow
# these, -1 when they lie across.
along() {
    awk '$1 == "v" { n++; x[n] = $2; y[n] = $3; z[n] = $4 }
        $1 == "f" { for (k = 2; k <= 5; k++) {
            a = $k + 0; b = $(k < 5 ? k + 1 : 2) + 0
            dx = x[b] - x[a]; dy = y[b] - y[a]; dz = z[b] - z[a]; mx = x[a] + x[b]; my = y[a] + y[b]
            c2 = (my * dx - mx * dy) ^ 2 / ((mx * mx + my * my) * (dx * dx + dy * dy + dz * dz))
            sum += 8 * c2 * c2 - 8 * c2 + 1; edges++ } }
        END { print sum / edges }' "$1"
}

for bin in $by_cmake $by_pkg_config; do
    cd "$bin"
    # field: the indices sum to 4 chi = -8 quarters, also one by one, and the file fits the mesh.
    ./field "$scratch/double.obj" double.rawfield > out
    grep -q 'sum to -8/4, Euler characteristic -2$' out || die "field: $(head -n 1 out)"
    awk '/ has index / { sum += $5; n++ } NR == 1 { count = $1 }
        END { exit !(sum == -8 && n == count) }' out || die "field: the list of singularities"
    "$quadcover" remesh "$scratch/double.obj" -o field.obj --field double.rawfield --quads 300 \
        --mode fast --progress none || die "field: the file is not read back"

    # extract: the quads of the program, to the last byte; topology of the surface.
    ./extract "$scratch/uv.obj" quads.obj > out
    grep -q '^Euler characteristic -2, that of the input -2$' out || die "extract: $(cat out)"
    geometry "$scratch/extracted.obj" > expected
    geometry quads.obj | cmp - expected || die "extract: other quads than the program"

    # poisson: second order in h; residuals of rounding errors only; the slit moves the solution and
    # closing it brings it back.
    ./poisson 40 > coarse && ./poisson 80 > fine
    awk '{ gsub(/,/, "") } /unknowns/ { error[++n] = $4; r = $6 } /^cut/ { r = $3; moved = $6 }
        /^closed/ { r = $3; back = $6 } { if (!(r < 1e-11)) bad = 1 }
        END { q = error[1] / error[2]
            exit bad || !(n == 2 && q > 3.5 && q < 4.5 && moved > 0.1 && back < 1e-10) }' \
        coarse fine || die "poisson: $(cat coarse fine)"
    ./hermitian > out # 2/7, 4/15, log 60
    printf 'x0 = 0.285714 +0.000000i\ny0 = 0.266667, log det = 4.094345\n' | cmp - out ||
        die "hermitian: $(cat out)"

    ./host > out
    grep -q '^cancelled, 0 bytes' out && grep -q '^0 bytes' out || die "host: $(cat out)"

    [ -n "$CXX" ] || continue
    # stage: valid quads, which follow the parallels of a torus or lie across.
    for degrees in 0 45; do
        ./stage "$scratch/torus.obj" "$degrees.obj" "$degrees" > out
        grep -q 'size -> hodge -> turn -> round' out || die "stage: $(cat out)"
        "$quadcover" check "$degrees.obj" > log || die "stage: $(cat log)"
        along "$degrees.obj" > "$degrees"
    done
    awk 'NR == 1 { a = $1 } END { exit !(a > 0.6 && $1 < -0.6) }' 0 45 ||
        die "stage: the quads were not turned: $(cat 0 45)"
    ! ./stage "$scratch/torus.obj" no.obj 1000 2> err || die "stage: 1000 degrees were accepted"
    grep -q angle err || die "stage: $(cat err)"
done
