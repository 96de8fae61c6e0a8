# Every unusable input: exit status 3, one line which names the file, no output file.
. "$(dirname "$0")/common.sh"

# refused FILE TEXTS...
refused() {
    file=$1
    shift
    for command in remesh field; do
        run 3 "$command" "$file" -o result
        error_says "$file" "$@"
        [ -e result ] && fail "$file: $command left an output"
    done
}

: >empty.obj
refused empty.obj
refused missing.obj 'No such file'
mkdir folder.obj
refused folder.obj directory
printf 'v 0 0 0\nv nan 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n' >nan.obj
refused nan.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n' >index.obj
refused index.obj
printf 'these are not the meshes\nyou are looking for\n' >garbage.obj
refused garbage.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n' >two.obj
refused two.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\n' >points.obj
refused points.obj

# A strip of quads joined with a half turn.
awk 'BEGIN {
    n = 24
    for (i = 0; i < n; i++) {
        a = 2 * 3.14159265358979 * i / n
        for (s = -1; s <= 1; s += 2) {
            r = 1 + 0.3 * s * cos(a / 2)
            printf "v %.12g %.12g %.12g\n", r * cos(a), r * sin(a), 0.3 * s * sin(a / 2)
        }
    }
    for (i = 0; i < n; i++) {
        p = 2 * i + 1; q = p + 1
        r = i + 1 < n ? p + 2 : 2; s = i + 1 < n ? q + 2 : 1
        printf "f %d %d %d\nf %d %d %d\n", p, r, q, q, r, s
    }
}' >moebius.obj
refused moebius.obj

# A binary PLY which ends in the middle of its vertices.
{
    printf 'ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty float x\n'
    printf 'property float y\nproperty float z\nelement face 50\n'
    printf 'property list uchar int vertex_indices\nend_header\n'
    printf 'abcdefghijklmnopqrstuvwxyz'
} >truncated.ply
refused truncated.ply

# Three faces on one edge: repaired or refused, never a crash or a silent success.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n' >three.obj
"$quadcover" remesh three.obj -o result >out 2>err
status=$?
[ $status -eq 3 ] || [ $status -eq 1 ] || fail "three faces on an edge: status $status"

run 3 check missing.obj
error_says missing.obj
run 3 extract empty.obj -o result
error_says empty.obj
run 0 shape sphere --resolution 500 -o sphere.obj
run 3 extract sphere.obj -o result
error_says sphere.obj vt
run 3 remesh sphere.obj -o result --field missing.rawfield
error_says missing.rawfield
echo '4 3' >short.rawfield
run 3 remesh sphere.obj -o result --field short.rawfield
error_says short.rawfield
for parameter in features.strokes size.file; do
    run 3 remesh sphere.obj -o result --set $parameter=missing.file
    error_says missing.file
done
printf '1\nnan 2\n' >lengths.txt
run 3 remesh sphere.obj -o result --set size.file=lengths.txt
error_says 'lengths.txt:2' "'nan' is not a positive number"
run 1 check sphere.obj
error_says 'not a manifold of quads'
[ -e result ] && fail 'an output was left'
finish
