/* Features of a grid map (docs/theory/exact-grid.md): edges whose image runs along an isoline.
 * Their level, the coordinate across the isoline, is an integer; where they turn, branch or end is
 * a lattice point. Boundaries of maps which do not tell are tried loop by loop. */
#include <math.h>
#include <string.h>

#include "sdk/map/grid/internal.h"

/* Quarter turns of a vector when it moves through halfedge h to the next chart. */
static int rotation_across(const qc_mesh *m, const int8_t *rotation, int32_t h) {
    const int32_t e = m->halfedge_edge[h];
    return m->edge_halfedge[2 * (int64_t)e] == h ? rotation[e] : -rotation[e];
}

uint8_t qc__feature_levels(const qc_mesh *m, const int8_t *rotation, const int8_t *axis,
                           int32_t v) {
    if (!axis) return 0;
    const int32_t first = m->vertex_corner[v];
    uint8_t levels = 0;
    int n = 0, turn = 0, sum = 0; /* features, turns to the chart of c, sum of i^direction parity */
    int32_t c = first;
    do {
        const int out = qc__feature_direction(m, rotation, axis, qc_prev(c));
        const bool last = m->twin[qc_next(c)] < 0;
        const int in = last ? qc__feature_direction(m, rotation, axis, qc_next(c)) : -1;
        if (out >= 0) {
            const int d = (out - turn) & 3;
            levels |= d & 1 ? 1 : 2;
            sum += d >= 2 ? -1 : 1;
            n++;
        }
        if (in >= 0) {
            const int d = (in + 2 - turn) & 3;
            levels |= d & 1 ? 1 : 2;
            sum += d >= 2 ? -1 : 1;
            n++;
        }
        turn += last ? 0 : rotation_across(m, rotation, qc_next(c));
        c = qc_corner_ccw(m, c);
    } while (c >= 0 && c != first);
    const bool passes = n == 2 && sum == 0; /* one in, one out, if on the same line */
    const bool reaches_boundary = n == 1 && c < 0;
    return n == 0 || passes || reaches_boundary ? levels : 3;
}

/* --- levels ----------------------------------------------------------------------------------- */

/* Values across the isoline at both ends of halfedge h which runs along direction k. */
static void level_values(const qc__grid_build *b, int32_t h, int k, double level[2]) {
    const int coordinate = k & 1 ? 0 : 1;
    level[0] = b->uv[2 * (int64_t)qc_next(h) + coordinate];
    level[1] = b->uv[2 * (int64_t)qc_prev(h) + coordinate];
}

/* How far the ends are from one integer. */
static double level_error(const qc__grid_build *b, int32_t h, int k) {
    double level[2];
    level_values(b, h, k, level);
    const double integer = round(0.5 * (level[0] + level[1]));
    return fmax(fabs(level[0] - integer), fabs(level[1] - integer));
}

static qc_status off_level(const qc__grid_build *b, int32_t e, double amount) {
    const int32_t *v = b->mesh->edge_vertex + 2 * (int64_t)e;
    return qc__fail(b->ctx, QC_ERR_FAILED, e,
                    "the feature at edge %d (vertices %d, %d) is off its integer isoline by %.3g "
                    "parameter units",
                    (int)e, (int)v[0], (int)v[1], amount);
}

static qc_status check_known(qc__grid_build *b) {
    for (int32_t e = 0; e < b->mesh->n_edges; e++) {
        if (b->axis[e] < 0) continue;
        const double error = level_error(b, b->mesh->edge_halfedge[2 * (int64_t)e], b->axis[e]);
        if (!(error <= b->tolerance)) return off_level(b, e, error);
    }
    return QC_OK;
}

/* --- boundary loops which lie on isolines ----------------------------------------------------- */

static int32_t next_on_boundary(const qc_mesh *m, int32_t h) {
    return qc_prev(m->vertex_corner[qc_halfedge_end(m, h)]);
}

