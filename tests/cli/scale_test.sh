# The mesh scaled by 1e-6 and 1e6 gives the same connectivity.
. "$(dirname "$0")/common.sh"

for shape in knot sphere; do
    run 0 shape $shape --resolution 3000 --noise 0.02 -o one.obj
    run 0 remesh one.obj -o quads.obj --quads 1000 --mode fast
    grep '^f ' quads.obj >faces
    for factor in 1e-6 1e6; do
        awk -v s=$factor '$1 == "v" { printf "v %.17g %.17g %.17g\n", s * $2, s * $3, s * $4; next }
                          { print }' one.obj >scaled.obj
        run 0 remesh scaled.obj -o scaled_quads.obj --quads 1000 --mode fast
        grep '^f ' scaled_quads.obj >scaled_faces
        same faces scaled_faces "$shape times $factor"
    done
done
finish
