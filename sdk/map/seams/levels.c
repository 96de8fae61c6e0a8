/* Levels: the one coordinate in which a feature is constant (see features.h).
 *
 * Coordinates of the F_v which an edge of a feature joins are equal up to sign and translations, so
 * those of a whole chain are x = +-L + (translations) with one level L. They are found by walking
 * over the features; where a walk closes, at loops and where chains meet, and at points on the
 * chain, a relation between symbols is left. */
#include <string.h>
#include "sdk/map/seams/levels.h"

typedef struct joint { /* sign x of one end of an edge: the part of its corner value across */
    int32_t x, corner;
    int8_t sign;
} joint;

typedef struct walker {
    qc_ctx *ctx;
    qc__seams *s;
    const qc__features *f;
    int64_t *incident_start; /* features at each vertex */
    int32_t *incident;
    int32_t *queue;
    qc__levels *out;
    int64_t n_pool, pool_capacity;
    double *sum; /* n_segments x 2, dense accumulator over the translations ... */
    uint8_t *in_sum;
    int32_t *touched, n_touched;
    int64_t relation_capacity, symbol_capacity, value_capacity, level_capacity;
} walker;

/* --- sums of translations --------------------------------------------------------------------- */

static void add(walker *q, int32_t symbol, double value) {
    if (!q->in_sum[symbol]) {
        q->in_sum[symbol] = 1;
        q->sum[symbol] = 0;
        q->touched[q->n_touched++] = symbol;
    }
    q->sum[symbol] += value;
}

/* Part `part` of the translations in the wedge of a corner. */
static void add_wedge(walker *q, int32_t corner, int32_t part, double factor) {
    const qc__seams *s = q->s;
    const int32_t w = s->corner_wedge[corner];
    for (int64_t i = s->wedge_start[w]; i < s->wedge_start[w + 1]; i++)
        add(q, qc__translation_symbol(s->term_segment[i], (part + s->term_turn[i]) & 1),
            factor * qc__part_sign(part, s->term_turn[i]));
}

static void add_offset(walker *q, const qc__coordinate *x, double factor) {
    for (int64_t i = x->start; i < x->start + x->n; i++)
        add(q, q->out->pool[i].symbol, factor * x->offset_sign * q->out->pool[i].value);
}

static int32_t settle(walker *q) { /* drops zeros; how many are left */
    int32_t n = 0;
    for (int32_t i = 0; i < q->n_touched; i++) {
        const int32_t symbol = q->touched[i];
        q->in_sum[symbol] = 0;
        if (q->sum[symbol] != 0) q->touched[n++] = symbol;
    }
    q->n_touched = 0;
    return n;
}

/* --- relations -------------------------------------------------------------------------------- */

/* Appends the n terms left by settle, and those of up to two symbols with a value. */
static bool push_relation(walker *q, int32_t n, int32_t a, int32_t a_value, int32_t b,
                          int32_t b_value) {
    qc__seams *s = q->s;
    const int64_t at = s->level_relation_start ? s->level_relation_start[s->n_level_relations] : 0;
    if (!qc__reserve(q->ctx, (void **)&s->level_relation_start, &q->relation_capacity,
                     s->n_level_relations + 2, sizeof(int64_t)) ||
        !qc__reserve(q->ctx, (void **)&s->level_relation_symbol, &q->symbol_capacity, at + n + 2,
                     sizeof(int32_t)) ||
        !qc__reserve(q->ctx, (void **)&s->level_relation_value, &q->value_capacity, at + n + 2,
                     sizeof(int32_t)))
        return false;
    int64_t end = at;
    for (int32_t i = 0; i < n; i++) {
        s->level_relation_symbol[end] = q->touched[i];
        s->level_relation_value[end++] = (int32_t)q->sum[q->touched[i]];
    }
    const int32_t symbol[2] = {a, b}, value[2] = {a_value, b_value};
    for (int32_t i = 0; i < 2; i++)
        if (value[i] != 0) {
            s->level_relation_symbol[end] = symbol[i];
            s->level_relation_value[end++] = value[i];
        }
    s->level_relation_start[s->n_level_relations] = at;
    s->level_relation_start[s->n_level_relations + 1] = end;
    if (end > at) s->n_level_relations++;
    return true;
}

