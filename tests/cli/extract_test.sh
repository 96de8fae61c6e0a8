# The parameterization which remesh writes gives the same quads again.
. "$(dirname "$0")/common.sh"

run 0 shape torus --resolution 2000 --noise 0.02 -o in.obj
run 0 remesh in.obj -o quads.obj --quads 600 --mode fast --uv uv.obj
run 0 extract uv.obj -o again.obj --stats s.json
grep '^f ' quads.obj >faces
grep '^f ' again.obj >faces_again
same faces faces_again 'quads extracted again'
between "$(value s.json flipped)" 0 0 flipped

# A plane grid with a parameter of 4 x 3 quads.
awk 'BEGIN {
    for (j = 0; j <= 6; j++) for (i = 0; i <= 8; i++) {
        printf "v %g %g 0\nvt %g %g\n", i / 8, j / 8, i / 2, j / 2 }
    for (j = 0; j < 6; j++) for (i = 0; i < 8; i++) {
        a = 9 * j + i + 1; b = a + 1; c = a + 9; d = c + 1
        printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a, b, b, d, d, a, a, d, d, c, c }
}' >grid.obj
run 0 extract grid.obj -o quads.obj
[ "$(grep -c '^f ' quads.obj)" -eq 12 ] || fail "$(grep -c '^f ' quads.obj) quads of a 4 x 3 grid"
run 0 check quads.obj
finish
