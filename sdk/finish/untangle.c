/* Quads which improve.c leaves bad: the vertices of a patch about each move together (descend.c),
 * from where they are, or else from places between their neighbours. A patch keeps its new places
 * where its bad quads get better, none gets worse than the worst was, and the largest distance
 * between quads and surface does not grow. Where it does not, wider ones are tried. */
#include <string.h>

#include "sdk/finish/internal.h"

enum { MOST_RINGS = 4, SMOOTH_ROUNDS = 10 };
/* Times the quality wanted. */
static const double bad_part = 0.3;

/* The quads within some rings about a seed, and the vertices of those further inside. */
typedef struct patch {
    qc__relaxation *r;
    double limit, bad;     /* distance which none may exceed; quality below which a quad counts */
    int32_t *first, *near; /* n_faces + 1, n_vertices of the mesh: those nearest to each quad */
    int32_t n_quads, n_vertices;
    int32_t *quad, *level; /* level: of each quad of all, -1 = not in the patch */
    int32_t *vertex;
    uint8_t *inside;  /* of each vertex of all */
    qc__spot *before; /* of each vertex of the patch */
    double *step;
} patch;

typedef struct score {
    double least, lack; /* worst quality; sum of squares of what bad quads lack, those which
                           face away counting as -1 */
    int32_t turned;
} score;

static score rate(const patch *p) {
    score s = {1, 0, 0};
    for (int32_t i = 0; i < p->n_quads; i++) {
        const int32_t f = p->quad[i], v = p->r->quads->face_vertex[4 * (int64_t)f];
        const bool away = qc__quad_turned(p->r, f, 0, p->r->position + 3 * (int64_t)v);
        const double own = qc__quad_quality(p->r, f), q = away ? -1 : own;
        const double lack = fmax(p->bad - q, 0);
        s.least = fmin(s.least, own);
        s.lack += lack * lack;
        s.turned += q <= 0;
    }
    return s;
}

static void add_quad(patch *p, int32_t f, int32_t level) {
    if (p->level[f] >= 0) return;
    p->level[f] = level;
    p->quad[p->n_quads++] = f;
}

static void grow(patch *p, int32_t seed, int32_t rings) {
    const qc__neighbours *a = &p->r->around;
    p->n_quads = p->n_vertices = 0;
    add_quad(p, seed, 0);
    for (int32_t i = 0; i < p->n_quads && p->level[p->quad[i]] < rings; i++)
        for (int k = 0; k < 4; k++) {
            const int32_t v = p->r->quads->face_vertex[4 * (int64_t)p->quad[i] + k];
            if (p->inside[v]) continue;
            p->inside[v] = 1;
            p->vertex[p->n_vertices++] = v;
            for (int32_t j = a->face_start[v]; j < a->face_start[v + 1]; j++)
                add_quad(p, a->face[j] / 4, p->level[p->quad[i]] + 1);
        }
    for (int32_t i = 0; i < p->n_vertices; i++) p->inside[p->vertex[i]] = 0;
    for (int32_t i = 0; i < p->n_quads; i++) p->level[p->quad[i]] = -1;
}

/* Leaves the vertices which move, and remembers their places. */
static void remember(patch *p) {
    const int32_t n = p->n_vertices;
    p->n_vertices = 0;
    for (int32_t i = 0; i < n; i++) {
        const int32_t v = p->vertex[i];
        if (p->r->anchor[v] == QC__FIXED) continue;
        qc__spot *at = &p->before[p->n_vertices];
        *at = p->r->spot[v];
        memcpy(at->x, p->r->position + 3 * (int64_t)v, sizeof at->x);
        p->vertex[p->n_vertices++] = v;
    }
}

