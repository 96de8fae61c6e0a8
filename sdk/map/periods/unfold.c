/* Unfolding of a seamless map with free transitions (see unfold.h). */
#include "sdk/map/periods/unfold.h"
#include <math.h>
#include <string.h>
#include "sdk/map/periods/free_map.h"
#include "sdk/map/untangle/cones.h"
#include "sdk/map/untangle/face_energy.h"
#include "sdk/map/untangle/lbfgs.h"

static const double first_pull = 4; /* weight of |J - 1|^2 / 2 in (U.6), raised in bad places */
static const double eps_floor = 1e-3, eps_slope = 0.04; /* (U.4) */
static const double eps_winding = 0.1;  /* at least, where faces have to turn round once more */
static const double clean_det = 0.01;   /* once more after all faces are positive, up to here */
static const double same_energy = 1e-5; /* a descent which gains less has ended */
enum {
    ROUNDS = 24,       /* of falling regularisation and growing weights */
    ITERATIONS = 60,   /* of each */
    PATIENCE = 4,      /* rounds without a better state before giving up */
    EVALUATIONS = 1000 /* after which no round starts */
};

typedef struct unfolder {
    qc_ctx *ctx;
    const qc_mesh *mesh;
    const qc__seams *seams;
    const qc__features *features;
    const qc_complex *z;
    qc__free_map *free;
    qc__reduced_map reduced; /* the same map, for cones.h */
    qc__guide guide;
    int8_t *rotation;        /* n_edges */
    qc_complex *cross;       /* n_faces: 1, since z is in the charts of the map */
    double *guide_angle;     /* n_vertices */
    qc_complex *hat, *f, *g; /* 3 n_faces; f of the last x asked for, g its gradient */
    double *area, *pull;     /* n_faces */
    uint8_t *bad;            /* n_faces */
    double *x, *best;        /* n */
    double eps;
    int32_t evaluations;
} unfolder;

/* --- energy ----------------------------------------------------------------------------------- */

static double evaluate(void *user, const double *x, double *gradient) {
    unfolder *u = user;
    double energy = 0;
    u->evaluations++;
    qc__free_map_corners(u->free, x, u->f);
    for (int64_t t = 0; t < u->mesh->n_faces; t++)
        energy += qc__face_energy(u->hat + 3 * t, u->area[t], u->eps, u->pull[t], u->f + 3 * t,
                                  u->g + 3 * t);
    qc__free_map_gradient(u->free, u->g, gradient);
    return energy;
}

static qc_status precondition(qc_ctx *ctx, void *user, double *p) {
    const unfolder *u = user;
    return qc__free_map_precondition(ctx, u->free, p);
}

static qc_status descend(unfolder *u, double eps) {
    const qc__lbfgs_problem problem = {u->free->n, u, evaluate, precondition, NULL};
    u->eps = eps;
    return qc__lbfgs(u->ctx, &problem, ITERATIONS, same_energy, u->x, NULL, NULL);
}

/* --- state ------------------------------------------------------------------------------------ */

typedef struct state {
    int32_t folded, wrong;
    double least;  /* det J */
    int32_t where; /* vertex at one of them, -1 = none */
} state;

static double face_det(const unfolder *u, int64_t t) {
    return qc__jacobian_det(u->hat + 3 * t, u->f + 3 * t);
}

/* Both angles differ by whole turns inside the surface, and on features of the boundary. */
static bool winds_wrong(const unfolder *u, int32_t v) {
    return fabs(qc__map_angle(&u->guide, v) - u->guide_angle[v]) > 3;
}

static bool runs_backwards(const unfolder *u, int32_t h) {
    if (!qc__is_feature(u->features, h)) return false;
    const double _Complex way = qc__complex(u->f[qc_prev(h)]) - qc__complex(u->f[qc_next(h)]);
    return !(creal(qc__turn(way, -qc__feature_direction(u->features, h))) > 0);
}

/* f as F_v, turns and offsets of the corners. */
static void read_reduced(unfolder *u) {
    qc__reduced_map *r = &u->reduced;
    for (int32_t v = 0; v < u->mesh->n_vertices; v++)
        r->value[v] = qc__pair(qc__seams_value_at(u->seams, u->f, v));
    for (int64_t c = 0; c < 3 * (int64_t)u->mesh->n_faces; c++) {
        const qc_complex own = qc_quarter_turn(r->value[u->mesh->face_vertex[c]], r->turn[c]);
        r->offset[c] = (qc_complex){u->f[c].re - own.re, u->f[c].im - own.im};
    }
}