/* The direction which a boundary halfedge follows within the tolerance; -1 = none. */
static int follows(const qc__grid_build *b, int32_t h) {
    const double *p = b->uv + 2 * (int64_t)qc_next(h), *q = b->uv + 2 * (int64_t)qc_prev(h);
    const double d[2] = {q[0] - p[0], q[1] - p[1]};
    const bool along_v = fabs(d[1]) > fabs(d[0]);
    const int k = along_v ? (d[1] > 0 ? 1 : 3) : (d[0] > 0 ? 0 : 2);
    return level_error(b, h, k) <= b->tolerance ? k : -1;
}

/* Whether the coordinates which the features at v fix are near integers. */
static bool near_level(const qc__grid_build *b, int32_t v) {
    const uint8_t levels = qc__feature_levels(b->mesh, b->rotation, b->axis, v);
    const double *f = b->uv + 2 * (int64_t)b->mesh->vertex_corner[v];
    for (int i = 0; i < 2; i++)
        if ((levels >> i & 1) && !(fabs(f[i] - round(f[i])) <= b->tolerance)) return false;
    return true;
}

/* Marks the loop of boundary halfedge `first` when all of it lies on isolines. An aligned loop is
 * at least one unit long; shorter ones are holes which happen to be near an isoline. */
static void align_loop(qc__grid_build *b, int32_t first, uint8_t *seen) {
    const qc_mesh *m = b->mesh;
    double length = 0;
    bool aligned = true;
    int32_t h = first;
    do {
        const int k = follows(b, h), i = k & 1;
        seen[h] = 1;
        aligned &= k >= 0;
        b->axis[m->halfedge_edge[h]] = (int8_t)k;
        if (k >= 0)
            length += fabs(b->uv[2 * (int64_t)qc_prev(h) + i] - b->uv[2 * (int64_t)qc_next(h) + i]);
        h = next_on_boundary(m, h);
    } while (h != first);
    aligned &= length > 0.5;
    for (int pass = 0; pass < 2; pass++) {
        do {
            if (pass == 0 && aligned) aligned = near_level(b, qc_halfedge_start(m, h));
            if (pass == 1 && !aligned) b->axis[m->halfedge_edge[h]] = -1;
            h = next_on_boundary(m, h);
        } while (h != first);
    }
}

static qc_status align_boundaries(qc__grid_build *b) {
    const qc_mesh *m = b->mesh;
    uint8_t *seen = QC__ZERO(b->ctx, uint8_t, 3 * (int64_t)m->n_faces);
    if (!seen) return QC_ERR_NOMEM;
    bool any = false;
    for (int32_t h = 0; h < 3 * m->n_faces; h++)
        if (m->twin[h] < 0 && !seen[h]) {
            align_loop(b, h, seen);
            any |= b->axis[m->halfedge_edge[h]] >= 0;
        }
    qc__free(seen);
    if (any) return QC_OK;
    qc__free(b->axis);
    b->axis = NULL;
    return QC_OK;
}

qc_status qc__grid_features(qc__grid_build *b) {
    const qc_mesh *m = b->mesh;
    if (!b->known_axis && m->n_boundary_edges == 0) return QC_OK;
    b->axis = QC__NEW(b->ctx, int8_t, m->n_edges);
    if (!b->axis) return QC_ERR_NOMEM;
    if (b->known_axis) {
        memcpy(b->axis, b->known_axis, (size_t)m->n_edges);
        return check_known(b);
    }
    memset(b->axis, -1, (size_t)m->n_edges);
    return align_boundaries(b);
}

qc_status qc__grid_check_features(const qc__grid_build *b) {
    const int32_t mask = (1 << b->bits) - 1;
    for (int32_t e = 0; b->axis && e < b->mesh->n_edges; e++) {
        if (b->axis[e] < 0) continue;
        const int32_t h = b->mesh->edge_halfedge[2 * (int64_t)e], i = b->axis[e] & 1 ? 0 : 1;
        const int32_t level = b->grid_uv[2 * (int64_t)qc_next(h) + i];
        if (level == b->grid_uv[2 * (int64_t)qc_prev(h) + i] && (level & mask) == 0) continue;
        return off_level(b, e, level_error(b, h, b->axis[e]));
    }
    return QC_OK;
}