/* --- the walk --------------------------------------------------------------------------------- */

static joint link_of(const walker *q, int32_t corner, int32_t part) {
    const int32_t turn = q->s->wedge_turn[q->s->corner_wedge[corner]];
    const int32_t v = q->s->mesh->face_vertex[corner];
    const joint l = {2 * v + ((part + turn) & 1), corner, (int8_t)qc__part_sign(part, turn)};
    return l;
}

/* The two ends of a feature: links and the part which is constant. */
static int32_t ends_of(const walker *q, int32_t e, joint *a, joint *b) {
    const int32_t h = q->s->mesh->edge_halfedge[2 * (int64_t)e];
    const int32_t part = 1 - (qc__feature_direction(q->f, h) & 1);
    *a = link_of(q, qc_next(h), part);
    *b = link_of(q, qc_prev(h), part);
    return part;
}

/* x_b = sign_b (sign_a x_a + O_a - O_b), O the translations in the wedges. */
static bool reach(walker *q, const joint *a, const joint *b, int32_t part) {
    const qc__coordinate from = q->out->coordinate[a->x];
    qc__coordinate *to = &q->out->coordinate[b->x];
    const int8_t sign = (int8_t)(a->sign * b->sign);
    add_wedge(q, a->corner, part, 1);
    add_wedge(q, b->corner, part, -1);
    const int32_t change = settle(q);
    *to = from;
    to->sign = (int8_t)(sign * from.sign);
    to->offset_sign = (int8_t)(sign * from.offset_sign);
    if (change == 0) return true;
    add_wedge(q, a->corner, part, b->sign);
    add_wedge(q, b->corner, part, -b->sign);
    add_offset(q, &from, sign);
    const int32_t n = settle(q);
    if (!qc__reserve(q->ctx, (void **)&q->out->pool, &q->pool_capacity, q->n_pool + n,
                     sizeof *q->out->pool))
        return false;
    to->offset_sign = 1;
    to->start = q->n_pool;
    to->n = n;
    for (int32_t i = 0; i < n; i++) {
        const qc__symbol_term t = {q->touched[i], (int32_t)q->sum[q->touched[i]]};
        q->out->pool[q->n_pool++] = t;
    }
    return true;
}

/* sign_a x_a + O_a = sign_b x_b + O_b between coordinates of one level. */
static bool close_walk(walker *q, const joint *a, const joint *b, int32_t part) {
    const qc__coordinate *x = &q->out->coordinate[a->x], *y = &q->out->coordinate[b->x];
    add_wedge(q, a->corner, part, 1);
    add_wedge(q, b->corner, part, -1);
    add_offset(q, x, a->sign);
    add_offset(q, y, -b->sign);
    const int32_t n = settle(q);
    return push_relation(q, n, qc__level_symbol(q->s, x->level),
                         a->sign * x->sign - b->sign * y->sign, 0, 0);
}

static bool start_level(walker *q, int32_t x) {
    qc__seams *s = q->s;
    if (!qc__reserve(q->ctx, (void **)&s->level_coordinate, &q->level_capacity, s->n_levels + 1,
                     sizeof(int32_t)))
        return false;
    const qc__coordinate root = {s->n_levels, 1, 1, 0, 0};
    q->out->coordinate[x] = root;
    s->level_coordinate[s->n_levels++] = x;
    return true;
}

static bool walk_from(walker *q, int32_t root) {
    int32_t n = 0;
    q->queue[n++] = root;
    for (int32_t at = 0; at < n; at++) {
        const int32_t x = q->queue[at], v = x / 2;
        for (int64_t i = q->incident_start[v]; i < q->incident_start[v + 1]; i++) {
            joint a, b;
            const int32_t part = ends_of(q, q->incident[i], &a, &b);
            if (a.x != x) {
                const joint swap = a;
                a = b;
                b = swap;
            }
            if (a.x != x) continue;
            if (q->out->coordinate[b.x].level < 0) {
                if (!reach(q, &a, &b, part)) return false;
                q->queue[n++] = b.x;
            } else if (!close_walk(q, &a, &b, part)) {
                return false;
            }
        }
    }
    return true;
}

