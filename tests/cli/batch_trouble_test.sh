# A crash, a hang, a mesh without end of memory: each costs that mesh only.
. "$(dirname "$0")/batch_common.sh"

mkdir in
for n in 200 300 400 500; do mesh in/m$n.obj $n; done
trouble "\"crash\": $(faces in/m300.obj), \"eat\": $(faces in/m400.obj)"
run 1 batch in -o res --pipeline pipeline.json --plugin "$plugin" --memory 400 --jobs 2
error_says '2 of 4 meshes failed' m300 m400
once res m200 m300 m400 m500
[ "$(status_of res m200) $(status_of res m500)" = 'done done' ] || fail "good: $(cat res/results.jsonl)"
[ "$(status_of res m300)" = crashed ] || fail "crash: $(cat res/results.jsonl)"
[ "$(status_of res m400)" = memory ] || fail "memory: $(cat res/results.jsonl)"
grep -q '"message":"ended by signal 6"' res/results.jsonl || fail 'no signal'
grep -q '"message":"more than 400 MB"' res/results.jsonl || fail 'no limit'

# It ignores SIGTERM. What it left of an earlier success goes.
mkdir one && cp in/m500.obj one
run 0 batch one -o res1 --quads 150 --mode fast
touch hang
trouble "\"hang\": $(faces in/m500.obj)"
run 1 batch one -o res1 --pipeline pipeline.json --plugin "$plugin" --limit 1
once res1 m500
[ "$(status_of res1 m500)" = timeout ] || fail "hang: $(cat res1/results.jsonl)"
grep -q '"message":"more than 1 s"' res1/results.jsonl || fail 'no limit'
[ -e res1/m500.obj ] && fail 'an old result beside a failure'
finish
