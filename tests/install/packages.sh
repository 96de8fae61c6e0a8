#!/bin/sh
# packages.sh SOURCE BUILD: makes the Debian packages of BUILD, looks into them, unpacks them into a
# root of their own and works there. Environment: that of install.sh and examples.sh; CPACK, PYTHON
# (none when the module was not built).
set -eu
source=$1 build=$2 here=$(dirname "$0")
[ -f "$build/CPackConfig.cmake" ] || { echo "no tools for Debian packages"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
say() { echo "--- $*"; }
die() { echo "FAILED: $*"; exit 1; }
quiet() { "$@" > "$scratch/log" 2>&1 || { cat "$scratch/log"; die "$*"; }; }

say "make the packages"
debs=$scratch/debs root=$scratch/image prefix=$scratch/image/usr
quiet "$CPACK" --config "$build/CPackConfig.cmake" -D CPACK_PACKAGE_DIRECTORY="$scratch/work" \
    -D CPACK_OUTPUT_FILE_PREFIX="$debs" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip
! grep -i warning "$scratch/log" || die "cpack warns"
expected="libquadcover-dev libquadcover0 quadcover"
[ -z "$PYTHON" ] || expected="$expected python3-quadcover"
for plugin in $PLUGINS; do expected="$expected quadcover-plugin-$plugin"; done
found=$(for deb in "$debs"/*.deb; do dpkg-deb -f "$deb" Package; done | sort | tr '\n' ' ')
[ "$found" = "$(echo "$expected" | tr ' ' '\n' | sort | tr '\n' ' ')" ] || die "packages: $found"

say "what they need"
mkdir -p "$root"
version=$(dpkg-deb -f "$debs"/libquadcover0_*.deb Version)
for deb in "$debs"/*.deb; do
    package=$(dpkg-deb -f "$deb" Package)
    dpkg-deb -f "$deb" Depends | tr ',' '\n' | sed 's/^ *//' > "$scratch/$package.depends"
    dpkg-deb -c "$deb" | awk '$1 !~ /^d/ { print $6 }' | sed 's|^\./usr/||' > "$scratch/$package.files"
    dpkg-deb -c "$deb" | awk '$2 != "root/root" { exit 1 }' || die "$package: not owned by root"
    for file in copyright changelog.gz; do
        grep -qx "share/doc/$package/$file" "$scratch/$package.files" || die "$package: no $file"
    done
    [ "$package" = libquadcover0 ] ||
        grep -qx "libquadcover0 (= $version)" "$scratch/$package.depends" ||
        die "$package does not depend on its library: $(cat "$scratch/$package.depends")"
    dpkg-deb -x "$deb" "$root"
done
needs() { # package, then others
    package=$1
    shift
    for other; do
        grep -q "^$other\( \|$\)" "$scratch/$package.depends" || die "$package: not on $other"
    done
}
needs libquadcover0 libc6 libamd2 libjansson4 liblapacke
needs quadcover libc6 libpopt0
dpkg-deb -I "$debs"/libquadcover0_*.deb shlibs | grep -qx "libquadcover 0 libquadcover0 (= $version)" ||
    die "libquadcover0: shlibs"

say "all that is installed otherwise, and in one package only"
quiet "$CMAKE" --install "$build" --prefix "$scratch/installed"
(cd "$scratch/installed" && find . ! -type d | sed 's|^\./||' | grep -v '^share/doc/' | sort) > "$scratch/installed.files"
sort "$scratch"/libquadcover*.files "$scratch"/quadcover*.files | grep -v '^share/doc/' |
    diff "$scratch/installed.files" - || die "packages (>) differ from the installation (<)"
! grep -rIl -e "$source" -e "$build" "$root" || die "a path of the build tree is in a package"
for file in $(find "$root" -name '*.so*' -type f) "$prefix"/bin/*; do
    case $(readelf -d "$file" | sed -n 's/.*R.*PATH.*\[\(.*\)\]/\1/p') in
    '' | '$ORIGIN/'*) ;;
    *) die "$file looks for libraries elsewhere: $(readelf -d "$file" | grep PATH)" ;;
    esac
done

say "the packages in use"
[ "$(PKG_CONFIG_PATH=$prefix/$LIBDIR/pkgconfig "$PKG_CONFIG" --modversion qc)" = "$version" ] || die "qc.pc: version"
variable=$(PKG_CONFIG_PATH=$prefix/$LIBDIR/pkgconfig "$PKG_CONFIG" --variable=prefix qc)
[ "$(cd "$variable" && pwd -P)" = "$(cd "$prefix" && pwd -P)" ] || die "qc.pc: prefix is $variable"
gzip -dc "$prefix/share/man/man1/quadcover.1.gz" | grep -q 'edge\\-length' || die "the manual page"
for plugin in $PLUGINS; do
    quiet "$prefix/bin/quadcover" stages --plugin "$prefix/$LIBDIR/quadcover/plugins/qc_$plugin.so"
done
sh "$here/examples.sh" "$prefix"
if [ -n "$PYTHON" ]; then
    needs python3-quadcover python3 python3-numpy python3-cffi
    cd "$scratch"
    PYTHONPATH=$prefix/lib/python3/dist-packages LD_LIBRARY_PATH=$prefix/$LIBDIR \
        "$PYTHON" -B - "$prefix" "$version" << 'END' || die "the Python module"
import pathlib, sys
import quadcover
prefix, version = sys.argv[1:]
assert quadcover.__version__ == version
assert pathlib.Path(quadcover.__file__).is_relative_to(prefix)
loaded = [line.split()[-1] for line in open("/proc/self/maps") if "libquadcover" in line]
assert loaded and all(path.startswith(prefix) for path in loaded), loaded
mesh = quadcover.shape("torus", resolution=1000)
matching = quadcover.stages.matching(field=quadcover.stages.field_smoothest(mesh=mesh))
assert matching.index4.sum() == 0
END
fi
