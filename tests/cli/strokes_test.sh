# Strokes and picking by camera rays: the field follows strokes; files which cannot be used are named.
. "$(dirname "$0")/common.sh"
remesh="remesh in.obj --quads 600 --mode fast --progress none --set features.angle=180"
run 0 shape sphere --resolution 2000 -o in.obj
echo '{"strokes": [[[-0.6, -0.2, 5, 0, 0, -1], [0.6, 0.3, 5, 0, 0, -1]], [[0, 2, 5, 0, 0, -1]]]}' >rays.json
run 0 $remesh --save-field plain.rawfield
run 0 $remesh --save-field stroke.rawfield --stroke-rays rays.json
grep -q unreferenced err && fail "points of strokes are reported as loose vertices"

# Mean angle in degrees between the crosses near the stroke and its direction, seen from above.
deviation() {
    awk 'function wrap(a) { while (a > 45) a -= 90; while (a < -45) a += 90; return a < 0 ? -a : a }
         FNR == NR && /^v / { for (k = 0; k < 3; k++) x[n, k] = $(k + 2); n++ }
         FNR == NR && /^f / { for (k = 0; k < 3; k++) v[m, k] = $(k + 2) - 1; m++ }
         FNR != NR && FNR > 1 {
             for (k = 0; k < 3; k++)
                 c[k] = (x[v[FNR - 2, 0], k] + x[v[FNR - 2, 1], k] + x[v[FNR - 2, 2], k]) / 3
             off = c[1] - 0.05 - c[0] / 2.4
             if (c[2] < 0 || c[0] < -0.5 || c[0] > 0.5 || off > 0.06 || off < -0.06) next
             sum += wrap((atan2($2, $1) - atan2(0.5, 1.2)) * 57.29577951)
             count++
         }
         END { print sum / count }' in.obj "$1"
}
between "$(deviation plain.rawfield)" 18 45 "field without strokes"
between "$(deviation stroke.rawfield)" 0 15 "field along the stroke"

# Picking: a cube from above, beside it, and from a corner.
cat >cube.obj <<'END'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
END
echo '{"strokes": [[[0.25, 0.125, 5, 0, 0, -2], [2, 2, 5, 0, 0, -1]], [[9, 9, 9, -1, -1, -1]]]}' >pick.json
run 0 pick cube.obj --rays pick.json --progress none
out_says '"face": 1' '"t": 2.0' '"vertex": 4' '"feature_distance": 0.125' null '"vertex": 6'
run 2 pick cube.obj
error_says "--rays"
run 3 pick cube.obj --rays nothing.json
error_says nothing.json

run 3 $remesh -o no.obj --stroke-rays nothing.json
error_says nothing.json
echo '{"strokes": [[[1, 2]' >bad.json
run 3 $remesh -o no.obj --stroke-rays bad.json
error_says bad.json "line 2"
echo '{"strokes": [[[0, 0, 5, 0, 0, -1], [1, 2, 3]]]}' >bad.json
run 3 $remesh -o no.obj --stroke-rays bad.json
error_says "ray 1 of stroke 0" "6 numbers"
echo '{"strokes": []}' >bad.json
run 3 $remesh -o no.obj --stroke-rays bad.json
error_says "no strokes"
echo '{"strokes": [[[0, 0, 5, 0, 0, 1], [0, 0.5, 5, 0, 0, 1]]]}' >bad.json
run 3 $remesh -o no.obj --stroke-rays bad.json
error_says "meet the surface"
finish
