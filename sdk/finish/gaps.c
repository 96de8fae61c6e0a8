/* How far the quads are from the surface and the surface from the quads, quad by quad, sampled as
 * in qc_report_measure: at edge midpoints and centres of the quads and the vertices of the mesh. */
#include "sdk/finish/internal.h"

enum { CHUNK = 256, BATCH = 1 << 14 };

typedef struct gaps {
    int64_t first; /* of the batch */
    const qc__relaxation *r;
    const qc_closest_tree *quads;
    double *gap;      /* n_faces of the quads */
    int32_t *nearest; /* n_vertices of the mesh: quad ... */
    double *distance; /* ... and distance */
} gaps;

static double gap_at(const qc__relaxation *r, const double x[3], int32_t *face) {
    double weight[3];
    return r->closest->query(r->tree, x, face, weight);
}

double qc__quad_gap(const qc__relaxation *r, int32_t f) {
    const int32_t *v = r->quads->face_vertex + 4 * (int64_t)f;
    double centre[3] = {0, 0, 0}, x[3], gap = 0;
    int32_t face = r->spot[v[0]].face;
    for (int k = 0; k < 4; k++) {
        const double *p = r->position + 3 * (int64_t)v[k];
        const double *q = r->position + 3 * (int64_t)v[(k + 1) & 3];
        for (int i = 0; i < 3; i++) {
            centre[i] += 0.25 * p[i];
            x[i] = 0.5 * (p[i] + q[i]);
        }
        gap = fmax(gap, gap_at(r, x, &face));
    }
    return fmax(gap, gap_at(r, centre, &face));
}

/* Distances from samples of the quads to the surface. */
static void from_quads(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const gaps *g = arg;
    (void)worker;
    for (int64_t f = g->first + begin; f < g->first + end; f++)
        g->gap[f] = qc__quad_gap(g->r, (int32_t)f);
}

/* Distances from the vertices of the surface to the quads. */
static void from_mesh(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const gaps *g = arg;
    int32_t triangle = 0;
    (void)worker;
    for (int64_t v = g->first + begin; v < g->first + end; v++) {
        double weight[3];
        g->distance[v] =
            g->r->closest->query(g->quads, g->r->mesh->position + 3 * v, &triangle, weight);
        g->nearest[v] = triangle / 2;
    }
}

static qc_status run(qc_ctx *ctx, int64_t n, double done, qc__body *body, gaps *g) {
    for (g->first = 0; g->first < n; g->first += BATCH) {
        if (!qc__progress(ctx, done + 0.5 * (double)g->first / (double)n)) return QC_ERR_CANCELLED;
        qc__parallel_for(ctx, n - g->first < BATCH ? n - g->first : BATCH, CHUNK, body, g);
    }
    return QC_OK;
}

static void cut_quads(const qc_polygon_mesh *q, int32_t *vertex) {
    static const int corner[6] = {0, 1, 2, 0, 2, 3};
    for (int64_t f = 0; f < q->n_faces; f++)
        for (int k = 0; k < 6; k++) vertex[6 * f + k] = q->face_vertex[4 * f + corner[k]];
}

qc_status qc__measure_gaps(qc_ctx *ctx, const qc__relaxation *r, double *gap, int32_t *nearest) {
    const int32_t n = r->mesh->n_vertices;
    gaps g = {.r = r, .gap = gap, .nearest = nearest};
    qc_closest_tree *tree = NULL;
    int32_t *vertex = QC__NEW(ctx, int32_t, 6 * (int64_t)r->quads->n_faces);
    g.distance = QC__NEW(ctx, double, n);
    qc_status status = vertex && g.distance ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        cut_quads(r->quads, vertex);
        status =
            r->closest->build(r->closest, ctx, 2 * r->quads->n_faces, r->position, vertex, &tree);
    }
    if (status == QC_OK) {
        g.quads = tree;
        status = run(ctx, r->quads->n_faces, 0, from_quads, &g);
    }
    if (status == QC_OK) status = run(ctx, n, 0.5, from_mesh, &g);
    if (status == QC_OK) {
        for (int32_t v = 0; v < n; v++) gap[g.nearest[v]] = fmax(gap[g.nearest[v]], g.distance[v]);
    }
    if (tree) r->closest->destroy(tree);
    qc__free(vertex);
    qc__free(g.distance);
    return status;
}
