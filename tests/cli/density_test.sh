# The number of quads comes within 5 % of the target; lengths are meant as given.
. "$(dirname "$0")/common.sh"

for shape in sphere torus knot genus; do
    run 0 shape $shape --resolution 4000 -o in.obj
    for quads in 1000 3000; do
        run 0 remesh in.obj -o quads.obj --quads $quads --mode fast --stats s.json
        faces=$(grep -c '^f ' quads.obj)
        between "$faces" $((quads * 95 / 100)) $((quads * 105 / 100)) "$shape, $quads quads"
    done
done
run 0 shape sphere --resolution 3000 -o in.obj
run 0 remesh in.obj -o a.obj --edge-length 0.1 --mode fast
between "$(grep -c '^f ' a.obj)" 1050 1500 'edge length 0.1 on the unit sphere'
run 0 remesh in.obj -o b.obj --edge-length-rel 0.05 --mode fast
between "$(grep -c '^f ' b.obj)" 300 560 'relative edge length 0.05 on the unit sphere'

# More quads than can be numbered are refused before anything is computed.
for density in '--quads 1e9' '--edge-length 1e-300' '--edge-length-rel 1e-9'; do
    run 1 remesh in.obj -o c.obj $density
    error_says 'size: ' 'quads of edge length' 'are possible'
    [ ! -e c.obj ] || fail "$density left a file"
done
finish
