/* Cancelling pairs of branch points (Algorithm 6.1, steps 1 and 4): the index of one is carried to
 * the other along the shortest path of edges, one flip an edge (thesis 5.2.2). */
#include <stdlib.h>
#include <string.h>

#include "sdk/optimize/internal.h"

/* Vertices visited around a branch point and edges of a path, at most. */
enum { BALL = 3000, PATH_MAX_EDGES = 40 };
/* A pair which cost so many times its price is not measured again. */
static const double DEAR = 1.25;

typedef struct pair {
    int32_t p, q; /* the index of p is moved to q */
    int32_t n;
    int64_t start; /* flips start .. start + n - 1 */
    double change; /* of E_D */
    double price;  /* what the pair may cost */
} pair;

typedef struct search {
    qc_distortion *d;
    qc_cancel_options options;
    int32_t *parent; /* n_vertices: halfedge towards the start of the walk, -1 = not reached    */
    int32_t *depth;  /* n_vertices                                                              */
    int32_t *queue;  /* BALL                                                                    */
    pair *pair;
    int64_t n_pairs, pair_capacity;
    qc_flip_step *flip;
    int64_t n_flips, flip_capacity;
} search;

static int sign(int32_t i) {
    return (i > 0) - (i < 0);
}

static bool pair_is_known(const search *s, int32_t p, int32_t q) {
    for (int64_t i = 0; i < s->n_pairs; i++)
        if (s->pair[i].p == q && s->pair[i].q == p) return true;
    return false;
}

static double distance(const qc_mesh *mesh, int32_t p, int32_t q) {
    double d[3];
    qc__sub(mesh->position + 3 * (size_t)p, mesh->position + 3 * (size_t)q, d);
    return sqrt(qc__dot3(d, d));
}

static double price(const search *s, int32_t p, int32_t q) {
    const double far = s->options.increase, near = s->options.most;
    return near > far && distance(s->d->mesh, p, q) < s->options.spacing ? near : far;
}

/* One flip for each edge on the way back from q to p: index a leaves p and arrives at q. */
static bool add_pair(qc_ctx *ctx, search *s, int32_t p, int32_t q) {
    const qc_mesh *mesh = s->d->mesh;
    const int32_t n = s->depth[q], a = sign(s->d->index4[p]);
    if (!qc__reserve(ctx, (void **)&s->pair, &s->pair_capacity, s->n_pairs + 1, sizeof *s->pair) ||
        !qc__reserve(ctx, (void **)&s->flip, &s->flip_capacity, s->n_flips + n, sizeof *s->flip))
        return false;
    const pair new = {p, q, n, s->n_flips, s->options.increase, price(s, p, q)};
    for (int32_t v = q; v != p;) {
        const int32_t h = s->parent[v], e = mesh->halfedge_edge[h];
        const int32_t u = qc_halfedge_start(mesh, h); /* h runs from u to v */
        const bool forward = mesh->edge_vertex[2 * e] == u;
        const qc_flip_step flip = {e, forward ? -a : a};
        s->flip[s->n_flips++] = flip;
        v = u;
    }
    s->pair[s->n_pairs++] = new;
    return true;
}

/* Halfedge from u to v where c is the corner of u before v, seen from u counter-clockwise. */
static void visit(search *s, int32_t h, int32_t u, int32_t v, int32_t *n) {
    if (s->parent[v] >= 0 || s->depth[v] == 0 || *n == BALL) return;
    if (!qc_distortion_can_flip(s->d, s->d->mesh->halfedge_edge[h])) return;
    s->parent[v] = h;
    s->depth[v] = s->depth[u] + 1;
    s->queue[(*n)++] = v;
}

/* Breadth first from p to its nearest branch points of opposite sign; interior vertices only. */
static qc_status find_pairs(qc_ctx *ctx, search *s, int32_t p) {
    const qc_mesh *mesh = s->d->mesh;
    const int32_t *index4 = s->d->index4;
    int32_t n = 1, found = 0;
    qc_status status = QC_OK;
    s->queue[0] = p;
    s->depth[p] = 0;
    for (int32_t i = 0; !status && i < n && found < s->options.neighbours; i++) {
        const int32_t u = s->queue[i], first = mesh->vertex_corner[u];
        if (s->depth[u] > 0 && sign(index4[u]) * sign(index4[p]) < 0) {
            found++;
            if (!pair_is_known(s, p, u) && !add_pair(ctx, s, p, u)) status = QC_ERR_NOMEM;
        }
        if (s->depth[u] >= PATH_MAX_EDGES || qc_vertex_on_boundary(mesh, u)) continue;
        int32_t c = first;
        do { /* the edge from u to the next corner of the face */
            visit(s, qc_prev(c), u, mesh->face_vertex[qc_next(c)], &n);
            c = qc_corner_ccw(mesh, c);
        } while (c != first);
    }
    for (int32_t i = 0; i < n; i++) s->parent[s->queue[i]] = s->depth[s->queue[i]] = -1;
    return status;
}

