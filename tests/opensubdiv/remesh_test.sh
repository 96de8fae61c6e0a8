# The stage at the end of a pipeline: a report, and control points instead of the quads.
# remesh_test.sh QUADCOVER PLUGIN
plugin=$2
. "$(dirname "$0")/../cli/common.sh"
steps='{"stage": "qc.repair"}, {"stage": "qc.size", "params": {"quads": 500}}, {"stage": "qc.features"},
    {"stage": "qc.field.smoothest"}, {"stage": "qc.matching"}, {"stage": "qc.hodge"},
    {"stage": "qc.round"}, {"stage": "qc.untangle"}, {"stage": "qc.extract"}'
check='{"stage": "qc.check.opensubdiv", "params": {"fit": true, "json": "report.json"}}'
echo "{\"qc_pipeline\": 1, \"stages\": [ $steps ] }" >plain.json
echo "{\"qc_pipeline\": 1, \"stages\": [ $steps, $check ] }" >fit.json
run 0 shape torus --resolution 3000 -o in.obj
run 0 remesh in.obj -o plain.obj --pipeline plain.json --progress none
run 0 remesh in.obj -o fit.obj --pipeline fit.json --plugin "$plugin" --progress none
[ "$(grep -c '^f ' fit.obj)" = "$(grep -c '^f ' plain.obj)" ] || fail "other quads"
cmp -s fit.obj plain.obj && fail "the control points did not move"
[ "$(grep -c . report.json)" = 1 ] || fail "not one line in the report"
number() { sed -n "s/.*\"$1\": \\([-0-9.e]*\\)[,}].*/\\1/p" report.json; }
between "$(number mean_distance)" 0 "$(awk "BEGIN { print 0.5 * $(number mean_distance_before) }")" \
    "mean distance after the fit"
between "$(number min_jacobian)" 0.2 1 "Jacobian"
between "$(number reversed)" 0 0 "reversed samples"
finish
