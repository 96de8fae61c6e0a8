# The program with closest points by Embree, and strokes from rays with and without the plugin.
# remesh_test.sh QUADCOVER PLUGIN
plugin=$2
. "$(dirname "$0")/../cli/common.sh"
remesh="remesh in.obj --quads 600 --mode fast --progress none"
run 0 shape genus --genus 3 --resolution 2000 -o in.obj
run 0 $remesh -o builtin.obj --stats builtin.json
run 0 $remesh -o embree.obj --stats embree.json --plugin "$plugin" --set measure.closest=embree
same builtin.obj embree.obj "measured by Embree"
h=$(value builtin.json hausdorff_rel)
between "$(value embree.json hausdorff_rel)" "$(awk "BEGIN { printf \"%.15g\", $h - 1e-9 }")" \
    "$(awk "BEGIN { printf \"%.15g\", $h + 1e-9 }")" "Hausdorff distance"
run 0 $remesh -o finished.obj --plugin "$plugin" --set finish.closest=embree
[ "$(grep -c '^f ' finished.obj)" = "$(grep -c '^f ' builtin.obj)" ] || fail "other quads"
run 2 $remesh -o no.obj --set measure.closest=embree
error_says "no qc.closest_point/1 is called 'embree'" "load the plugin"

echo '{"strokes": [[[-0.3, -0.4, 5, 0, 0, -1], [0.3, 0.4, 5, 0, 0, -1]]]}' >rays.json
run 0 $remesh -o a.obj --stroke-rays rays.json
run 0 $remesh -o b.obj --stroke-rays rays.json --plugin "$plugin"
same a.obj b.obj "strokes by Embree"
finish
