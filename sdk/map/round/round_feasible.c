/* Between two maps with the same integers (docs/theory/quantization.md, Q.8): the harmonic one,
 * which is smooth, and the one of quantization, which hardly folds. Where the former folds over or
 * winds wrong it gives way to the latter, in neighbourhoods which grow until that helps. */
#include <math.h>
#include <string.h>

#include "sdk/map/round/round.h"
#include "sdk/map/periods/wrong_cones.h"

enum { GROWTHS = 9 /* doublings of the neighbourhoods, from one ring on */ };

typedef struct blend {
    const qc_mesh *mesh;
    const int32_t *index4; /* of the first n_indices vertices; others are no cones */
    int32_t n_indices;
    const qc_complex *smooth, *feasible;
    qc_complex *f;  /* 3 n_faces: the map in between */
    double *weight; /* n_vertices: share of the feasible map */
    int32_t *ring;  /* n_vertices: distance from a bad place in edges, -1 = not reached */
    int32_t *queue; /* n_vertices */
} blend;

static void mix(blend *b) {
    const qc_mesh *m = b->mesh;
    for (int64_t c = 0; c < 3 * (int64_t)m->n_faces; c++) {
        const double w = b->weight[m->face_vertex[c]];
        const qc_complex p = b->smooth[c], q = b->feasible[c];
        b->f[c] = (qc_complex){w < 1 ? p.re + w * (q.re - p.re) : q.re,
                               w < 1 ? p.im + w * (q.im - p.im) : q.im};
    }
}

static void add_bad(blend *b, int32_t v, int32_t *n) {
    if (b->ring[v] >= 0) return;
    b->ring[v] = 0;
    b->queue[(*n)++] = v;
}

/* The corners of folded faces and cones which wind wrong, where some weight is below 1. */
static int32_t find_bad(blend *b) {
    const qc_mesh *m = b->mesh;
    const int32_t *index4 = b->index4;
    int32_t n = 0;
    memset(b->ring, -1, sizeof *b->ring * (size_t)m->n_vertices);
    for (int32_t t = 0; t < m->n_faces; t++) {
        const int32_t *v = m->face_vertex + 3 * (int64_t)t;
        const bool done = b->weight[v[0]] >= 1 && b->weight[v[1]] >= 1 && b->weight[v[2]] >= 1;
        if (done || !qc__is_folded(b->f + 3 * (int64_t)t)) continue;
        for (int k = 0; k < 3; k++) add_bad(b, v[k], &n);
    }
    for (int32_t v = 0; v < b->n_indices; v++)
        if (index4[v] != 0 && b->weight[v] < 1 && !qc_vertex_on_boundary(m, v) &&
            qc__winds_wrong(m, index4[v], b->f, v))
            add_bad(b, v, &n);
    return n;
}

/* Weight 1 up to `rings` edges from the n bad vertices, falling to 0 at twice as many. */
static void spread_weight(blend *b, int32_t n, int32_t rings) {
    const qc_mesh *m = b->mesh;
    for (int32_t i = 0; i < n; i++) {
        const int32_t v = b->queue[i], first = m->vertex_corner[v];
        b->weight[v] = fmax(b->weight[v], fmin(1, 2 - (double)b->ring[v] / rings));
        if (b->ring[v] >= 2 * rings) continue;
        int32_t c = first;
        do {
            const int32_t w[2] = {m->face_vertex[qc_next(c)], m->face_vertex[qc_prev(c)]};
            for (int k = 0; k < 2; k++) {
                if (b->ring[w[k]] >= 0) continue;
                b->ring[w[k]] = b->ring[v] + 1;
                b->queue[n++] = w[k];
            }
            c = qc_corner_ccw(m, c);
        } while (c >= 0 && c != first);
    }
}

qc_status qc__round_blend(const qc__rounding *r, const qc_mesh *mesh, const qc_complex *smooth,
                          const qc_complex *feasible, qc_complex *f) {
    blend b = {.mesh = mesh,
               .index4 = r->seamless->matching->index4,
               .n_indices = r->mesh->n_vertices,
               .smooth = smooth,
               .feasible = feasible,
               .f = f,
               .weight = QC__ZERO(r->ctx, double, mesh->n_vertices),
               .ring = QC__NEW(r->ctx, int32_t, mesh->n_vertices),
               .queue = QC__NEW(r->ctx, int32_t, mesh->n_vertices)};
    qc_status status = b.weight && b.ring && b.queue ? QC_OK : QC_ERR_NOMEM;
    for (int32_t i = 0; i <= GROWTHS && status == QC_OK; i++) {
        mix(&b);
        const int32_t n = find_bad(&b);
        if (n == 0) break;
        if (!qc__progress(r->ctx, 1)) status = QC_ERR_CANCELLED;
        if (i < GROWTHS)
            spread_weight(&b, n, 1 << i);
        else
            memcpy(f, feasible, sizeof *f * 3 * (size_t)mesh->n_faces);
    }
    qc__free(b.weight);
    qc__free(b.ring);
    qc__free(b.queue);
    return status;
}
