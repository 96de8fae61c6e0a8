/* Collects the triangles of parametric patches. */
#include "sdk/shape/internal.h"

static bool reserve(qc__soup *s, int64_t vertices, int64_t faces) {
    if (s->status != QC_OK) return false;
    if (s->n_vertices + vertices > INT32_MAX / 3 || s->n_faces + faces > INT32_MAX / 3) {
        s->status = qc__fail(s->ctx, QC_ERR_ARGUMENT, -1, "resolution too high: more than %d faces",
                             (int)(INT32_MAX / 3));
        return false;
    }
    if (!qc__reserve(s->ctx, (void **)&s->position, &s->vertex_capacity, s->n_vertices + vertices,
                     3 * sizeof(double)) ||
        !qc__reserve(s->ctx, (void **)&s->face, &s->face_capacity, s->n_faces + faces,
                     3 * sizeof(int32_t))) {
        s->status = QC_ERR_NOMEM;
        return false;
    }
    if (!qc__progress(s->ctx, 0.0)) s->status = QC_ERR_CANCELLED;
    return s->status == QC_OK;
}

static void add_face(qc__soup *s, int64_t a, int64_t b, int64_t c, bool flip) {
    int32_t *f = s->face + 3 * s->n_faces++;
    f[0] = (int32_t)a;
    f[1] = (int32_t)(flip ? c : b);
    f[2] = (int32_t)(flip ? b : c);
}

static double distance2(const qc__soup *s, int64_t a, int64_t b) {
    double d[3];
    for (int i = 0; i < 3; i++) d[i] = s->position[3 * a + i] - s->position[3 * b + i];
    return qc__dot(d, d);
}

void qc__soup_patch(qc__soup *s, int32_t nu, int32_t nv, bool flip, qc__map *map,
                    const void *data) {
    int64_t row = (int64_t)nv + 1, first = s->n_vertices;
    if (!reserve(s, ((int64_t)nu + 1) * row, 2 * (int64_t)nu * nv)) return;
    for (int32_t i = 0; i <= nu; i++)
        for (int32_t j = 0; j <= nv; j++)
            map(data, (double)i / nu, (double)j / nv, s->position + 3 * s->n_vertices++);
    for (int32_t i = 0; i < nu; i++) {
        for (int32_t j = 0; j < nv; j++) {
            int64_t a = first + i * row + j, b = a + row, c = b + 1, d = a + 1;
            /* equal diagonals up to rounding: always a-c, so that regular grids stay regular */
            if (distance2(s, a, c) <= distance2(s, b, d) * (1 + 1e-9)) {
                add_face(s, a, b, c, flip);
                add_face(s, a, c, d, flip);
            } else {
                add_face(s, a, b, d, flip);
                add_face(s, b, c, d, flip);
            }
        }
    }
}

void qc__soup_triangle(qc__soup *s, int32_t n, qc__map *map, const void *data) {
    int64_t count = ((int64_t)n + 1) * ((int64_t)n + 2) / 2, row = s->n_vertices;
    if (!reserve(s, count, (int64_t)n * n)) return;
    for (int32_t i = 0; i <= n; i++)
        for (int32_t j = 0; j <= n - i; j++)
            map(data, (double)i / n, (double)j / n, s->position + 3 * s->n_vertices++);
    for (int32_t i = 0; i < n; i++) {
        int64_t above = row + n - i + 1;
        for (int32_t j = 0; j < n - i; j++) {
            add_face(s, row + j, above + j, row + j + 1, false);
            if (j + 1 < n - i) add_face(s, above + j, above + j + 1, row + j + 1, false);
        }
        row = above;
    }
}

int32_t qc__segments(int32_t faces, double quads_per_n2, int32_t least) {
    double n = floor(sqrt(0.5 * faces / quads_per_n2) + 0.5);
    return n < least ? least : (int32_t)n;
}
