/* Energy, gradient and target shapes of a patch (see energy.h). */
#include "sdk/map/untangle/energy.h"
#include <math.h>
#include <string.h>

qc_status qc__untangle_targets(qc_ctx *ctx, const qc_mesh *mesh, double edge_length,
                               double thinnest, qc_complex *hat, double *area) {
    const qc_status status = qc_tangent_edges(ctx, mesh, hat);
    if (status != QC_OK) return status;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        qc_complex *e = hat + 3 * (int64_t)t;
        for (int32_t k = 0; k < 3; k++) {
            e[k].re /= edge_length;
            e[k].im /= edge_length;
        }
        qc__target_hats(e, thinnest, e, area + t);
    }
    return QC_OK;
}

/* Corner parameters of face t under the unknowns. */
static void corners(const qc__patch *p, const double *x, int32_t t, qc_complex f[3]) {
    for (int32_t k = 0; k < 3; k++) {
        const int64_t c = 3 * (int64_t)t + k;
        const int32_t v = p->map->mesh->face_vertex[c], j = p->local[v];
        qc_complex value = p->map->value[v];
        if (j >= 0) value = (qc_complex){x[2 * (int64_t)j], x[2 * (int64_t)j + 1]};
        f[k] = qc__reduced_map_corner(p->map, value, c);
    }
}

double qc__face_det(const qc__reduced_map *map, const qc_complex *hat, int32_t t) {
    qc_complex f[3];
    for (int32_t k = 0; k < 3; k++) {
        const int64_t c = 3 * (int64_t)t + k;
        f[k] = qc__reduced_map_corner(map, map->value[map->mesh->face_vertex[c]], c);
    }
    return qc__jacobian_det(hat + 3 * (int64_t)t, f);
}

double qc__patch_energy(qc__patch *p, const double *x, double *gradient) {
    p->work += p->n_faces;
    memset(gradient, 0, sizeof *gradient * 2 * (size_t)p->n_vertices);
    double energy = 0;
    for (int32_t i = 0; i < p->n_faces; i++) {
        const int32_t t = p->face[i];
        qc_complex f[3], g[3];
        corners(p, x, t, f);
        const qc_complex *hat = p->hat + 3 * (int64_t)t;
        energy += p->positive ? qc__face_barrier(hat, p->area[t], f, g)
                              : qc__face_energy(hat, p->area[t], p->eps, 0, f, g);
        for (int32_t k = 0; k < 3; k++) {
            const int64_t c = 3 * (int64_t)t + k;
            const int32_t j = p->local[p->map->mesh->face_vertex[c]];
            if (j < 0) continue;
            const qc_complex at_vertex = qc_quarter_turn(g[k], -p->map->turn[c]);
            const uint8_t fixed = p->map->fixed[p->vertex[j]];
            if (!(fixed & 1)) gradient[2 * (int64_t)j] += at_vertex.re;
            if (!(fixed & 2)) gradient[2 * (int64_t)j + 1] += at_vertex.im;
        }
    }
    return energy;
}

double qc__patch_min_det(const qc__patch *p, const double *x) {
    double least = INFINITY;
    for (int32_t i = 0; i < p->n_faces; i++) {
        const int32_t t = p->face[i];
        qc_complex f[3];
        corners(p, x, t, f);
        const double d = qc__jacobian_det(p->hat + 3 * (int64_t)t, f);
        if (d < least) least = d;
    }
    return least;
}

double qc__patch_limit(const qc__patch *p, const double *x, const double *way) {
    double least = INFINITY;
    for (int32_t i = 0; i < p->n_faces; i++) {
        const int32_t t = p->face[i];
        qc_complex f[3], d[3];
        corners(p, x, t, f);
        for (int32_t k = 0; k < 3; k++) {
            const int64_t c = 3 * (int64_t)t + k, j = p->local[p->map->mesh->face_vertex[c]];
            const qc_complex own = {j < 0 ? 0 : way[2 * j], j < 0 ? 0 : way[2 * j + 1]};
            d[k] = qc_quarter_turn(own, p->map->turn[c]);
        }
        const double limit = qc__face_limit(f, d);
        if (limit < least) least = limit;
    }
    return least;
}
