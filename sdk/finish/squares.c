/* The local step of a local-global method (Bouaziz et al., Shape-Up: shaping discrete geometry with
 * projections, 2012): each quad is replaced by the square closest to it.
 *
 * Of the quad p_0..p_3 with centre c and normal n, that of its diagonals, the closest square is
 * c + J^k a with 4 a = (p_0 - p_2) - J (p_1 - p_3), where J turns by 90 degrees about n. */
#include "sdk/finish/internal.h"

enum { SIZE_ROUNDS = 10 };

static const double *corner(const qc__relaxation *r, int32_t f, int k) {
    return r->position + 3 * (int64_t)r->quads->face_vertex[4 * (int64_t)f + k];
}

static double edge_length(const qc__relaxation *r, int32_t f) {
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        const double *p = corner(r, f, k), *q = corner(r, f, (k + 1) & 3);
        const double d[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
        sum += qc__norm3(d);
    }
    return sum / 4;
}

static double mean_around(const qc__relaxation *r, int32_t f) {
    double sum = 0;
    int32_t n = 0;
    for (int k = 0; k < 4; k++) {
        const int32_t v = r->quads->face_vertex[4 * (int64_t)f + k];
        for (int32_t i = r->around.face_start[v]; i < r->around.face_start[v + 1]; i++, n++)
            sum += r->size[r->around.face[i] / 4];
    }
    return sum / n;
}

static void average(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const qc__relaxation *r = arg;
    (void)worker;
    for (int64_t f = begin; f < end; f++) r->scratch[f] = mean_around(r, (int32_t)f);
}

void qc__measure_sizes(qc_ctx *ctx, qc__relaxation *r) {
    for (int32_t f = 0; f < r->quads->n_faces; f++) r->size[f] = edge_length(r, f);
    for (int round = 0; round < SIZE_ROUNDS; round++) {
        qc__parallel_for(ctx, r->quads->n_faces, 1024, average, r);
        double *swap = r->size;
        r->size = r->scratch;
        r->scratch = swap;
    }
}

/* Corner k of the square for quad f is added to sum. */
static void add_square(const qc__relaxation *r, int32_t f, int k, double sum[3]) {
    const double *p[4];
    double d[2][3], centre[3], n[3], turned[3], a[3];
    for (int i = 0; i < 4; i++) p[i] = corner(r, f, i);
    for (int i = 0; i < 3; i++) {
        centre[i] = 0.25 * (p[0][i] + p[1][i] + p[2][i] + p[3][i]);
        d[0][i] = p[0][i] - p[2][i];
        d[1][i] = p[1][i] - p[3][i];
    }
    qc__cross3(d[0], d[1], n);
    const double area = qc__norm3(n);
    for (int i = 0; i < 3; i++) n[i] = area > 0 ? n[i] / area : 0;
    qc__cross3(n, d[1], turned);
    for (int i = 0; i < 3; i++) a[i] = 0.25 * (d[0][i] - turned[i]);
    const double radius = qc__norm3(a), wanted = r->size[f] * sqrt(0.5);
    const double scale = radius > 0 ? 1 - r->uniformity + r->uniformity * wanted / radius : 1;
    if (k & 1) {
        qc__cross3(n, a, turned);
        for (int i = 0; i < 3; i++) a[i] = turned[i];
    }
    for (int i = 0; i < 3; i++) sum[i] += centre[i] + (k < 2 ? scale : -scale) * a[i];
}

void qc__square_target(const qc__relaxation *r, int32_t v, double target[3]) {
    const int32_t begin = r->around.face_start[v], end = r->around.face_start[v + 1];
    target[0] = target[1] = target[2] = 0;
    for (int32_t i = begin; i < end; i++)
        add_square(r, r->around.face[i] / 4, r->around.face[i] & 3, target);
    for (int k = 0; k < 3; k++) target[k] /= end - begin;
}
