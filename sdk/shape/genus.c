/* Surface of genus g: the boundary of a plate with g square holes, rounded off by Laplacian
 * smoothing. */
#include "sdk/shape/internal.h"

typedef struct plate {
    int columns, rows, holes; /* of holes, in a grid; the last row may be incomplete              */
} plate;

static plate plate_of(int32_t genus) {
    plate p = {1, 1, genus};
    while (p.columns * p.columns < genus) p.columns++;
    while (p.columns * p.rows < genus) p.rows++;
    return p;
}

/* Cells (i, j), 0 <= i <= 2 columns; holes at odd pairs. */
static bool solid(const plate *p, int i, int j) {
    if (i < 0 || j < 0 || i > 2 * p->columns || j > 2 * p->rows) return false;
    return !(i % 2 == 1 && j % 2 == 1 && i / 2 + p->columns * (j / 2) < p->holes);
}

typedef struct quad {
    double origin[3], du[3], dv[3];
} quad;

static void flat(const void *data, double u, double v, double out[3]) {
    const quad *q = data;
    for (int i = 0; i < 3; i++) out[i] = q->origin[i] + u * q->du[i] + v * q->dv[i];
}

/* Squares of the surface; soup NULL only counts them. */
static int64_t squares(qc__soup *soup, const plate *p, int32_t n) {
    static const int step[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    int64_t count = 0;
    for (int j = 0; j <= 2 * p->rows; j++) {
        for (int i = 0; i <= 2 * p->columns; i++) {
            if (!solid(p, i, j)) continue;
            double x = i - p->columns - 0.5, y = j - p->rows - 0.5;
            for (int up = 0; up < 2; up++, count++) {
                quad q = {{x, y, up - 0.5}, {1, 0, 0}, {0, 1, 0}};
                if (soup) qc__soup_patch(soup, n, n, up == 0, flat, &q);
            }
            for (int k = 0; k < 4; k++) {
                int a = step[k][0], b = step[k][1];
                if (solid(p, i + a, j + b)) continue;
                /* outward (a, b), then up: counter-clockwise from outside */
                quad q = {
                    {x + 0.5 * (1 + a + b), y + 0.5 * (1 + b - a), -0.5}, {-b, a, 0}, {0, 0, 1}};
                if (soup) qc__soup_patch(soup, n, n, false, flat, &q);
                count++;
            }
        }
    }
    return count;
}

static int32_t subdivision(const qc_shape_options *options, const plate *p) {
    return qc__segments(options->resolution, (double)squares(NULL, p, 1), 1);
}

void qc__shape_genus(qc__soup *soup, const qc_shape_options *options) {
    plate p = plate_of(options->genus);
    squares(soup, &p, subdivision(options, &p));
}

static void smooth(const qc_mesh *m, const double *from, double *to, int32_t *degree) {
    for (int64_t i = 0; i < 3 * (int64_t)m->n_vertices; i++) to[i] = 0;
    for (int32_t v = 0; v < m->n_vertices; v++) degree[v] = 0;
    for (int32_t e = 0; e < m->n_edges; e++) {
        for (int end = 0; end < 2; end++) {
            int64_t v = m->edge_vertex[2 * e + end], w = m->edge_vertex[2 * e + 1 - end];
            for (int i = 0; i < 3; i++) to[3 * v + i] += from[3 * w + i];
            degree[v]++;
        }
    }
    for (int64_t v = 0; v < m->n_vertices; v++)
        for (int i = 0; i < 3; i++)
            to[3 * v + i] = 0.5 * (from[3 * v + i] + to[3 * v + i] / degree[v]);
}

/* The number of steps grows with the square of the subdivision, so that the rounding is the same at
 * any resolution; up to a limit which is reached at some 200000 faces. */
qc_status qc__shape_round_off(qc_ctx *ctx, const qc_shape_options *options, qc_mesh **mesh) {
    plate p = plate_of(options->genus);
    int32_t n = subdivision(options, &p), steps = 2 + (int32_t)fmin(0.25 * n * n, 400);
    const qc_mesh *m = *mesh;
    size_t size = (size_t)m->n_vertices;
    double *a = QC__NEW(ctx, double, 3 * size), *b = QC__NEW(ctx, double, 3 * size);
    int32_t *degree = QC__NEW(ctx, int32_t, size);
    qc_status status = a && b && degree ? QC_OK : QC_ERR_NOMEM;
    for (size_t i = 0; status == QC_OK && i < 3 * size; i++) a[i] = m->position[i];
    for (int32_t step = 0; status == QC_OK && step < steps; step++) {
        double *swap = a;
        smooth(m, a, b, degree);
        a = b;
        b = swap;
        if (!qc__progress(ctx, (double)step / steps)) status = QC_ERR_CANCELLED;
    }
    qc_mesh *result = NULL;
    if (status == QC_OK)
        status = qc_mesh_create(ctx, m->n_vertices, a, m->n_faces, m->face_vertex, &result);
    if (status == QC_OK) {
        qc_object_release(m);
        *mesh = result;
    }
    qc__free(a);
    qc__free(b);
    qc__free(degree);
    return status;
}
