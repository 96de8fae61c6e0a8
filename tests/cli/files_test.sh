# Standard input and output, unwritable places, the same bytes on one and two threads.
. "$(dirname "$0")/common.sh"

run 0 shape torus --resolution 2000 --noise 0.05 -o torus.obj
run 0 remesh torus.obj -o quads.obj --quads 500 --mode fast --threads 1 --uv uv.obj \
    --save-field f.rawfield
run 0 check quads.obj
[ -s err ] && fail "check wrote to stderr: $(cat err)"

"$quadcover" remesh - -o - --quads 500 --mode fast --threads 2 <torus.obj >piped.obj 2>err ||
    fail 'stdin to stdout'
[ -s err ] && fail "piping wrote to stderr: $(cat err)"
same quads.obj piped.obj 'stdin and stdout'
run 0 remesh torus.obj -o quads2.obj --quads 500 --mode fast --threads 2 --uv uv2.obj \
    --save-field f2.rawfield
same quads.obj quads2.obj 'threads'
same uv.obj uv2.obj 'threads'
same f.rawfield f2.rawfield 'threads'
run 0 field torus.obj -o f3.rosy
run 0 remesh torus.obj -o quads3.obj --quads 500 --mode fast --field f.rawfield
run 0 check quads3.obj --json
out_says '"valid": true'
run 2 remesh torus.obj -o - --uv - --mode fast
error_says "only one output"

run 1 remesh torus.obj -o nowhere/quads.obj --mode fast
error_says nowhere/quads.obj 'cannot write'
mkdir folder
run 1 remesh torus.obj -o folder --mode fast
error_says folder 'cannot write'
run 1 remesh torus.obj -o q4.obj --stats nowhere/s.json --mode fast
error_says nowhere/s.json
[ -e q4.obj ] && fail 'written although an output is impossible'
run 0 remesh torus.obj -o /dev/null --quads 500 --mode fast
[ -c /dev/null ] || fail '/dev/null replaced'

left=$(ls | grep -v -e "^[a-z0-9]*\.[a-z]*$" -e "^out$" -e "^err$" -e "^folder$")
[ -n "$left" ] && fail "files left: $left"
run 1 remesh torus.obj -o late.obj --quads 500 --mode fast --time-limit 0.0000001
error_says 'time limit'
[ -e late.obj ] && fail 'written although out of time'

for mode in relocate best; do
    for threads in 1 2; do
        run 0 remesh torus.obj -o $mode$threads.obj --quads 500 --mode $mode --threads $threads
    done
    cmp ${mode}1.obj ${mode}2.obj || fail "mode $mode depends on the number of threads"
done
run 0 remesh torus.obj -o quads.obj --quads 500
cmp quads.obj best1.obj || fail 'the default mode is not best'
finish
