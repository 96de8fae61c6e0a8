/* Pieces of grid cells on surfaces with boundary: the faces which meet an open unit square, reached
 * from one of them, found by exact tests; a hash table tells which piece holds a face and square.
 */
#include "sdk/map/extract/internal.h"

/* --- tests in the frame of a square ----------------------------------------------------------- */

/* Separating axes u, v and the segment's normal. */
bool qc__meets_square(qc__point a, qc__point b, qc__point o, int64_t unit) {
    a = qc__minus(a, o);
    b = qc__minus(b, o);
    if ((a.u <= 0 && b.u <= 0) || (a.u >= unit && b.u >= unit)) return false;
    if ((a.v <= 0 && b.v <= 0) || (a.v >= unit && b.v >= unit)) return false;
    const qc__point d = qc__minus(b, a);
    int left = 0, right = 0;
    for (int i = 0; i < 4; i++) {
        const qc__point corner = {i & 1 ? unit : 0, i & 2 ? unit : 0};
        const int64_t side = qc__cross(d, qc__minus(corner, a));
        left += side > 0;
        right += side < 0;
    }
    return left > 0 && right > 0;
}

bool qc__triangle_meets_square(const qc__point c[3], qc__point o, int64_t unit) {
    int below[4] = {0};
    for (int k = 0; k < 3; k++) {
        const qc__point p = qc__minus(c[k], o), e = qc__minus(c[(k + 1) % 3], c[k]);
        below[0] += p.u <= 0;
        below[1] += p.u >= unit;
        below[2] += p.v <= 0;
        below[3] += p.v >= unit;
        int inside = 0;
        for (int i = 0; i < 4; i++) {
            const qc__point corner = {i & 1 ? unit : 0, i & 2 ? unit : 0};
            inside += qc__cross(e, qc__minus(corner, p)) > 0;
        }
        if (inside == 0) return false;
    }
    return below[0] < 3 && below[1] < 3 && below[2] < 3 && below[3] < 3;
}

