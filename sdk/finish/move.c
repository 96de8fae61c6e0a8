/* Moving a vertex on the surface, with the quads around it watched. */
#include "sdk/finish/internal.h"

enum { CHUNK = 64, HALVINGS = 3 };
/* In edge lengths. */
#define LEAST_STEP 1e-3
/* Cosine to the surface below which a quad faces away from it instead of bending around it. */
static const double turned = -0.3;

/* Scaled Jacobian of quad f with its corner k at x. */
static double quality_with(const qc__relaxation *r, int32_t f, int k, const double *x) {
    static const int32_t order[4] = {0, 1, 2, 3};
    double p[12];
    for (int i = 0; i < 4; i++) {
        const double *q =
            i == k ? x : r->position + 3 * (int64_t)r->quads->face_vertex[4 * (int64_t)f + i];
        for (int j = 0; j < 3; j++) p[3 * i + j] = q[j];
    }
    return qc__scaled_jacobian(p, order, 4);
}

double qc__ring_quality(const qc__relaxation *r, int32_t v, const double x[3]) {
    double least = 1;
    for (int32_t i = r->around.face_start[v]; i < r->around.face_start[v + 1]; i++)
        least = fmin(least, quality_with(r, r->around.face[i] / 4, r->around.face[i] & 3, x));
    return least;
}

double qc__ring_badness(const qc__relaxation *r, int32_t v, const double x[3]) {
    double sum = 0;
    for (int32_t i = r->around.face_start[v]; i < r->around.face_start[v + 1]; i++) {
        const double q = quality_with(r, r->around.face[i] / 4, r->around.face[i] & 3, x);
        const double square = (1 - q) * (1 - q), fourth = square * square;
        sum += fourth * fourth;
    }
    return sum;
}

/* Cosine between the area vector of quad f and the surface about it, with its corner k at x. */
static double side(const qc__relaxation *r, int32_t f, int k, const double *x) {
    const int32_t *v = r->quads->face_vertex + 4 * (int64_t)f;
    const double *p[4];
    double d[2][3], area[3], normal[3] = {0, 0, 0};
    for (int i = 0; i < 4; i++) p[i] = i == k ? x : r->position + 3 * (int64_t)v[i];
    for (int j = 0; j < 3; j++) {
        d[0][j] = p[2][j] - p[0][j];
        d[1][j] = p[3][j] - p[1][j];
        for (int i = 0; i < 4; i++) normal[j] += r->normal[3 * (int64_t)r->spot[v[i]].face + j];
    }
    qc__cross3(d[0], d[1], area);
    const double scale = qc__norm3(area) * qc__norm3(normal);
    return scale > 0 ? qc__dot3(area, normal) / scale : 0;
}

bool qc__quad_turned(const qc__relaxation *r, int32_t f, int k, const double *x) {
    return side(r, f, k, x) < turned;
}

bool qc__ring_turns(const qc__relaxation *r, int32_t v, const double x[3]) {
    const double *now = r->position + 3 * (int64_t)v;
    for (int32_t i = r->around.face_start[v]; i < r->around.face_start[v + 1]; i++) {
        const int32_t f = r->around.face[i] / 4;
        const int k = r->around.face[i] & 3;
        const double there = side(r, f, k, x);
        if (there < turned && there < side(r, f, k, now)) return true;
    }
    return false;
}

bool qc__ring_allows(const qc__relaxation *r, int32_t v, const double x[3]) {
    const double *now = r->position + 3 * (int64_t)v;
    for (int32_t i = r->around.face_start[v]; i < r->around.face_start[v + 1]; i++) {
        const int32_t f = r->around.face[i] / 4;
        const int k = r->around.face[i] & 3;
        const double q = quality_with(r, f, k, x);
        if (q < r->quality && q < quality_with(r, f, k, now)) return false;
    }
    return !qc__ring_turns(r, v, x);
}

bool qc__step(const qc__relaxation *r, int32_t v, const double d[3], qc__spot *out) {
    const qc__spot *now = &r->spot[v];
    qc__spot next = {.face = now->face, .arc = now->arc};
    if (r->anchor[v] >= 0) {
        double tangent[3];
        qc__curve_point(&r->curves, r->anchor[v], now->arc, &next.face, next.weight, tangent);
        next.arc = qc__curve_point(&r->curves, r->anchor[v], now->arc + qc__dot3(d, tangent),
                                   &next.face, next.weight, NULL);
    } else {
        const double *x = r->position + 3 * (int64_t)v;
        const double p[3] = {x[0] + d[0], x[1] + d[1], x[2] + d[2]};
        r->closest->query(r->tree, p, &next.face, next.weight);
        if (!(qc__dot3(r->normal + 3 * (int64_t)now->face, r->normal + 3 * (int64_t)next.face) > 0))
            return false;
    }
    qc__face_point(r->mesh, next.face, next.weight, next.x);
    *out = next;
    return true;
}

void qc__place(qc__relaxation *r, int32_t v, const qc__spot *spot) {
    r->spot[v] = *spot;
    for (int k = 0; k < 3; k++) r->position[3 * (int64_t)v + k] = spot->x[k];
}

void qc__towards_squares(qc__relaxation *r, int32_t v) {
    double target[3], d[3];
    qc__spot spot;
    if (r->anchor[v] == QC__FIXED || r->pinned[v]) return;
    qc__square_target(r, v, target);
    const double *normal = r->normal + 3 * (int64_t)r->spot[v].face;
    for (int k = 0; k < 3; k++) d[k] = target[k] - r->position[3 * (int64_t)v + k];
    const double along = qc__dot3(d, normal);
    for (int k = 0; k < 3; k++) d[k] -= along * normal[k];
    if (qc__norm3(d) < LEAST_STEP * qc__size_at(r, v)) return;
    for (int i = 0; i < HALVINGS; i++) {
        if (qc__step(r, v, d, &spot) && qc__ring_allows(r, v, spot.x)) {
            qc__place(r, v, &spot);
            return;
        }
        for (int k = 0; k < 3; k++) d[k] *= 0.5;
    }
}

typedef struct sweep {
    qc__relaxation *r;
    const int32_t *vertex;
    qc__visit *visit;
} sweep;

static void run(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const sweep *s = arg;
    (void)worker;
    for (int64_t i = begin; i < end; i++) s->visit(s->r, s->vertex[i]);
}

qc_status qc__visit_all(qc_ctx *ctx, qc__relaxation *r, qc__visit *visit) {
    const qc__neighbours *n = &r->around;
    for (int32_t c = 0; c < n->n_classes; c++) {
        if (!qc__progress(ctx, (double)c / n->n_classes)) return QC_ERR_CANCELLED;
        const int64_t count = n->class_start[c + 1] - n->class_start[c];
        sweep s = {r, n->vertex + n->class_start[c], visit};
        qc__parallel_for(ctx, count, c < QC__CLASSES - 1 ? CHUNK : count, run, &s);
    }
    return QC_OK;
}
