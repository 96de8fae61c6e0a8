# The statistics file has every key of the contract.
. "$(dirname "$0")/common.sh"

run 0 shape sphere --resolution 2000 --noise 0.02 -o in.obj
run 0 remesh in.obj -o quads.obj --quads 600 --stats stats.json --set round.radius=2
cp stats.json out
for key in quadcover input vertices faces genus boundaries components density edge_length \
    target_quads field singularities index4 -1 1 energy E_D E_H E_D_rel E_H_rel E_H_direct_rel \
    iterations evaluations uv flipped degenerate max_seam_error arap_mean quads non_quads \
    irregular euler rsd_edge rsd_angle hausdorff_rel mean_dist_rel seconds total stages peak_rss_mb warnings \
    pipeline versions; do
    out_says "\"$key\": "
done
out_says '"mode": "best"' '"radius": 2'
between "$(value stats.json genus)" 0 0 genus
between "$(value stats.json components)" 1 1 components
between "$(value stats.json non_quads)" 0 0 'faces that are no quads'
between "$(value stats.json euler)" 2 2 'Euler characteristic'
between "$(value stats.json flipped)" 0 0 'flipped triangles'
between "$(value stats.json max_seam_error)" 0 1e-9 'seam error'
between "$(value stats.json hausdorff_rel)" 1e-9 0.05 'Hausdorff distance'
between "$(value stats.json total)" 0.0001 300 'seconds'
between "$(value stats.json peak_rss_mb)" 1 4000 'memory'
between "$(value stats.json rsd_edge)" 0.1 60 'edge deviation'
[ "$(value stats.json target_quads)" = 600.0 ] || fail 'target'
finish
