/* The local step of a local-global method (Bouaziz et al., Shape-Up: shaping discrete geometry with
 * projections, 2012): each quad is replaced by the square, or rectangle of given proportions,
 * closest to it.
 *
 * Of the quad p_0..p_3 with centre c and normal n, that of its diagonals, let d_0 = p_0 - p_2,
 * d_1 = p_1 - p_3, and let J turn by 90 degrees about n. The closest rectangle with edges 0 1 and
 * 1 2 in the ratio e^{2r} is c + a, c + b, c - a, c - b with
 *     4 a = d_0 - tanh(2r) d_1 - J d_1 / cosh(2r),   b = J a / cosh(2r) - tanh(2r) a. */
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

/* r->scratch becomes the mean of *value around each quad, and then *value, a few times. */
static void average_rounds(qc_ctx *ctx, qc__relaxation *r, double **value, qc__body *mean) {
    for (int round = 0; round < SIZE_ROUNDS; round++) {
        qc__parallel_for(ctx, r->quads->n_faces, 1024, mean, r);
        double *swap = *value;
        *value = r->scratch;
        r->scratch = swap;
    }
}

/* Half the logarithm of the ratio of the edges 0 1, 2 3 and 1 2, 3 0. */
static double edge_ratio(const qc__relaxation *r, int32_t f) {
    double sum[2] = {0, 0};
    for (int k = 0; k < 4; k++) {
        const double *p = corner(r, f, k), *q = corner(r, f, (k + 1) & 3);
        const double d[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
        sum[k & 1] += qc__norm3(d);
    }
    return sum[0] > 0 && sum[1] > 0 ? 0.5 * log(sum[0] / sum[1]) : 0;
}

/* The ratio of the quad across edge k of f, in the order of the edges of f; that of f itself where
 * there is none. Of the quads at the start of the edge it is the one which has its end as well. */
static double ratio_across(const qc__relaxation *r, int32_t f, int k) {
    const int32_t *vertex = r->quads->face_vertex + 4 * (int64_t)f;
    const int32_t v = vertex[k], w = vertex[(k + 1) & 3];
    for (int32_t i = r->around.face_start[v]; i < r->around.face_start[v + 1]; i++) {
        const int32_t g = r->around.face[i] / 4, j = (r->around.face[i] + 3) & 3;
        if (g == f || r->quads->face_vertex[4 * (int64_t)g + j] != w) continue;
        return (j ^ k) & 1 ? -r->ratio[g] : r->ratio[g];
    }
    return r->ratio[f];
}

static void average_ratio(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const qc__relaxation *r = arg;
    (void)worker;
    for (int64_t f = begin; f < end; f++) {
        r->scratch[f] = 0.2 * r->ratio[f];
        for (int k = 0; k < 4; k++) r->scratch[f] += 0.2 * ratio_across(r, (int32_t)f, k);
    }
}

void qc__measure_sizes(qc_ctx *ctx, qc__relaxation *r) {
    const int32_t n = r->quads->n_faces;
    for (int32_t f = 0; f < n; f++) r->size[f] = edge_length(r, f);
    average_rounds(ctx, r, &r->size, average);
    for (int32_t f = 0; f < n; f++) r->ratio[f] = r->rectangles ? edge_ratio(r, f) : 0;
    if (r->rectangles) average_rounds(ctx, r, &r->ratio, average_ratio);
    for (int32_t f = 0; f < n; f++) {
        const double c = cosh(2 * r->ratio[f]);
        r->rectangle[f] =
            (qc__rectangle){tanh(2 * r->ratio[f]), 1 / c, sqrt(0.5 * c) / cosh(r->ratio[f])};
    }
}

/* Corner k of the rectangle for quad f is added to sum. */
static void add_corner(const qc__relaxation *r, int32_t f, int k, double sum[3]) {
    const double *p[4];
    double d[2][3], centre[3], n[3], turned[3], a[3];
    const qc__rectangle *shape = &r->rectangle[f];
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
    for (int i = 0; i < 3; i++)
        a[i] = 0.25 * (d[0][i] - shape->skew * d[1][i] - shape->turn * turned[i]);
    const double radius = qc__norm3(a), wanted = r->size[f] * shape->half;
    const double scale = radius > 0 ? 1 - r->uniformity + r->uniformity * wanted / radius : 1;
    if (k & 1) {
        qc__cross3(n, a, turned);
        for (int i = 0; i < 3; i++) a[i] = shape->turn * turned[i] - shape->skew * a[i];
    }
    for (int i = 0; i < 3; i++) sum[i] += centre[i] + (k < 2 ? scale : -scale) * a[i];
}

void qc__square_target(const qc__relaxation *r, int32_t v, double target[3]) {
    const int32_t begin = r->around.face_start[v], end = r->around.face_start[v + 1];
    target[0] = target[1] = target[2] = 0;
    for (int32_t i = begin; i < end; i++)
        add_corner(r, r->around.face[i] / 4, r->around.face[i] & 3, target);
    for (int k = 0; k < 3; k++) target[k] /= end - begin;
}
