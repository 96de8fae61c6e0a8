/* Random edge flips. An edge is flipped when the mesh stays simple (no edge twice), the four
 * corners are nearly planar, so that creases survive, and no angle of the new triangles is below 20
 * degrees. */
#include <string.h>

#include "sdk/shape/internal.h"

static const double PLANAR = 0.5; /* cosine between normals before and after                    */
static const double MAX_COSINE = 0.94; /* of a new angle */

typedef struct triangles {
    const double *position;
    int32_t *vertex, *twin;
} triangles;

static void unit_normal(const double *p, int32_t a, int32_t b, int32_t c, double n[3]) {
    double u[3], v[3];
    for (int i = 0; i < 3; i++) {
        u[i] = p[3 * (int64_t)b + i] - p[3 * (int64_t)a + i];
        v[i] = p[3 * (int64_t)c + i] - p[3 * (int64_t)a + i];
    }
    qc__cross(u, v, n);
    qc__normalize(n);
}

/* Largest cosine of the three angles. */
static double sharpest(const double *p, int32_t a, int32_t b, int32_t c) {
    int32_t v[3] = {a, b, c};
    double largest = -1;
    for (int k = 0; k < 3; k++) {
        double x[3], y[3];
        for (int i = 0; i < 3; i++) {
            x[i] = p[3 * (int64_t)v[(k + 1) % 3] + i] - p[3 * (int64_t)v[k] + i];
            y[i] = p[3 * (int64_t)v[(k + 2) % 3] + i] - p[3 * (int64_t)v[k] + i];
        }
        largest = fmax(largest, qc__dot(x, y) / sqrt(qc__dot(x, x) * qc__dot(y, y)));
    }
    return largest;
}

/* Does the vertex of corner c have an edge to w? */
static bool has_edge(const triangles *t, int32_t c, int32_t w) {
    int32_t x = c;
    do {
        if (t->vertex[qc_next(x)] == w || t->vertex[qc_prev(x)] == w) return true;
        int32_t h = t->twin[qc_next(x)];
        x = h < 0 ? -1 : qc_next(h);
    } while (x >= 0 && x != c);
    for (int32_t h = x < 0 ? t->twin[qc_prev(c)] : -1; h >= 0; h = t->twin[qc_prev(x)]) {
        x = qc_prev(h);
        if (t->vertex[qc_next(x)] == w || t->vertex[qc_prev(x)] == w) return true;
    }
    return false;
}

static bool may_flip(const triangles *t, int32_t h, int32_t k) {
    const double *p = t->position;
    int32_t c = t->vertex[h], a = t->vertex[qc_next(h)], b = t->vertex[qc_prev(h)],
            d = t->vertex[k];
    double old[2][3], new[2][3];
    if (sharpest(p, c, a, d) > MAX_COSINE || sharpest(p, d, b, c) > MAX_COSINE) return false;
    unit_normal(p, c, a, b, old[0]);
    unit_normal(p, d, b, a, old[1]);
    unit_normal(p, c, a, d, new[0]);
    unit_normal(p, d, b, c, new[1]);
    if (qc__dot(old[0], old[1]) < PLANAR || qc__dot(new[0], new[1]) < PLANAR) return false;
    for (int i = 0; i < 4; i++)
        if (qc__dot(old[i / 2], new[i % 2]) < PLANAR) return false;
    return !has_edge(t, h, d);
}

/* Faces (c, a, b), (d, b, a) with h, k opposite c, d become (c, a, d), (d, b, c). */
static void flip(triangles *t, int32_t h, int32_t k) {
    int32_t ad = t->twin[qc_next(k)], bc = t->twin[qc_next(h)];
    t->vertex[qc_prev(h)] = t->vertex[k];
    t->vertex[qc_prev(k)] = t->vertex[h];
    t->twin[h] = ad;
    t->twin[k] = bc;
    if (ad >= 0) t->twin[ad] = h;
    if (bc >= 0) t->twin[bc] = k;
    t->twin[qc_next(h)] = qc_next(k);
    t->twin[qc_next(k)] = qc_next(h);
}

qc_status qc__shape_flip(qc_ctx *ctx, const qc_mesh *m, uint64_t seed, qc_mesh **out) {
    int32_t n = 3 * m->n_faces;
    triangles t = {m->position, QC__NEW(ctx, int32_t, n), QC__NEW(ctx, int32_t, n)};
    qc_status status = t.vertex && t.twin ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        memcpy(t.vertex, m->face_vertex, (size_t)n * sizeof *t.vertex);
        memcpy(t.twin, m->twin, (size_t)n * sizeof *t.twin);
    }
    qc__random r = {seed ^ 0x666c6970};
    for (int32_t trial = 0; status == QC_OK && trial < n; trial++) {
        int32_t h = qc__random_below(&r, n), k = t.twin[h];
        if (k >= 0 && may_flip(&t, h, k)) flip(&t, h, k);
        if ((trial & 0x3fff) == 0 && !qc__progress(ctx, (double)trial / n))
            status = QC_ERR_CANCELLED;
    }
    if (status == QC_OK)
        status = qc_mesh_create(ctx, m->n_vertices, m->position, m->n_faces, t.vertex, out);
    qc__free(t.vertex);
    qc__free(t.twin);
    return status;
}
