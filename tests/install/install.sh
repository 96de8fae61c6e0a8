#!/bin/sh
# install.sh SOURCE BUILD: installs BUILD into a scratch prefix and uses it from outside. Environment:
# CMAKE, CC, CXX, PKG_CONFIG, SANITIZE, LIBDIR, PLUGINS (those which were built).
set -e
source=$1 build=$2 here=$(dirname "$0")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
prefix=$scratch/prefix
say() { echo "--- $*"; }
die() { echo "FAILED: $*"; exit 1; }
if [ -n "$SANITIZE" ]; then
    export CFLAGS="-fsanitize=$SANITIZE" CXXFLAGS="-fsanitize=$SANITIZE" \
        LDFLAGS="-fsanitize=$SANITIZE" ASAN_OPTIONS=detect_leaks=0
fi

say install
"$CMAKE" --install "$build" --prefix "$prefix" > "$scratch/log" || { cat "$scratch/log"; exit 1; }
mv "$prefix" "$scratch/moved" && prefix=$scratch/moved # nothing may depend on where it was
! grep -rIl -e "$source" -e "$build" "$prefix" || die "a path of the build tree was installed"
export LD_LIBRARY_PATH="$prefix/$LIBDIR"

say "plugin and program with find_package"
configure() { # folder name, then further options
    from=$1 to=$scratch/$2
    shift 2
    "$CMAKE" -S "$from" -B "$to" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_C_FLAGS="$CFLAGS" \
        -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF "$@" > "$scratch/log" 2>&1 &&
        "$CMAKE" --build "$to" >> "$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
}
template=$prefix/share/quadcover/template
configure "$template" plugin
configure "$template" headers_only -DHEADERS_ONLY=ON
configure "$here/consumer" consumer
mkdir "$scratch/cross" && ln -s "$prefix/$LIBDIR" "$scratch/cross/lib" # as Debian's /lib
configure "$here/consumer" crossed -DQuadCover_DIR="$scratch/cross/lib/cmake/QuadCover"
if [ -z "$SANITIZE" ] && command -v nm > /dev/null; then
    names=$(nm -D --defined-only "$scratch/plugin/smooth_field.so" | awk '$2 != "A" { print $3 }')
    [ "$names" = qc_plugin_1 ] || die "the plugin exports: $names"
fi
for kind in plugin headers_only; do
    "$scratch/consumer/consumer" "$scratch/$kind/smooth_field.so" > "$scratch/list"
    grep -q '^org.example.smooth_field 1.0$' "$scratch/list" || die "$kind: stage not listed"
    grep -q '^qc.hodge ' "$scratch/list" || die "built-in stages are missing"
done

for plugin in $PLUGINS; do
    say "plugin $plugin from the installed SDK"
    configure "$source/plugins/$plugin" "$plugin"
    names=$(nm -D --defined-only "$scratch/$plugin/qc_$plugin.so" | awk '$2 != "A" { print $3 }')
    [ "$names" = qc_plugin_1 ] || die "the plugin $plugin exports: $names"
    [ -f "$prefix/$LIBDIR/quadcover/plugins/qc_$plugin.so" ] || die "the plugin $plugin is not installed"
    [ "$plugin" != mumps ] || [ -x "$prefix/bin/qc-mumps-worker" ] || die "its worker is not installed"
done

if [ -n "$PKG_CONFIG" ]; then
    say "the backend of docs/solvers.md"
    sed -n '/^\/\* dense.c/,/^```$/p' "$source/docs/solvers.md" | sed '$d' > "$scratch/dense.c"
    export PKG_CONFIG_PATH="$prefix/$LIBDIR/pkgconfig"
    "$CC" $CFLAGS "$scratch/dense.c" $("$PKG_CONFIG" --cflags --libs qc) -llapacke -o "$scratch/dense"
    say "program with pkg-config"
    export PKG_CONFIG_PATH="$prefix/$LIBDIR/pkgconfig"
    "$CC" $CFLAGS "$here/consumer/consumer.c" $("$PKG_CONFIG" --cflags --libs qc) -o "$scratch/small"
    [ "$("$scratch/small" | head -n 1)" = "$("$PKG_CONFIG" --modversion qc)" ] || die "versions differ"
fi

quadcover=$prefix/bin/quadcover
[ -x "$quadcover" ] || { say "no program in this build"; exit 0; }
say "installed program with the plugin"
unset LD_LIBRARY_PATH # the program finds its library by itself
plugin=$scratch/plugin/smooth_field.so
"$quadcover" stages --plugin "$plugin" | grep -q org.example.smooth_field || die "stages: not listed"
"$quadcover" shape ellipsoid --resolution 2000 -o "$scratch/in.obj"
if [ -x "$scratch/dense" ]; then
    "$quadcover" shape ellipsoid --resolution 500 -o "$scratch/small.obj"
    (cd "$scratch" && LD_LIBRARY_PATH="$prefix/$LIBDIR" ./dense small.obj > dense.out) || die "docs/solvers.md"
    grep -q '^[0-9]* quads$' "$scratch/dense.out" || die "docs/solvers.md: $(cat "$scratch/dense.out")"
fi
if [ -n "$MUMPS" ]; then
    "$quadcover" remesh "$scratch/in.obj" -o "$scratch/mumps.obj" --quads 500 --progress none --mode fast \
        --plugin "$prefix/$LIBDIR/quadcover/plugins/qc_mumps.so" --set hodge.solver=mumps
fi
for pipeline in replace insert; do
    "$quadcover" remesh "$scratch/in.obj" -o "$scratch/$pipeline.obj" --set size.quads=500 \
        --plugin "$plugin" --pipeline "$here/$pipeline.json" --progress none
    "$quadcover" check "$scratch/$pipeline.obj" > "$scratch/check" || { cat "$scratch/check"; exit 1; }
done
! "$quadcover" remesh "$scratch/in.obj" -o "$scratch/no.obj" --pipeline "$here/insert.json" \
    2> "$scratch/error" || die "a stage without its plugin was accepted"
grep -q org.example.smooth_field "$scratch/error" || die "the error names no stage: $(cat "$scratch/error")"
[ ! -e "$scratch/no.obj" ] || die "a file was left by a failed run"

say examples
sh "$here/examples.sh" "$prefix"
