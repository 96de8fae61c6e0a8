# With --keep-materials every quad lies in one group and borders of groups are edges of quads.
. "$(dirname "$0")/common.sh"

# A cube of N x N squares on each side: a material for each side, and two on the one above, which
# meet along x = 1/2 in the middle of the plane.
cube() {
    awk -v n="$1" 'BEGIN {
        print "mtllib cube.mtl"
        for (s = 0; s < 6; s++) for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) {
            u = i / n; v = j / n
            if (s == 0) print "v", v, u, 0
            if (s == 1) print "v", u, v, 1
            if (s == 2) print "v", u, 0, v
            if (s == 3) print "v", v, 1, u
            if (s == 4) print "v", 0, v, u
            if (s == 5) print "v", 1, u, v
        }
        for (s = 0; s < 6; s++) for (i = 0; i < n; i++) {
            if (s != 1) print "usemtl side" s
            if (s == 1) print "usemtl " (i < n / 2 ? "left" : "right")
            for (j = 0; j < n; j++) {
                a = 1 + s * (n + 1) * (n + 1) + i * (n + 1) + j
                print "f", a, a + n + 1, a + n + 2, a + 1
            } } }'
}

# Every corner of a quad lies in the closed region of its material.
inside() {
    awk 'function ok(m, p) {
            x = X[p]; y = Y[p]; z = Z[p]; e = 1e-9
            if (m == "side0") return z < e
            if (m == "side2") return y < e
            if (m == "side3") return y > 1 - e
            if (m == "side4") return x < e
            if (m == "side5") return x > 1 - e
            if (m == "left") return z > 1 - e && x < 0.5 + e
            if (m == "right") return z > 1 - e && x > 0.5 - e
            return 0 }
        $1 == "v" { n++; X[n] = $2; Y[n] = $3; Z[n] = $4 }
        $1 == "usemtl" { m = $2; seen[m] = 1 }
        $1 == "f" { for (k = 2; k <= 5; k++) if (!ok(m, $k + 0)) bad++ }
        END { for (m in seen) kinds++; exit !(bad == 0 && kinds == 7) }' "$1"
}

cube 12 >cube.obj
run 0 remesh cube.obj -o kept.obj --quads 600 --mode fast --keep-materials --stats s.json
inside kept.obj || fail 'a quad leaves its material'
grep -q 'cross a border' err && fail "a warning: $(cat err)"
out=s.json
grep -q '"groups": true' s.json || fail 'no groups'
run 0 remesh cube.obj -o kept.obj --quads 600 --mode fast --keep-materials --sharp 180
inside kept.obj || fail 'a quad leaves its material without creases'
# A border which is not kept is named: a single face of its own material among coarse quads.
awk '/^f/ && ++n == 200 { print "usemtl spot"; print; print "usemtl left"; next } { print }' \
    cube.obj >spot.obj
run 0 remesh spot.obj -o kept.obj --quads 60 --mode fast --keep-materials
grep -q '^quadcover: warning: ' err || fail 'the lost border is not named'
run 2 remesh cube.obj -o kept.obj --keep-materials --no-features
error_says '--keep-materials'
finish