/* Area of the triangle in the unit square: clipped side by side, then the shoelace formula. */
static double covered(const qc__point c[3], int64_t unit) {
    double p[2][16];
    int n = 3, now = 0;
    for (int k = 0; k < 3; k++) {
        p[0][2 * k] = (double)c[k].u / (double)unit;
        p[0][2 * k + 1] = (double)c[k].v / (double)unit;
    }
    for (int side = 0; side < 4 && n > 0; side++, now = !now) {
        const int axis = side & 1;
        const double sign = side < 2 ? 1 : -1, bound = side < 2 ? 0 : -1;
        int m = 0;
        for (int i = 0; i < n; i++) {
            const double *a = p[now] + 2 * i, *b = p[now] + 2 * ((i + 1) % n);
            const double da = sign * a[axis] - bound, db = sign * b[axis] - bound;
            double *q = p[!now];
            if (da >= 0) {
                q[2 * m] = a[0];
                q[2 * m++ + 1] = a[1];
            }
            if ((da >= 0) == (db >= 0)) continue;
            const double s = da / (da - db);
            q[2 * m] = a[0] + s * (b[0] - a[0]);
            q[2 * m++ + 1] = a[1] + s * (b[1] - a[1]);
        }
        n = m;
    }
    double twice = 0;
    for (int i = 0; i < n; i++) {
        const double *a = p[now] + 2 * i, *b = p[now] + 2 * ((i + 1) % n);
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return 0.5 * twice;
}

/* --- hash table ------------------------------------------------------------------------------- */

/* Lower left corner of the square in the chart. */
static qc__point lower_left(const qc__visit *v, int64_t unit) {
    return (qc__point){v->at.u - (v->d == 1 || v->d == 2 ? unit : 0),
                       v->at.v - (v->d >= 2 ? unit : 0)};
}

static uint64_t hash(int32_t face, qc__point o) {
    uint64_t h = (uint64_t)face * 0x9E3779B97F4A7C15u;
    h = (h ^ (uint64_t)o.u ^ (h >> 29)) * 0xBF58476D1CE4E5B9u;
    h = (h ^ (uint64_t)o.v ^ (h >> 32)) * 0x94D049BB133111EBu;
    return h ^ (h >> 31);
}

/* The slot which holds the visit or is free for it. */
static int64_t slot_of(const qc__pieces *p, const qc__visit *v) {
    const int64_t unit = (int64_t)1 << p->ports->lattice->g->bits;
    const qc__point o = lower_left(v, unit);
    int64_t i = (int64_t)(hash(v->face, o) & (uint64_t)(p->n_slots - 1));
    for (; p->slot[i] >= 0; i = (i + 1) & (p->n_slots - 1)) {
        const qc__visit *w = &p->visit[p->slot[i]];
        const qc__point q = lower_left(w, unit);
        if (w->face == v->face && q.u == o.u && q.v == o.v) break;
    }
    return i;
}

int32_t qc__pieces_find(const qc__pieces *p, qc__visit v) {
    return p->n_slots == 0 ? -1 : p->slot[slot_of(p, &v)];
}

static bool grow(qc_ctx *ctx, qc__pieces *p) {
    const int64_t n = p->n_slots > 0 ? 2 * p->n_slots : 1024;
    int32_t *slot = QC__NEW(ctx, int32_t, n);
    if (!slot) return false;
    for (int64_t i = 0; i < n; i++) slot[i] = -1;
    qc__free(p->slot);
    p->slot = slot;
    p->n_slots = n;
    for (int64_t i = 0; i < p->n_visits; i++) p->slot[slot_of(p, &p->visit[i])] = (int32_t)i;
    return true;
}

/* Adds a visit which is new. */
static bool push(qc_ctx *ctx, qc__pieces *p, qc__visit v) {
    if (2 * p->n_visits >= p->n_slots && !grow(ctx, p)) return false;
    int32_t *slot = &p->slot[slot_of(p, &v)];
    if (*slot >= 0) return true;
    if (!qc__reserve(ctx, (void **)&p->visit, &p->visit_capacity, p->n_visits + 1,
                     sizeof *p->visit))
        return false;
    v.piece = p->n - 1;
    *slot = (int32_t)p->n_visits;
    p->visit[p->n_visits++] = v;
    return true;
}

void qc__pieces_free(qc__pieces *p) {
    qc__free(p->piece);
    qc__free(p->visit);
    qc__free(p->slot);
    *p = (qc__pieces){0};
}

/* --- flood ------------------------------------------------------------------------------------ */

static bool holds_centre(const qc__point c[3], int64_t unit) {
    const qc__point centre = {unit / 2, unit / 2};
    for (int k = 0; k < 3; k++)
        if (qc__cross(qc__minus(c[(k + 1) % 3], c[k]), qc__minus(centre, c[k])) < 0) return false;
    return true;
}

static bool in_open_square(qc__point p, int64_t unit) {
    return p.u > 0 && p.u < unit && p.v > 0 && p.v < unit;
}

qc_status qc__pieces_flood(qc_ctx *ctx, qc__pieces *p, qc__visit first) {
    const qc_grid_map *g = p->ports->lattice->g;
    const qc_mesh *m = g->mesh;
    const int64_t unit = (int64_t)1 << g->bits, begin = p->n_visits;
    if (p->n == INT32_MAX / 8 || p->n_visits > INT32_MAX / 2)
        return qc__fail(ctx, QC_ERR_FAILED, first.face, "too many cells meet the boundary");
    if (!qc__reserve(ctx, (void **)&p->piece, &p->piece_capacity, p->n + 1, sizeof *p->piece))
        return QC_ERR_NOMEM;
    p->piece[p->n++] = (qc__piece){.first = begin, .code = -1};
    if (!push(ctx, p, first)) return QC_ERR_NOMEM;
    double area = 0;
    bool middle = false;
    int64_t half_edges = 0, vertices = 0; /* inside the surface and the square */
    for (int64_t i = begin; i < p->n_visits; i++) {
        const qc__visit v = p->visit[i];
        qc__point corner[3];
        for (int k = 0; k < 3; k++) {
            const int32_t c = 3 * v.face + k, at = m->face_vertex[c];
            corner[k] = qc__in_square(&v, qc__grid_corner(g, c));
            vertices += m->vertex_corner[at] == c && !qc_vertex_on_boundary(m, at) &&
                        in_open_square(corner[k], unit);
        }
        area += covered(corner, unit);
        middle |= holds_centre(corner, unit);
        for (int k = 0; k < 3; k++) {
            const int32_t h = 3 * v.face + k;
            if (m->twin[h] < 0 || !qc__meets_square(corner[(k + 1) % 3], corner[(k + 2) % 3],
                                                    (qc__point){0, 0}, unit))
                continue;
            half_edges++;
            const qc__visit w = {.face = m->twin[h] / 3,
                                 .at = qc__grid_transition(g, h, v.at),
                                 .d = (v.d + qc__grid_rotation(g, h)) & 3};
            if (!push(ctx, p, w)) return QC_ERR_NOMEM;
        }
    }
    /* F - E + V of the open faces, inner edges and inner vertices is 1 for a disk. */
    qc__piece *piece = &p->piece[p->n - 1];
    piece->area = area;
    piece->middle = middle;
    piece->disk = 2 * (p->n_visits - begin) - half_edges + 2 * vertices == 2 && area < 1 + 1e-6;
    return QC_OK;
}
