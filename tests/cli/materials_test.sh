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
# Borders which zigzag along the edges of a curved surface: where two quads of different materials
# meet, their edge is one of the lines on features.
run 0 shape sphere --resolution 3000 -o sphere.obj
awk '$1 == "v" { n++; x[n] = $2; y[n] = $3; print }
     $1 == "f" { print "usemtl " (x[$2] + x[$3] + x[$4] > 0) (y[$2] + y[$3] + y[$4] > 0.9); print }' \
    sphere.obj >parts.obj
run 0 remesh parts.obj -o kept.obj --quads 1500 --mode fast --keep-materials
# the sides of quads cut off the teeth of a border which are finer than they
crossing=$(sed -n 's/.*warning: \([0-9]*\) quads cross a border.*/\1/p' err)
between "${crossing:-0}" 0 15 'quads which cross a border'
awk 'function key(a, b) { return a < b ? a " " b : b " " a }
     $1 == "usemtl" { m = $2 }
     $1 == "l" { line[key($2 + 0, $3 + 0)] = 1 }
     $1 == "f" { for (k = 2; k <= 5; k++) {
         e = key($k + 0, $(k == 5 ? 2 : k + 1) + 0)
         if (e in of && of[e] != m) border[e] = 1
         of[e] = m } }
     END { for (e in border) { n++; if (!(e in line)) bad++ }
           exit !(n > 50 && bad == 0) }' kept.obj || fail 'a border is no line of features'
# A border which cannot be kept is named, and so are the quads which cross it: a sector of 15
# degrees of a disk.
awk 'BEGIN {
    n = 24; rings = 8; print "v 0 0 0"
    for (r = 1; r <= rings; r++) for (i = 0; i < n; i++)
        print "v", r * cos(6.283185307 * i / n), r * sin(6.283185307 * i / n), 0
    for (i = 0; i < n; i++) {
        print "usemtl " (i == 3 ? "sector" : "rest")
        k = (i + 1) % n; print "f 1", 2 + i, 2 + k
        for (r = 1; r < rings; r++)
            print "f", 2 + (r - 1) * n + i, 2 + r * n + i, 2 + r * n + k, 2 + (r - 1) * n + k
    } }' >disk.obj
run 0 remesh disk.obj -o kept.obj --quads 200 --mode fast --keep-materials --stats s.json
grep -q '^quadcover: warning: features: ' err || fail "the lost border is not named: $(cat err)"
grep -q '^quadcover: warning: [0-9]* quads cross a border between groups' err ||
    fail "the quads are not named: $(cat err)"
grep -q 'cross a border' s.json || fail 'the statistics do not tell'
run 2 remesh cube.obj -o kept.obj --keep-materials --no-features
error_says '--keep-materials'
finish
