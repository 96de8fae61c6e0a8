# Two edge lengths: quads of about the ratio asked for, as many as asked for; a ratio of 1 changes no byte.
. "$(dirname "$0")/common.sh"
soft="--set features.hard=false"

# Median over the quads of the longer mean edge over the other.
median_ratio() {
    awk '$1 == "v" { n++; x[n] = $2; y[n] = $3; z[n] = $4 }
         $1 == "f" { for (k = 0; k < 4; k++) { split($(k + 2), a, "/"); v[k] = a[1] }
                     for (k = 0; k < 4; k++) { p = v[k]; q = v[(k + 1) % 4]
                         e[k] = sqrt((x[p]-x[q])^2 + (y[p]-y[q])^2 + (z[p]-z[q])^2) }
                     r = (e[0] + e[2]) / (e[1] + e[3]); print r < 1 ? 1 / r : r }' "$1" |
        sort -g | awk '{ r[NR] = $1 } END { print r[int((NR + 1) / 2)] }'
}

# The rims of the cylinder only guide the field: cones on its ends, which hard rims ask for, make quads squarer.
for shape in torus cylinder; do
    run 0 shape $shape --resolution 4000 -o in.obj
    run 0 remesh in.obj -o one.obj --quads 1000 $soft
    run 0 remesh in.obj -o same.obj --quads 1000 $soft --set size.anisotropy=1
    same one.obj same.obj "$shape, ratio 1"
    run 0 remesh in.obj -o two.obj --quads 1000 $soft --set size.anisotropy=2 --threads 1
    run 0 remesh in.obj -o threads.obj --quads 1000 $soft --set size.anisotropy=2 --threads 3
    same two.obj threads.obj "$shape, 1 and 3 threads"
    between "$(grep -c '^f ' two.obj)" 950 1050 "$shape, number of quads"
    between "$(median_ratio two.obj)" 1.7 2.2 "$shape, ratio"
done

# Given directions: long along the axis, or about it; the field follows.
for direction in '0 0 1' 'about'; do
    awk -v d="$direction" '$1 == "v" { print 0.3, 0.1, d == "about" ? -$3 " " $2 " 1e-9" : d }' in.obj >size.txt
    run 0 remesh in.obj -o given.obj --quads 1000 $soft --set size.file=size.txt
    between "$(grep -c '^f ' given.obj)" 950 1050 "$direction, number of quads"
    between "$(median_ratio given.obj)" 2.3 3.6 "$direction, ratio"
done
sed -i '7s/.*/0.3 0.1 0 0 0/' size.txt
run 3 remesh in.obj -o x.obj --set size.file=size.txt
error_says size.txt:7: direction
finish
