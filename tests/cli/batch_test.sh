# batch: names, results, what is done again and what is not.
. "$(dirname "$0")/batch_common.sh"

mkdir -p in/a in/b
mesh in/a/x.obj 600
mesh in/b/x.obj 700
mesh 'in/with space.obj' 500
mesh in/.hidden.obj 500
echo garbage >in/bad.off
run 1 batch in -o in/out --quads 200 --mode fast --uv
error_says '1 of 4 meshes failed: bad' summary.html
once in/out a-x b-x 'with space' bad
[ "$(status_of in/out bad)" = input ] || fail 'status of the bad mesh'
[ -e in/out/bad.obj ] && fail 'a bad mesh has a result'
grep -q '"message":".*bad.off:1: ' in/out/results.jsonl || fail 'no message'
grep -q '<h2>Failures</h2>' in/out/summary.html || fail 'no failures in the summary'
[ "$(grep -c 'src="data:image/png;base64,' in/out/summary.html)" -eq 3 ] || fail 'no pictures in the summary'
grep -q 'href="with%20space.obj"' in/out/summary.html || fail 'no link in the summary'
for name in a-x b-x 'with space'; do
    [ "$(status_of in/out "$name")" = done ] || fail "status of $name"
    run 0 check "in/out/$name.obj"
    head -c 4 "in/out/picture/$name.png" | grep -q PNG || fail "no picture of $name"
    [ -s "in/out/uv/$name.obj" ] || fail "no map of $name"
    [ -s "in/out/$name.json" ] || fail "no statistics of $name"
done
run 0 remesh in/a/x.obj -o alone.obj --quads 200 --mode fast
same alone.obj in/out/a-x.obj 'batch or alone'

# The same again: only what failed. Other options, another input: again.
mark() { ls -i in/out/a-x.obj in/out/b-x.obj; }
before=$(mark)
run 1 batch in -o in/out --quads 200 --mode fast --uv --jobs 1 --threads 2
error_says '1 of 4 meshes failed: bad'
[ "$(mark)" = "$before" ] || fail 'a finished mesh was done again'
mesh in/bad.off 500
mesh in/a/x.obj 650
run 0 batch in -o in/out --quads 200 --mode fast --uv --progress plain
[ "$(wc -l <err)" -eq 2 ] || fail "not two meshes: $(cat err)"
once in/out a-x b-x 'with space' bad
run 0 batch in -o in/out --quads 250 --mode fast --uv --progress plain
[ "$(wc -l <err)" -eq 4 ] || fail "not all: $(cat err)"
rm 'in/out/with space.obj'
run 0 batch in -o in/out --quads 250 --mode fast --uv --progress plain
[ "$(wc -l <err)" -eq 1 ] || fail "not the one without an output: $(cat err)"
run 0 batch in -o in/out --quads 250 --mode fast --uv --progress plain --again
[ "$(wc -l <err)" -eq 4 ] || fail "not all again: $(cat err)"
echo garbage >in/b/y.off
run 1 batch in -o in/out --quads 250 --mode fast --uv --progress none
run 1 batch in -o in/out --quads 250 --mode fast --uv --progress plain --skip-failed
[ "$(wc -l <err)" -eq 1 ] || fail "a failure was tried again: $(cat err)"
error_says '1 of 5 meshes failed: y'

# Bytes which are no text, in a file and in a message about it.
mkdir bytes
printf 'OFF\n\377\376 3 4\n' >bytes/x.off
run 1 batch bytes -o bytes/out
grep -q "instead of '??'" bytes/out/results.jsonl || fail "message: $(cat bytes/out/results.jsonl)"

# Lists: from a file and from standard input; a mesh named twice is done once.
printf '%s\n' in/a/x.obj in/b/x.obj '' 'in/with space.obj' in/a/../a/x.obj >list.txt
run 0 batch list.txt -o listed --quads 200 --mode fast
once listed a-x b-x 'with space'
"$quadcover" batch - -o listed --quads 200 --mode fast --progress plain <list.txt 2>err || fail stdin
[ -s err ] && fail "a list from stdin is another one: $(cat err)"

# Long names share their beginning.
long=$(printf 'm%.0s' $(seq 120))
mkdir long
mesh long/${long}1.obj 500
mesh long/${long}2.obj 500
run 0 batch long -o named --quads 200 --mode fast
[ "$(ls named/*.obj | wc -l)" -eq 2 ] || fail "long names: $(ls named)"

# {in} and {name}: a field for each mesh.
run 0 batch in/b/x.obj -o fields --quads 200 --mode fast --save-field
cp fields/field/x.rawfield in/b/x.rawfield
run 0 batch in/b/x.obj -o fields --quads 200 --mode fast --field '{in}.rawfield'
[ -e fields/field/x.rawfield ] && fail 'a file of other options beside a result'
grep -q '"exit":0' fields/results.jsonl || fail 'no field'

# Other formats have other extensions.
run 0 batch in/b/x.obj -o fields --quads 200 --mode fast --format ply-ascii --uv
[ "$(head -n 2 fields/x.ply | tr '\n' ' ')" = 'ply format ascii 1.0 ' ] || fail 'no PLY'
[ -s fields/uv/x.ply ] || fail 'no map as PLY'
[ -e fields/x.obj ] && fail 'OBJ beside PLY'
grep -q 'href="x.ply"' fields/summary.html || fail 'no link to PLY'
run 0 batch in/b/x.obj -o fields --quads 200 --mode fast --format ply-ascii --uv --progress plain
[ -s err ] && fail "PLY was made again: $(cat err)"

# Wrong usage costs nothing.
cp in/out/results.jsonl kept
before=$(mark)
run 2 batch in -o in/out --quads 200 --set x.y=3
error_says "no step 'x'"
same kept in/out/results.jsonl 'results after wrong usage'
[ "$(mark)" = "$before" ] || fail 'wrong usage removed results'
run 2 batch in -o in
error_says 'a folder of their own'
run 2 batch in
error_says '-o OUTDIR'
run 2 batch in -o out2 --quats 5
error_says 'closest: --quads'
run 2 batch in -o out2 --stats s.json
run 3 batch nowhere -o out2
error_says nowhere
mkdir empty
run 3 batch empty -o out2
error_says 'no meshes'
finish
