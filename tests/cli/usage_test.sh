# Help, version, unknown names and wrong values: exit status 2 and the closest name.
. "$(dirname "$0")/common.sh"

run 0 --version
out_says '^quadcover [0-9]*\.[0-9]*\.[0-9]*$'
out_says '^vector instructions: '
run 0 --help
out_says remesh extract field check stages shape batch
for command in remesh extract field check stages shape batch; do
    run 0 "$command" --help
    out_says "quadcover $command" --help
    [ -s err ] && fail "$command --help wrote to stderr"
done

run 2
error_says 'no command'
run 2 remseh
error_says "closest: remesh"
run 2 remesh in.obj -o out.obj --quats 5
error_says "closest: --quads"
run 2 remesh
error_says 'missing argument'
run 2 remesh a.obj b.obj -o out.obj
error_says "unexpected argument 'b.obj'"
run 2 remesh in.obj
error_says 'nothing to write'
run 2 remesh in.obj -o out.obj --quads many
error_says --quads many
run 2 remesh in.obj -o out.obj --quads -5
error_says 'out of range'
run 2 remesh in.obj -o out.obj --quads nan
error_says --quads
run 2 remesh in.obj -o out.obj --quads 100 --edge-length 1
error_says 'give one of'
run 2 remesh in.obj -o out.obj --mode fats
error_says 'closest: fast'
run 2 remesh in.obj -o out.obj --mode best --pipeline p.json
error_says --mode
run 2 remesh in.obj -o - --report -
error_says "only one output can go to '-'"
run 2 remesh in.obj -o out.obj --progress loud
error_says --progress
run 2 batch .
error_says "-o OUTDIR"

run 2 remesh in.obj -o out.obj --set round
error_says step.param=value
run 2 remesh in.obj -o out.obj --set ronud.radius=2
error_says round
run 2 remesh in.obj -o out.obj --set round.raduis=2
error_says radius
run 2 remesh in.obj -o out.obj --set round.radius=99
error_says radius
run 2 remesh in.obj -o out.obj --plugin ./nothing.so
error_says nothing.so
echo '{ "qc_pipeline": 1, "stages": [ { "stage": "qc.hogde" } ] }' >wrong.json
run 2 remesh in.obj -o out.obj --pipeline wrong.json
error_says wrong.json qc.hodge
echo '{ "qc_pipeline": 1, ' >broken.json
run 2 remesh in.obj -o out.obj --pipeline broken.json
error_says broken.json
run 2 remesh in.obj -o out.obj --pipeline missing.json
error_says missing.json

run 2 stages hogde
error_says hodge
run 2 shape shpere -o s.obj
error_says sphere
run 2 shape sphere
error_says -o
run 0 shape --list
out_says sphere knot costa
run 0 stages
out_says qc.repair qc.measure
run 0 stages hodge
out_says Inputs Outputs qc.hodge
run 0 stages --json
out_says '"id": "qc.size"' '"unit": "deg"' '"default"'
run 0 stages --markdown
out_says '^## qc.round' '^| parameter'
# the page of each stage names all its parameters
cp out stages.md
pages=$(cd "$(dirname "$0")/../../stages" && pwd)
awk '/^## /{s=$2;p=0} /^$/{p=0} /^\| parameter/{p=1;next} p&&/^\| `/{gsub(/`/,"",$2);print s,$2}' stages.md > parameters
[ "$(wc -l < parameters)" -gt 60 ] || fail 'parameters are missing'
while read -r stage name; do
    page=$(grep -l "^# .*$stage\>" "$pages"/*/*.md)
    [ -n "$page" ] || fail "no page for $stage"
    grep -q "\`[^\`]*\<$name\>" "$page" || fail "$page does not name $name of $stage"
done < parameters
[ -e out.obj ] && fail 'an output was written'
finish
