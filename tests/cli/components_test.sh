# Components are remeshed one by one at one density.
. "$(dirname "$0")/common.sh"

run 0 shape sphere --resolution 2000 -o a.obj
run 0 shape torus --resolution 2000 -o b.obj
n=$(grep -c '^v ' a.obj)
{
    grep -e '^v ' -e '^f ' a.obj
    awk -v n="$n" '$1 == "v" { print "v", $2 + 5, $3, $4 }
                   $1 == "f" { print "f", $2 + n, $3 + n, $4 + n }' b.obj
} >both.obj
run 0 remesh both.obj -o quads.obj --quads 2000 --mode fast --stats s.json --save-field f.rawfield
run 0 check quads.obj --against both.obj --json
between "$(value out components)" 2 2 components
between "$(value out euler)" 2 2 'Euler characteristic'
between "$(value out faces)" 1900 2100 'quads'
between "$(value out hausdorff_rel)" 0 0.02 'Hausdorff distance'
between "$(value s.json components)" 2 2 'components in the statistics'
between "$(value s.json genus)" 1 1 'genus in the statistics'
[ "$(head -n 1 f.rawfield)" = "4 $(grep -c '^f ' both.obj)" ] || fail 'size of the field'
run 0 remesh both.obj -o quads2.obj --quads 2000 --mode fast --field f.rawfield
run 0 check quads2.obj
finish