static double distance(const qc__relaxation *r, int32_t f, const double x[3]) {
    static const int corner[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const int32_t *v = r->quads->face_vertex + 4 * (int64_t)f;
    double least = INFINITY, weight[3];
    for (int t = 0; t < 2; t++) {
        double y[9];
        for (int i = 0; i < 3; i++)
            memcpy(y + 3 * i, r->position + 3 * (int64_t)v[corner[t][i]], 3 * sizeof *y);
        least = fmin(least, qc_triangle_distance2(y, x, weight));
    }
    return sqrt(least);
}

/* Whether no quad of the patch is too far from the surface, and no vertex which one of them was
 * nearest to too far from them all. */
static bool is_near(const patch *p) {
    for (int32_t i = 0; i < p->n_quads; i++) {
        const int32_t f = p->quad[i];
        if (qc__quad_gap(p->r, f) > p->limit) return false;
        for (int32_t j = p->first[f]; j < p->first[f + 1]; j++) {
            const double *x = p->r->mesh->position + 3 * (int64_t)p->near[j];
            double d = distance(p->r, f, x);
            for (int32_t k = 0; k < p->n_quads && d > p->limit; k++)
                d = distance(p->r, p->quad[k], x);
            if (d > p->limit) return false;
        }
    }
    return true;
}

/* The mean of the vertices joined to v by edges. */
static void mean_around(const qc__relaxation *r, int32_t v, double x[3]) {
    const qc__neighbours *a = &r->around;
    const int32_t begin = a->face_start[v], end = a->face_start[v + 1];
    x[0] = x[1] = x[2] = 0;
    for (int32_t i = begin; i < end; i++)
        for (int side = 1; side <= 3; side += 2) {
            const int32_t w = r->quads->face_vertex[(a->face[i] & ~3) + ((a->face[i] + side) & 3)];
            for (int k = 0; k < 3; k++)
                x[k] += 0.5 * r->position[3 * (int64_t)w + k] / (end - begin);
        }
}

/* Another start: places between the neighbours, whatever becomes of the quads. */
static void smooth(patch *p) {
    qc__relaxation *r = p->r;
    for (int round = 0; round < SMOOTH_ROUNDS; round++)
        for (int32_t i = 0; i < p->n_vertices; i++) {
            const int32_t v = p->vertex[i];
            double d[3];
            qc__spot spot;
            mean_around(r, v, d);
            for (int k = 0; k < 3; k++) d[k] -= r->position[3 * (int64_t)v + k];
            if (qc__step(r, v, d, &spot)) qc__place(r, v, &spot);
        }
}

/* Moves the vertices of the patch; true when that made it better. */
static bool descend(patch *p, bool angles, bool smoothed) {
    const score before = rate(p);
    if (smoothed) smooth(p);
    qc__quads_descend(p->r, angles, p->n_vertices, p->vertex, p->step);
    const score after = rate(p);
    if (after.least >= before.least && after.lack < before.lack && after.turned <= before.turned &&
        is_near(p))
        return true;
    for (int32_t i = 0; i < p->n_vertices; i++) qc__place(p->r, p->vertex[i], &p->before[i]);
    return false;
}

static void mend(patch *p, int32_t seed, int32_t rings) {
    grow(p, seed, rings);
    remember(p);
    for (int i = 0; i < 4; i++)
        if (descend(p, i >= 2, i & 1)) return;
}

static void sort_nearest(patch *p, const int32_t *nearest) {
    const int32_t n = p->r->mesh->n_vertices, n_faces = p->r->quads->n_faces;
    for (int32_t v = 0; v < n; v++) p->first[nearest[v] + 1]++;
    for (int32_t f = 0; f < n_faces; f++) p->first[f + 1] += p->first[f];
    for (int32_t v = n; v-- > 0;) p->near[--p->first[nearest[v] + 1]] = v;
    for (int32_t f = 0; f < n_faces; f++) p->first[f] = p->first[f + 1];
    p->first[n_faces] = n;
}

static bool allocate(qc_ctx *ctx, patch *p) {
    const int64_t n = p->r->quads->n_vertices, n_faces = p->r->quads->n_faces;
    p->first = QC__ZERO(ctx, int32_t, n_faces + 1);
    p->near = QC__NEW(ctx, int32_t, p->r->mesh->n_vertices);
    p->quad = QC__NEW(ctx, int32_t, n_faces);
    p->level = QC__NEW(ctx, int32_t, n_faces);
    p->vertex = QC__NEW(ctx, int32_t, n);
    p->inside = QC__ZERO(ctx, uint8_t, n);
    p->before = QC__NEW(ctx, qc__spot, n);
    p->step = QC__NEW(ctx, double, n);
    return p->first && p->near && p->quad && p->level && p->vertex && p->inside && p->before &&
           p->step;
}

static void clear(patch *p) {
    qc__free(p->first);
    qc__free(p->near);
    qc__free(p->quad);
    qc__free(p->level);
    qc__free(p->vertex);
    qc__free(p->inside);
    qc__free(p->before);
    qc__free(p->step);
}

qc_status qc__quads_untangle(qc_ctx *ctx, double limit, const int32_t *nearest, qc__relaxation *r) {
    const int32_t n_faces = r->quads->n_faces;
    patch p = {.r = r, .limit = limit, .bad = bad_part * r->quality};
    qc_status status = allocate(ctx, &p) ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) sort_nearest(&p, nearest);
    for (int32_t f = 0; f < n_faces && status == QC_OK; f++) p.level[f] = -1;
    for (int32_t rings = 1; rings <= MOST_RINGS && status == QC_OK; rings *= 2)
        for (int32_t f = 0; f < n_faces && status == QC_OK; f++) {
            if (qc__quad_quality(r, f) >= p.bad) continue;
            mend(&p, f, rings);
            if (!qc__progress(ctx, (double)f / n_faces)) status = QC_ERR_CANCELLED;
        }
    clear(&p);
    return status;
}
