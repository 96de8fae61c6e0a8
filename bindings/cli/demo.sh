#!/bin/sh
# demo.sh PROGRAM [MESH] [QUADS]: remeshes MESH (default: a made knot) into demo/ and prints the figures.
set -eu
program=$1
mesh=${2:-}
quads=${3:-5000}

mkdir -p demo
if [ -z "$mesh" ]; then
    mesh=demo/knot.obj
    "$program" shape knot --noise 0.05 --retriangulate -o "$mesh"
fi
"$program" remesh "$mesh" -o demo/quads.obj --uv demo/uv.obj --stats demo/stats.json \
    --quads "$quads" --mode fast
echo
"$program" check demo/quads.obj --against "$mesh"
echo
echo "input              $mesh"
echo "quads              demo/quads.obj"
echo "parameterization   demo/uv.obj"
echo "statistics         demo/stats.json"
