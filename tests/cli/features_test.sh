# Creases and boundaries are edges of the quads by default: on shapes whose features are known, the lines of the
# quads lie on them before finishing, and all of each feature is covered.
. "$(dirname "$0")/common.sh"

# Lines of the quads: every vertex satisfies `on`; prints the numbers of vertices by degree as "2:N 3:M".
lines() {
    awk -v kind="$2" 'function on(x, y, z,  n) {
            n = (abs(x - lo[1]) < e || abs(x - hi[1]) < e) + (abs(y - lo[2]) < e || abs(y - hi[2]) < e)
            n += (z0 = (abs(z - lo[3]) < e || abs(z - hi[3]) < e))
            return kind == "box" ? n >= 2 : z0 }
        function abs(a) { return a < 0 ? -a : a }
        $1 == "v" { n++; for (k = 1; k <= 3; k++) { p[n, k] = $(k + 1)
            if (n == 1 || $(k + 1) < lo[k]) lo[k] = $(k + 1)
            if (n == 1 || $(k + 1) > hi[k]) hi[k] = $(k + 1) } }
        $1 == "l" { degree[$2 + 0]++; degree[$3 + 0]++ }
        END { e = 1e-6; for (v in degree) { bad += !on(p[v, 1], p[v, 2], p[v, 3]); count[degree[v]]++ }
              for (d = 1; d < 9; d++) if (count[d]) printf "%d:%d ", d, count[d]
              print bad ? "off: " bad : "on" }' "$1"
}

run 0 shape cube --resolution 2000 -o in.obj
run 0 remesh in.obj -o quads.obj --quads 600 --mode fast --set finish.rounds=0
out=$(lines quads.obj box)
expr "$out" : '2:[0-9]* 3:8 on$' >expr.out || fail "cube: $out"
for shape in cylinder truncated-cone; do
    run 0 shape $shape --resolution 3000 -o in.obj
    for quads in 300 3000; do
        run 0 remesh in.obj -o quads.obj --quads $quads --mode fast --set finish.rounds=0
        grep -q 'no edge of the quads' err && fail "$shape, $quads: $(cat err)"
        out=$(lines quads.obj rims)
        expr "$out" : '2:[0-9]* on$' >expr.out || fail "$shape, $quads: $out"
    done
done
run 0 remesh in.obj -o quads.obj --quads 300 --mode fast --set features.hard=false
grep -q '^l ' quads.obj && fail 'lines on features which only guide'
run 0 shape sphere --resolution 2000 --noise 0.05 -o in.obj
run 0 remesh in.obj -o quads.obj --quads 600 --mode fast
grep -q '^l ' quads.obj && fail 'noise has creases'
finish
