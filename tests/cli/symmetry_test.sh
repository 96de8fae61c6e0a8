# One half is remeshed and mirrored: vertices and faces come in pairs, without a seam; else the whole is, with a warning.
. "$(dirname "$0")/common.sh"

# symmetric FILE COLUMN TWICE: reflecting column c, x -> TWICE - x, maps the set of vertices and that of faces
# onto themselves.
symmetric() {
    awk -v c="$2" -v twice="$3" '
        $1 == "v" { p[++n] = sprintf("%.17g %.17g %.17g", $2, $3, $4)
                    $c = twice - $c; q[n] = sprintf("%.17g %.17g %.17g", $2 + 0, $3 + 0, $4 + 0)
                    if (p[n] in at) exit 1
                    at[p[n]] = n }
        $1 == "f" { m++; for (k = 0; k < 4; k++) { split($(k + 2), a, "/"); f[m, k] = a[1] } }
        # the smallest vertex first, in the order of the corners
        function key(a, b, c, d) {
            while (a > b || a > c || a > d) { t = a; a = b; b = c; c = d; d = t }
            return a " " b " " c " " d
        }
        END {
            for (i = 1; i <= n; i++) { if (!(q[i] in at)) exit 1; r[i] = at[q[i]]; on += r[i] == i }
            for (i = 1; i <= m; i++) there[key(f[i, 0], f[i, 1], f[i, 2], f[i, 3])] = 1
            for (i = 1; i <= m; i++)
                if (!(key(r[f[i, 3]], r[f[i, 2]], r[f[i, 1]], r[f[i, 0]]) in there)) exit 1
            exit on == 0 }' "$1" || fail "$1 is not symmetric"
}

# shape resolution axis column euler
while read -r shape resolution axis column euler; do
    run 0 shape $shape --resolution $resolution -o in.obj
    run 0 remesh in.obj -o a.obj --quads 800 --symmetry $axis --stats s.json --uv uv.obj --threads 1
    symmetric a.obj $column 0
    run 0 check a.obj
    [ "$(value s.json euler)" = "$euler" ] || fail "$shape: Euler characteristic $(value s.json euler)"
    [ "$(grep -c '"mirror"' s.json)" -eq 1 ] || fail "$shape: no plane in the statistics"
    between "$(grep -c '^f ' a.obj)" 720 880 "$shape, number of quads"
    run 0 extract uv.obj -o again.obj
    [ "$(grep -c '^f ' again.obj)" = "$(grep -c '^f ' a.obj)" ] || fail "$shape: the map has other quads"
    run 0 remesh in.obj -o b.obj --quads 800 --symmetry $axis --threads 3
    same a.obj b.obj "$shape, 1 and 3 threads"
done <<SHAPES
torus 3000 auto 2 0
sphere 3000 z 4 2
cylinder 3000 y 3 2
genus 3000 x 2 -2
hyperboloid 3000 x 2 0
SHAPES

# Anywhere: the plane is that of the middle, and a given plane keeps its side.
run 0 shape ellipsoid --resolution 2000 -o in.obj
awk '$1 == "v" { $3 += 0.1 } { print }' in.obj >moved.obj
run 0 remesh moved.obj -o a.obj --quads 400 --symmetry 0,-2,0,-0.2
symmetric a.obj 3 0.2

# The joint is hard even where nothing else is.
run 0 shape sphere --resolution 2000 -o in.obj
run 0 remesh in.obj -o a.obj --quads 500 --symmetry x --no-features
symmetric a.obj 2 0

# Not symmetric, or not cut: the whole, as without the option.
run 0 shape knot --resolution 2000 -o in.obj
run 0 remesh in.obj -o whole.obj --quads 500 --mode fast
run 0 remesh in.obj -o a.obj --quads 500 --mode fast --symmetry auto
same whole.obj a.obj 'knot, no symmetry'
grep -q 'warning: no plane of symmetry' err || fail "no warning: $(cat err)"
run 0 remesh in.obj -o a.obj --quads 500 --mode fast --symmetry 1,0,0,50
same whole.obj a.obj 'knot, a plane beside it'
grep -q 'does not cut' err || fail "no warning: $(cat err)"
run 2 remesh in.obj -o a.obj --symmetry up
error_says symmetry up
run 2 remesh in.obj -o a.obj --symmetry 0,0,0,1
finish
