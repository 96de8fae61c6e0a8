# The pipeline of the 2007 paper: only quads on its surfaces, and at the flat points of the minimal
# ones (index -2/4: two of the trinoid, eight of the Schwarz P cell) what curvature lines have there.
. "$(dirname "$0")/common.sh"
case $0 in /*) here=$(dirname "$0") ;; *) here=$OLDPWD/$(dirname "$0") ;; esac
pipeline=$here/../../docs/pipelines/quadcover-2007.json

# remeshed NAME IRREGULAR EULER SHAPE-OPTIONS...
remeshed() {
    name=$1 irregular=$2 euler=$3
    shift 3
    run 0 shape "$name" -o in.obj "$@"
    run 0 remesh in.obj -o quads.obj --pipeline "$pipeline" --set size.quads=3000 --stats s.json
    between "$(value s.json non_quads)" 0 0 "$name: other polygons"
    between "$(value s.json flipped)" 0 0 "$name: flipped triangles"
    between "$(value s.json irregular)" "$irregular" "$irregular" "$name: irregular vertices"
    between "$(value s.json euler)" "$euler" "$euler" "$name: Euler characteristic"
    run 0 check quads.obj
}

remeshed knot 0 0 --noise 0.05 --retriangulate
remeshed hyperboloid 0 0
remeshed trinoid 2 -1
remeshed schwarz-p 8 -4

# Without merging each flat point stays a group of branch points.
run 0 remesh in.obj -o a.obj --pipeline "$pipeline" --set merge.lambda=0 --set size.quads=3000 --stats s.json
between "$(value s.json singularities)" 16 64 'branch points before merging'
finish
