/* Quads over the unit square of fixtures.h, moved about, and figures of them. */
#ifndef QC_TEST_FINISH_QUADS_H
#define QC_TEST_FINISH_QUADS_H

#include "sdk/mesh/internal.h"
#include "unit/mesh/fixtures.h"
#include <qc/finish.h>

static inline double random_unit(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (1 << 24) - 0.5;
}

/* n x n quads without sources; wrap as in grid(). Vertices are moved by up to `noise` cells: inner
 * ones in both directions, those on the boundary along it, those in column `crease` along it. */
static inline qc_polygon_mesh *quad_grid(qc_ctx *ctx, int n, double noise, int crease,
                                         double scale) {
    qc_polygon_mesh *q = NULL;
    uint32_t seed = 7;
    assert_int_equal(qc_polygon_mesh_create(ctx, (n + 1) * (n + 1), n * n, 4 * n * n, 0, 0, 0, &q),
                     QC_OK);
    for (int i = 0; i <= n; i++)
        for (int j = 0; j <= n; j++) {
            const double a = random_unit(&seed), b = random_unit(&seed);
            const double u = i % n == 0 || i == crease ? i : i + 2 * noise * a;
            const double v = j % n == 0 ? j : j + 2 * noise * b;
            double *x = q->position + 3 * (i * (n + 1) + j);
            x[0] = scale * (i % n == 0 && j % n == 0 ? i : u) / n;
            x[1] = scale * (i % n == 0 && j % n == 0 ? j : v) / n;
        }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const int f = i * n + j, a = i * (n + 1) + j;
            const int32_t corner[4] = {a, a + n + 1, a + n + 2, a + 1};
            memcpy(q->face_vertex + 4 * f, corner, sizeof corner);
            q->face_offset[f + 1] = 4 * f + 4;
        }
    return q;
}

/* Folds the square along x = scale / 2 by 90 degrees. */
static inline void fold(int32_t n, double *position, double scale) {
    for (int32_t v = 0; v < n; v++) {
        double *x = position + 3 * (size_t)v;
        if (x[0] <= 0.5 * scale) continue;
        x[2] = x[0] - 0.5 * scale;
        x[0] = 0.5 * scale;
    }
}

static inline double least_jacobian(const qc_polygon_mesh *q) {
    double least = 1;
    for (int32_t f = 0; f < q->n_faces; f++)
        least = fmin(least, qc__scaled_jacobian(q->position, q->face_vertex + 4 * f, 4));
    return least;
}

/* Sum of squared cosines of the corner angles. */
static inline double skewness(const qc_polygon_mesh *q) {
    double sum = 0;
    for (int32_t c = 0; c < q->n_corners; c++) {
        const int32_t *f = q->face_vertex + (c & ~3);
        const double *x = q->position + 3 * f[c & 3], *a = q->position + 3 * f[(c + 1) & 3],
                     *b = q->position + 3 * f[(c + 3) & 3];
        double d[2][3], dot = 0;
        for (int k = 0; k < 3; k++) {
            d[0][k] = a[k] - x[k];
            d[1][k] = b[k] - x[k];
            dot += d[0][k] * d[1][k];
        }
        dot /= qc__norm3(d[0]) * qc__norm3(d[1]);
        sum += dot * dot;
    }
    return sum;
}

/* Positions are those which source faces and barycentric coordinates tell. */
static inline void check_sources(const qc_mesh *m, const qc_polygon_mesh *q) {
    for (int32_t v = 0; v < q->n_vertices; v++) {
        const int32_t t = q->source_face[v];
        assert_in_range(t, 0, m->n_faces - 1);
        for (int i = 0; i < 3; i++) {
            double x = 0;
            for (int k = 0; k < 3; k++)
                x += q->source_barycentric[3 * v + k] *
                     m->position[3 * m->face_vertex[3 * t + k] + i];
            assert_near(x, q->position[3 * v + i], 1e-12 * m->diagonal);
        }
    }
}

#endif
