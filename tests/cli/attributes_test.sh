# What the input has is kept from file to file: painted densities, weights and labels of a PLY.
. "$(dirname "$0")/common.sh"

# A grid of N x N squares over the unit square: quality 9 at its right half, weights 1 - x and x.
grid() {
    awk -v n="$1" 'BEGIN {
        print "ply\nformat ascii 1.0\nelement vertex " (n + 1) * (n + 1)
        print "property float x\nproperty float y\nproperty float z\nproperty uchar red"
        print "property uchar green\nproperty uchar blue\nproperty float quality"
        print "property double weight_0\nproperty double weight_1\nelement face " n * n
        print "property list uchar int vertex_indices\nproperty int group\nproperty int part"
        print "end_header"
        for (i = 0; i <= n; i++) for (j = 0; j <= n; j++)
            print i / n, j / n, 0, 255, int(255 * i / n), 0, (i > n / 2 ? 9 : 1), 1 - i / n, i / n
        for (i = 0; i < n; i++) for (j = 0; j < n; j++) {
            a = i * (n + 1) + j
            print 4, a, a + n + 1, a + n + 2, a + 1, 1 + (i >= n / 2), 70 + (i >= n / 2)
        } }'
}

grid 40 >in.ply
# the border only guides: along it a square without cones has quads of one size
run 0 remesh in.ply -o out.ply --format ply-ascii --quads 1000 --mode fast --set size.painted=true \
    --set size.gradation=0.5 --set features.hard=false
head -n 40 out.ply >out
out_says '^format ascii' '^property uchar green' '^property double weight_1' '^property int part' \
    '^property double quality' '^property int group'
vertices=$(sed -n 's/^element vertex //p' out.ply)
faces=$(sed -n 's/^element face //p' out.ply)
# columns of vertices: x y z, colours, quality, weights
sed '1,/^end_header/d' out.ply | head -n "$vertices" >vertices
sed '1,/^end_header/d' out.ply | tail -n +$((vertices + 1)) | head -n "$faces" >faces
awk '{ d = $8 + $9 - 1; e = $9 - $1; if (d * d > 1e-24 || e * e > 1e-12) exit 1
       g = $5 - 255 * $1; if (g * g > 4) exit 1 }' vertices || fail 'weights or colours'
awk '$6 != $7 - 69 { exit 1 }' faces || fail 'group and label differ'
# nine times the quads on the right half, less the transition
awk '{ n[$6]++ } END { exit !(n[2] > 4 * n[1] && n[1] > 20) }' faces || fail 'painted density'

# Binary is the default of .ply, text has the same numbers; OFF and OBJ by extension.
for name in a.ply b.off c.obj; do
    run 0 remesh in.ply -o "$name" --quads 300 --mode fast
    run 0 check "$name"
done
run 0 remesh in.ply -o - --format ply --quads 300 --mode fast
same out a.ply 'the format decides on standard output'
run 2 remesh in.ply -o d.obj --format plx
error_says '--format' 'closest: ply'
finish