static qc_status walk_features(walker *q) {
    const qc_mesh *mesh = q->s->mesh;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        joint a, b;
        if (q->f->axis[e] < 0) continue;
        ends_of(q, e, &a, &b);
        if (q->out->coordinate[a.x].level >= 0) continue;
        if (!start_level(q, a.x) || !walk_from(q, a.x)) return QC_ERR_NOMEM;
    }
    return QC_OK;
}

static qc_status collect_incidence(walker *q) {
    const qc_mesh *mesh = q->s->mesh;
    const int32_t nv = mesh->n_vertices;
    int64_t n = 0;
    q->incident_start = QC__ZERO(q->ctx, int64_t, nv + 2);
    if (!q->incident_start) return QC_ERR_NOMEM;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        for (int32_t k = 0; k < 2 && q->f->axis[e] >= 0; k++, n++)
            q->incident_start[mesh->edge_vertex[2 * (int64_t)e + k] + 2]++;
    for (int32_t v = 0; v < nv; v++) q->incident_start[v + 2] += q->incident_start[v + 1];
    q->incident = QC__NEW(q->ctx, int32_t, n);
    if (!q->incident) return QC_ERR_NOMEM;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        for (int32_t k = 0; k < 2 && q->f->axis[e] >= 0; k++)
            q->incident[q->incident_start[mesh->edge_vertex[2 * (int64_t)e + k] + 1]++] = e;
    return QC_OK;
}

/* A point on a feature: its coordinate is that of the chain. */
static qc_status bind_points(walker *q) {
    const qc__seams *s = q->s;
    for (int32_t i = 0; i < 2 * s->n_cones; i++) {
        const qc__coordinate *x = &q->out->coordinate[2 * s->cone_vertex[i / 2] + i % 2];
        if (x->level < 0) continue;
        add_offset(q, x, 1);
        const int32_t n = settle(q);
        if (!push_relation(q, n, qc__level_symbol(s, x->level), x->sign,
                           qc__position_symbol(s, i / 2, i % 2), -1))
            return QC_ERR_NOMEM;
    }
    return QC_OK;
}

static qc_status find_levels(walker *q) {
    const int64_t n_coordinates = 2 * (int64_t)q->s->mesh->n_vertices;
    const int64_t n_symbols = 2 * (int64_t)q->s->n_segments;
    q->out->coordinate = QC__NEW(q->ctx, qc__coordinate, n_coordinates);
    q->queue = QC__NEW(q->ctx, int32_t, n_coordinates);
    q->sum = QC__NEW(q->ctx, double, n_symbols);
    q->in_sum = QC__ZERO(q->ctx, uint8_t, n_symbols);
    q->touched = QC__NEW(q->ctx, int32_t, n_symbols);
    if (!q->out->coordinate || !q->queue || !q->sum || !q->in_sum || !q->touched)
        return QC_ERR_NOMEM;
    for (int64_t x = 0; x < n_coordinates; x++) q->out->coordinate[x].level = -1;
    qc_status status = collect_incidence(q);
    if (status == QC_OK) status = walk_features(q);
    return status == QC_OK ? bind_points(q) : status;
}

void qc__levels_free(qc__levels *levels) {
    qc__free(levels->coordinate);
    qc__free(levels->pool);
}

qc_status qc__levels_find(qc_ctx *ctx, qc__seams *s, const qc__features *f, qc__levels *out) {
    walker q = {.ctx = ctx, .s = s, .f = f, .out = out};
    const qc_status status = find_levels(&q);
    void *const blocks[] = {q.incident_start, q.incident, q.queue, q.sum, q.in_sum, q.touched};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