static int by_points(const void *a, const void *b) {
    const qc__known_pair *x = a, *y = b;
    return x->p != y->p ? (x->p < y->p ? -1 : 1) : (x->q > y->q) - (x->q < y->q);
}

/* Other pairs change what a pair costs only little (thesis 6.4): one that was far too dear is not
 * measured again until the price has come near. */
static bool still_dear(const search *s, pair *a) {
    const qc__known_pair key = {a->p, a->q, 0};
    const qc__known_pair *known =
        s->d->n_known > 0 ? bsearch(&key, s->d->known, (size_t)s->d->n_known, sizeof key, by_points)
                          : NULL;
    if (!known || !(known->change > DEAR * a->price)) return false;
    a->change = known->change;
    return true;
}

static qc_status remember(qc_ctx *ctx, const search *s) {
    qc__known_pair *known = QC__NEW(ctx, qc__known_pair, s->n_pairs);
    if (!known) return QC_ERR_NOMEM;
    for (int64_t i = 0; i < s->n_pairs; i++)
        known[i] = (qc__known_pair){s->pair[i].p, s->pair[i].q, s->pair[i].change};
    qsort(known, (size_t)s->n_pairs, sizeof *known, by_points);
    qc__free(s->d->known);
    s->d->known = known;
    s->d->n_known = s->n_pairs;
    return QC_OK;
}

/* Out of time, only those which go at any price are left to be tried. */
static qc_status measure(qc_ctx *ctx, search *s) {
    for (int64_t i = 0; i < s->n_pairs && !qc__out_of_time(ctx); i++) {
        pair *a = &s->pair[i];
        double energy = 0;
        if (still_dear(s, a)) continue;
        const qc_status status =
            qc_distortion_change(ctx, s->d, a->n, s->flip + a->start, -1, &energy, NULL);
        if (status) return status;
        a->change = energy - s->d->energy;
        if (!qc__progress(ctx, 0.8 * (double)i / (double)s->n_pairs)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

static int by_loss(const void *a, const void *b) {
    const pair *x = a, *y = b;
    const double loss = x->change - x->price, other = y->change - y->price;
    if (loss != other) return loss < other ? -1 : 1;
    return x->p != y->p ? (x->p < y->p ? -1 : 1) : x->q - y->q;
}

static qc_status cancel(qc_ctx *ctx, search *s, int32_t *cancelled) {
    if (s->n_pairs == 0) return QC_OK;
    qsort(s->pair, (size_t)s->n_pairs, sizeof *s->pair, by_loss);
    const int64_t most = s->options.pairs > 0 ? s->options.pairs : s->n_pairs;
    for (int64_t i = 0; i < s->n_pairs && *cancelled < most; i++) {
        const pair *a = &s->pair[i];
        const int32_t *index4 = s->d->index4, sign_p = sign(index4[a->p]);
        if (a->price <= s->options.increase && qc__out_of_time(ctx)) continue;
        if (!(a->change < a->price) || sign_p * sign(index4[a->q]) >= 0) continue;
        bool accepted = false;
        const qc_status status = qc_distortion_change(ctx, s->d, a->n, s->flip + a->start,
                                                      s->d->energy + a->price, NULL, &accepted);
        if (status) return status;
        *cancelled += accepted;
        if (!qc__progress(ctx, 0.8 + 0.2 * (double)i / (double)s->n_pairs)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

static qc_status run(qc_ctx *ctx, search *s, int32_t *cancelled) {
    const qc_mesh *mesh = s->d->mesh;
    qc_status status = QC_OK;
    for (int32_t p = 0; p < mesh->n_vertices; p++) s->parent[p] = s->depth[p] = -1;
    for (int32_t p = 0; !status && p < mesh->n_vertices; p++)
        if (s->d->index4[p] != 0) status = find_pairs(ctx, s, p);
    if (!status) status = measure(ctx, s);
    if (!status && s->n_pairs > 0) status = remember(ctx, s);
    return status ? status : cancel(ctx, s, cancelled);
}

qc_status qc_distortion_cancel(qc_ctx *ctx, qc_distortion *d, const qc_cancel_options *options,
                               int32_t *cancelled) {
    search s = {.d = d, .options = QC_CANCEL_OPTIONS_INIT};
    int32_t count = 0;
    if (options)
        memcpy(&s.options, options,
               options->struct_size < sizeof s.options ? options->struct_size : sizeof s.options);
    s.parent = QC__NEW(ctx, int32_t, d->mesh->n_vertices);
    s.depth = QC__NEW(ctx, int32_t, d->mesh->n_vertices);
    s.queue = QC__NEW(ctx, int32_t, BALL);
    const qc_status status = s.parent && s.depth && s.queue ? run(ctx, &s, &count) : QC_ERR_NOMEM;
    qc__free(s.parent);
    qc__free(s.depth);
    qc__free(s.queue);
    qc__free(s.pair);
    qc__free(s.flip);
    if (cancelled) *cancelled = count;
    return status;
}
