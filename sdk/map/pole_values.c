/* Parameters of the degenerate quads around poles, formula (3) of the second paper. */
#include "sdk/map/pole_values.h"

#include <complex.h>
#include <math.h>

#include "sdk/base/internal.h"

typedef double _Complex cplx;

static cplx value(const qc_corner_map *map, int32_t c) {
    return map->uv[2 * (int64_t)c] + I * map->uv[2 * (int64_t)c + 1];
}

static cplx turn(cplx z, int32_t r) {
    const qc_complex w = qc_quarter_turn((qc_complex){creal(z), cimag(z)}, r);
    return w.re + I * w.im;
}

/* Rotation of the chart when halfedge h is crossed: the known one, or that of the images of the
 * edge. */
static int32_t rotation(const qc_corner_map *map, int32_t h) {
    const qc_mesh *m = map->mesh;
    const int32_t e = m->halfedge_edge[h], g = m->twin[h];
    if (map->rotation)
        return m->edge_halfedge[2 * (int64_t)e] == h ? map->rotation[e] : -map->rotation[e];
    const cplx s = value(map, qc_prev(h)) - value(map, qc_next(h));
    const cplx t = value(map, qc_next(g)) - value(map, qc_prev(g)), z = t * conj(s);
    if (fabs(creal(z)) >= fabs(cimag(z))) return creal(z) >= 0 ? 0 : 2;
    return cimag(z) >= 0 ? 1 : 3;
}

/* The transition from the face of tip c to that of the next one: about the vertex they share. */
static void transition(const qc_corner_map *map, int32_t c, int32_t *r, cplx *d) {
    const qc_mesh *m = map->mesh;
    const int32_t from = qc_prev(c);
    int32_t at = from;
    *r = 0;
    for (; m->twin[qc_next(at)] >= 0; at = qc_corner_ccw(m, at)) *r += rotation(map, qc_next(at));
    *d = value(map, at) - turn(value(map, from), *r);
}

static void put(double *out, cplx z) {
    out[0] = creal(z);
    out[1] = cimag(z);
}

static void fill(const qc_corner_map *map, qc__pole_values *v) {
    const qc_mesh *m = map->mesh;
    for (int32_t i = 0; i < m->n_poles; i++)
        for (int32_t j = m->pole_start[i]; j < m->pole_start[i + 1]; j++) {
            const int32_t k = j + 1 < m->pole_start[i + 1] ? j + 1 : m->pole_start[i];
            int32_t r;
            cplx d;
            transition(map, m->pole_corner[j], &r, &d);
            const cplx p = value(map, m->pole_corner[j]), next = value(map, m->pole_corner[k]);
            put(v->end + 2 * (int64_t)j, 0.5 * (p + turn(next - d, -r)));
            put(v->start + 2 * (int64_t)k, 0.5 * (turn(p, r) + d + next));
            v->next[j] = k;
        }
}

qc_status qc__pole_values_create(qc_ctx *ctx, const qc_corner_map *map, qc__pole_values *out) {
    const int32_t n = map->mesh->n_poles > 0 ? map->mesh->pole_start[map->mesh->n_poles] : 0;
    qc__pole_values v = {QC__NEW(ctx, int32_t, n), QC__NEW(ctx, double, 2 * (int64_t)n),
                         QC__NEW(ctx, double, 2 * (int64_t)n), QC__NEW(ctx, int32_t, n)};
    if (!v.next || !v.start || !v.end || !v.end_uv) {
        qc__pole_values_free(&v);
        return QC_ERR_NOMEM;
    }
    fill(map, &v);
    *out = v;
    return QC_OK;
}

void qc__pole_values_number(const qc_corner_map *map, qc__pole_values *v, const int32_t *corner_uv,
                            int32_t *n_uvs) {
    const qc_mesh *m = map->mesh;
    for (int32_t j = 0; m->n_poles > 0 && j < m->pole_start[m->n_poles]; j++) {
        const double *end = v->end + 2 * (int64_t)j, *start = v->start + 2 * (int64_t)v->next[j];
        const bool same = end[0] == start[0] && end[1] == start[1];
        v->end_uv[j] = same ? corner_uv[m->pole_corner[v->next[j]]] : (*n_uvs)++;
    }
}

void qc__pole_values_free(qc__pole_values *v) {
    qc__free(v->next);
    qc__free(v->start);
    qc__free(v->end);
    qc__free(v->end_uv);
    *v = (qc__pole_values){NULL, NULL, NULL, NULL};
}