/* The state of f. */
static state look(unfolder *u) {
    const qc_mesh *mesh = u->mesh;
    state s = {.least = INFINITY, .where = -1};
    read_reduced(u);
    for (int64_t t = 0; t < mesh->n_faces; t++) {
        const double d = face_det(u, t);
        s.folded += !(d > 0);
        if (!(d > 0) && d < s.least) s.where = mesh->face_vertex[3 * t];
        if (d < s.least) s.least = d;
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (!winds_wrong(u, v)) continue;
        s.wrong++;
        if (s.where < 0) s.where = v;
    }
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (!runs_backwards(u, mesh->edge_halfedge[2 * (int64_t)e])) continue;
        s.wrong++;
        if (s.where < 0) s.where = mesh->edge_vertex[2 * (int64_t)e];
    }
    return s;
}

static state look_at_x(unfolder *u) {
    qc__free_map_corners(u->free, u->x, u->f);
    return look(u);
}

static bool is_clean(state s) {
    return s.folded + s.wrong == 0;
}

static bool is_better(state a, state b) {
    if (a.folded + a.wrong != b.folded + b.wrong) return a.folded + a.wrong < b.folded + b.wrong;
    return a.least > b.least + 1e-3 * fabs(b.least);
}

/* --- stiffening ------------------------------------------------------------------------------- */

static void mark_star(unfolder *u, int32_t v) {
    const int32_t start = u->mesh->vertex_corner[v];
    int32_t c = start;
    do {
        u->bad[c / 3] = 1;
        c = qc_corner_ccw(u->mesh, c);
    } while (c >= 0 && c != start);
}

/* Raises the weights of folded faces, of the stars of wrong vertices and of the faces at features
 * which run backwards, and half as much those around them: what stiffening does for linear systems
 * (Bommes, Zimmer, Kobbelt 2009, 5.4) without a new factorisation. */
static void stiffen(unfolder *u) {
    const qc_mesh *mesh = u->mesh;
    for (int64_t t = 0; t < mesh->n_faces; t++) u->bad[t] = !(face_det(u, t) > 0);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (winds_wrong(u, v)) mark_star(u, v);
    for (int32_t h = 0; h < 3 * mesh->n_faces; h++) u->bad[h / 3] |= runs_backwards(u, h);
    for (int32_t t = 0; t < mesh->n_faces; t++) u->pull[t] *= u->bad[t] ? 4 : 1;
    for (int32_t h = 0; h < 3 * mesh->n_faces; h++) {
        const int32_t g = mesh->twin[h];
        if (g >= 0 && u->pull[h / 3] < 0.5 * u->pull[g / 3]) u->pull[h / 3] = 0.5 * u->pull[g / 3];
    }
}

/* --- the whole -------------------------------------------------------------------------------- */

static double regularisation(state s) {
    const double below = s.least < 0 ? s.least : 0;
    const double eps = sqrt(eps_floor * eps_floor + eps_slope * below * below);
    return s.wrong > 0 ? fmax(eps, eps_winding) : eps;
}

/* Rounds until the map is clean and its faces are not too flat; *best is the state of u->best. */
static qc_status unfold(unfolder *u, state *best) {
    const size_t size = sizeof *u->x * (size_t)u->free->n;
    state now = *best;
    int32_t waiting = 0;
    bool last = false;
    memcpy(u->best, u->x, size);
    for (int32_t i = 0; i < ROUNDS && !last; i++) {
        if (!qc__progress(u->ctx, (double)i / ROUNDS)) return QC_ERR_CANCELLED;
        if (waiting > PATIENCE || u->evaluations >= EVALUATIONS || qc__out_of_time(u->ctx)) break;
        last = is_clean(now);
        if (!last) stiffen(u);
        const qc__range outer =
            qc__range_begin(u->ctx, NULL, (double)i / ROUNDS, (i + 1.0) / ROUNDS);
        const qc_status status = descend(u, regularisation(now));
        qc__range_end(u->ctx, outer);
        if (status != QC_OK) return status;
        now = look_at_x(u);
        waiting = is_better(now, *best) ? 0 : waiting + 1;
        last |= is_clean(now) && now.least > clean_det;
        if (waiting > 0) continue;
        *best = now;
        memcpy(u->best, u->x, size);
    }
    return QC_OK;
}

