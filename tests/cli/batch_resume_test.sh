# Ended by Ctrl-C or killed in the middle: what is finished stays, the rest is done once.
. "$(dirname "$0")/batch_common.sh"

mkdir in
mesh in/a.obj 300
mesh in/b.obj 400
mesh in/c.obj 500
trouble "\"hang\": $(faces in/b.obj)"
touch hang
start() {
    "$quadcover" batch in -o res --pipeline pipeline.json --plugin "$plugin" --jobs 1 >out.txt 2>err &
    pid=$!
}
a_is_done() { grep -q '"name":"a"' res/results.jsonl 2>/dev/null && b_runs; }
b_runs() { [ -n "$(ls -d res/.batch/b.?????? 2>/dev/null)" ]; }
runs() { grep -qsa "$scratch/in/[b].obj" /proc/[0-9]*/cmdline; } # [b]: not grep itself
none_runs() { ! runs; }

start
wait_for 'the first mesh' a_is_done
wait_for 'the process of the second' runs
run 1 batch in -o res
error_says 'another batch'
kill -TERM $pid
wait $pid
status=$?
[ $status -eq 130 ] || fail "status $status: $(cat err)"
grep -q '^quadcover: error: interrupted' err || fail "message: $(cat err)"
wait_for 'the end of the second mesh' none_runs
once res a
first=$(ls -i res/a.obj)

start
wait_for 'the second mesh' b_runs
wait_for 'its process' runs
kill -KILL $pid
wait $pid 2>/dev/null
wait_for 'the end of the second mesh' none_runs
printf '{"name":"c","torn' >>res/results.jsonl
rm hang
run 0 batch in -o res --pipeline pipeline.json --plugin "$plugin"
once res a b c
[ "$(ls -i res/a.obj)" = "$first" ] || fail 'a finished mesh was done again'
for name in a b c; do run 0 check res/$name.obj; done
finish