static qc_status prepare(unfolder *u, const qc__periods *periods, const double *P,
                         const qc_complex *f, const double *y) {
    const qc_mesh *mesh = u->mesh;
    const int64_t n_corners = 3 * (int64_t)mesh->n_faces;
    const qc_status status = qc__free_map_create(u->ctx, periods, P, &u->free);
    if (status != QC_OK) return status;
    u->x = QC__NEW(u->ctx, double, u->free->n);
    u->best = QC__NEW(u->ctx, double, u->free->n);
    u->bad = QC__NEW(u->ctx, uint8_t, mesh->n_faces);
    u->g = QC__NEW(u->ctx, qc_complex, n_corners);
    if (!u->x || !u->best || !u->bad || !u->g) return QC_ERR_NOMEM;
    qc__free_map_read(u->free, f, y, u->x);
    return QC_OK;
}

/* What is needed to see whether the map folds at all. */
static qc_status prepare_look(unfolder *u) {
    const qc_mesh *mesh = u->mesh;
    const qc__seams *s = u->seams;
    const int64_t n_corners = 3 * (int64_t)mesh->n_faces;
    qc__reduced_map *r = &u->reduced;
    r->mesh = mesh;
    r->value = QC__NEW(u->ctx, qc_complex, mesh->n_vertices);
    r->turn = QC__NEW(u->ctx, int8_t, n_corners);
    r->offset = QC__NEW(u->ctx, qc_complex, n_corners);
    u->rotation = QC__ZERO(u->ctx, int8_t, mesh->n_edges);
    u->cross = QC__NEW(u->ctx, qc_complex, mesh->n_faces);
    u->guide_angle = QC__NEW(u->ctx, double, mesh->n_vertices);
    u->hat = QC__NEW(u->ctx, qc_complex, n_corners);
    u->f = QC__NEW(u->ctx, qc_complex, n_corners);
    u->pull = QC__NEW(u->ctx, double, mesh->n_faces);
    u->area = QC__NEW(u->ctx, double, mesh->n_faces);
    if (!r->value || !r->turn || !r->offset || !u->rotation || !u->cross || !u->guide_angle ||
        !u->hat || !u->f || !u->area || !u->pull)
        return QC_ERR_NOMEM;
    qc_status status = qc__poll(u->ctx);
    if (status != QC_OK) return status;
    for (int64_t c = 0; c < n_corners; c++) r->turn[c] = s->wedge_turn[s->corner_wedge[c]];
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t k = s->edge_segment[e];
        if (k < 0) continue;
        const bool along = s->edge_left[e] == mesh->edge_halfedge[2 * (int64_t)e];
        u->rotation[e] = (int8_t)((along ? s->segment_turn[k] : -s->segment_turn[k]) & 3);
    }
    for (int64_t t = 0; t < mesh->n_faces; t++) {
        u->cross[t] = (qc_complex){1, 0};
        u->pull[t] = first_pull;
        qc__target_hats(u->z + 3 * t, qc__thick_targets, u->hat + 3 * t, u->area + t);
    }
    status = qc__poll(u->ctx);
    if (status != QC_OK) return status;
    u->guide = (qc__guide){r, u->rotation, u->cross, u->z};
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        u->guide_angle[v] = qc__guide_angle(&u->guide, v);
    return qc__poll(u->ctx);
}

static void release(unfolder *u) {
    qc__free_map_free(u->free);
    void *const blocks[] = {u->reduced.value,
                            u->reduced.turn,
                            u->reduced.offset,
                            u->rotation,
                            u->cross,
                            u->guide_angle,
                            u->hat,
                            u->f,
                            u->g,
                            u->area,
                            u->x,
                            u->pull,
                            u->best,
                            u->bad};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
}

qc_status qc__unfold(qc_ctx *ctx, const qc__periods *periods, const double *P,
                     const qc__features *features, const qc_complex *z, qc_complex *f, double *y,
                     qc__unfolding *result) {
    const qc__seams *s = periods->seams;
    unfolder u = {.ctx = ctx, .mesh = s->mesh, .seams = s, .features = features, .z = z};
    const size_t size = sizeof *f * 3 * (size_t)s->mesh->n_faces;
    qc_status status = prepare_look(&u);
    state before = {0}, best;
    if (status == QC_OK) {
        memcpy(u.f, f, size);
        before = look(&u);
        status = qc__poll(ctx);
    }
    best = before;
    if (status == QC_OK && before.folded + before.wrong > 0) {
        status = prepare(&u, periods, P, f, y);
        if (status == QC_OK) status = unfold(&u, &best);
        if (status == QC_OK && is_better(best, before)) {
            qc__free_map_corners(u.free, u.best, f);
            memcpy(y, u.best + u.free->n_F, sizeof *y * (size_t)s->n_free);
        }
    }
    if (status == QC_OK)
        *result = (qc__unfolding){best.folded,   best.wrong,   best.where,
                                  before.folded, before.wrong, u.evaluations};
    release(&u);
    return status;
}
