/* Removes the maxima and minima of a function which are hardly higher or deeper than the saddle
 * next to them: persistence of Edelsbrunner, Letscher, Zomorodian 2002. Each hill below its
 * threshold is replaced by a function with the mean value property, which has no extremum inside
 * (docs/theory/poles.md). */
#include "internal.h"
#include "sdk/mesh/internal.h"

#include <string.h>

enum { ROUNDS = 12 };

/* A hill or hollow: its extremum, and the saddle where it meets a larger one. */
typedef struct hill {
    int32_t extremum, saddle;
    double floor; /* values around it, but for the saddle, count as no farther away than this */
} hill;

typedef struct simplifier {
    qc_ctx *ctx;
    const qc_mesh *mesh;
    double *g, height;
    double *weight;        /* n_edges, positive                                            */
    int32_t *order, *rank; /* n_vertices: by value, then by number; and the inverse        */
    uint64_t *key;         /* n_vertices                                                   */
    int32_t *set, *oldest; /* n_vertices: components of the sweep, extremum of each         */
    int32_t *queue;        /* n_vertices                                                   */
    hill *hills;           /* n_hills: lower than `height`, in the order of the sweep       */
    int32_t n_hills;
    uint8_t *keep;    /* n_vertices: extremum to be kept                                    */
    uint8_t *extreme; /* n_vertices: extremum of this sweep which is not low                */
    int32_t *hill_of; /* n_vertices: the hill whose values are replaced, -1                 */
    int sign;         /* 1: hollows, sweep from below; -1: hills                             */
    bool flat;        /* floors at the level of the shore                                   */
} simplifier;

/* The vertices next to v, one after the other: *c runs around v, from -1. */
static int32_t next_neighbour(const qc_mesh *mesh, int32_t v, int32_t *c, int32_t *edge) {
    const int32_t first = mesh->vertex_corner[v];
    int32_t h;
    if (*c == -2) return -1;
    if (*c < 0) {
        *c = first;
        h = qc_prev(first);
    } else {
        const int32_t next = qc_corner_ccw(mesh, *c);
        if (next == first) return -1;
        h = next >= 0 ? qc_prev(next) : qc_next(*c);
        *c = next >= 0 ? next : -2;
    }
    *edge = mesh->halfedge_edge[h];
    return qc_halfedge_start(mesh, h) == v ? qc_halfedge_end(mesh, h) : qc_halfedge_start(mesh, h);
}

static qc_status sort(simplifier *s) {
    const int32_t n = s->mesh->n_vertices;
    double least = INFINITY;
    for (int32_t v = 0; v < n; v++) least = fmin(least, s->g[v]);
    for (int32_t v = 0; v < n; v++) {
        s->key[v] = qc__sort_key(s->g[v] - least);
        s->order[v] = v;
    }
    const qc_status status = qc__sort_keys(s->ctx, n, s->key, s->order);
    for (int32_t i = 0; status == QC_OK && i < n; i++) s->rank[s->order[i]] = i;
    return status;
}

/* v comes before w in the sweep. */
static bool before(const simplifier *s, int32_t v, int32_t w) {
    return s->sign * (s->rank[v] - s->rank[w]) < 0;
}

/* Joins the components at v; the younger extremum ends here. */
static void join(simplifier *s, int32_t v, int32_t w) {
    const int32_t a = qc__sets_find(s->set, v), b = qc__sets_find(s->set, w);
    if (a == b) return;
    const bool a_older = before(s, s->oldest[a], s->oldest[b]);
    const int32_t older = s->oldest[a_older ? a : b], younger = s->oldest[a_older ? b : a];
    const double height = fabs(s->g[v] - s->g[younger]);
    if (younger != v && height < s->height) {
        s->extreme[younger] = 0;
        if (height > 0) s->hills[s->n_hills++] = (hill){younger, v, 0};
    }
    qc__sets_unite(s->set, a, b);
    s->oldest[qc__sets_find(s->set, a)] = older;
}

static void sweep(simplifier *s) {
    const int32_t n = s->mesh->n_vertices;
    qc__sets_init(s->set, n);
    s->n_hills = 0;
    for (int32_t i = 0; i < n; i++) {
        const int32_t v = s->order[s->sign > 0 ? i : n - 1 - i];
        int32_t c = -1, w, e;
        bool extremum = true;
        s->oldest[v] = v;
        while ((w = next_neighbour(s->mesh, v, &c, &e)) >= 0) {
            if (!before(s, w, v)) continue;
            extremum = false;
            join(s, v, w);
        }
        s->extreme[v] = extremum;
    }
}

/* Frees the vertices of hill i and chooses its floor: as far from the saddle as the extremum, or
 * the level of the shore, the value nearest to the saddle around the hill. */
static void free_hill(simplifier *s, int32_t i) {
    const int32_t saddle = s->hills[i].saddle;
    int32_t head = 0, tail = 0, shore = -1;
    s->queue[tail++] = s->hills[i].extremum;
    s->hill_of[s->hills[i].extremum] = i;
    while (head < tail) {
        const int32_t v = s->queue[head++];
        int32_t c = -1, w, e;
        while ((w = next_neighbour(s->mesh, v, &c, &e)) >= 0) {
            if (s->hill_of[w] >= 0 || w == saddle) continue;
            if (!before(s, w, saddle) || s->keep[w]) {
                if (shore < 0 || before(s, w, shore)) shore = w;
                continue;
            }
            s->hill_of[w] = i;
            s->queue[tail++] = w;
        }
    }
    const double level = s->g[saddle];
    s->hills[i].floor = !s->flat     ? 2 * level - s->g[s->hills[i].extremum]
                        : shore >= 0 ? s->g[shore]
                                     : level;
}

/* Frees all low hills, wide ones first: those inside them are done then. Returns how many there
 * were. */
static int32_t free_hills(simplifier *s) {
    int32_t n = 0;
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) s->hill_of[v] = -1;
    for (int32_t i = s->n_hills - 1; i >= 0; i--) {
        if (s->keep[s->hills[i].extremum]) continue;
        n++;
        if (s->hill_of[s->hills[i].extremum] < 0) free_hill(s, i);
    }
    return n;
}

/* --- the mean value property ------------------------------------------------------------------ */

typedef struct local_system {
    int32_t n, *local; /* n_vertices: number of the free ones, -1 */
    int64_t *colptr;
    int32_t *row;
    double *value, *x;
} local_system;

/* What vertex v of a hill sees at w outside of it. */
static double outside(const simplifier *s, int32_t v, int32_t w) {
    const hill *h = &s->hills[s->hill_of[v]];
    if (w == h->saddle) return s->g[w];
    return s->sign > 0 ? fmin(s->g[w], h->floor) : fmax(s->g[w], h->floor);
}

static int64_t add_column(const simplifier *s, local_system *a, int32_t v, int64_t begin) {
    int64_t end = begin;
    double diagonal = 0, right = 0;
    int32_t c = -1, w, e;
    while ((w = next_neighbour(s->mesh, v, &c, &e)) >= 0) {
        const int32_t j = a->local[w];
        diagonal += s->weight[e];
        if (j < 0) right += s->weight[e] * outside(s, v, w);
        if (j < 0 || j > a->local[v]) continue;
        int64_t at = end++;
        for (; at > begin && a->row[at - 1] > j; at--) {
            a->row[at] = a->row[at - 1];
            a->value[at] = a->value[at - 1];
        }
        a->row[at] = j;
        a->value[at] = -s->weight[e];
    }
    a->row[end] = a->local[v];
    a->value[end] = diagonal;
    a->x[a->local[v]] = right;
    return end + 1;
}

static qc_status solve(simplifier *s, local_system *a) {
    const qc_mesh *mesh = s->mesh;
    qc_symbolic *symbolic = NULL;
    qc_factor *factor = NULL;
    a->colptr = QC__NEW(s->ctx, int64_t, a->n + 1);
    a->row = QC__NEW(s->ctx, int32_t, a->n + mesh->n_edges);
    a->value = QC__NEW(s->ctx, double, a->n + mesh->n_edges);
    a->x = QC__NEW(s->ctx, double, a->n);
    if (!a->colptr || !a->row || !a->value || !a->x) return QC_ERR_NOMEM;
    int64_t k = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (a->local[v] < 0) continue;
        a->colptr[a->local[v]] = k;
        k = add_column(s, a, v, k);
    }
    a->colptr[a->n] = k;
    const qc_symmetric A = {a->n, a->colptr, a->row, a->value};
    qc_status status = qc_analyze_real(s->ctx, &A, NULL, &symbolic);
    if (!status) status = qc_factorize_real(s->ctx, symbolic, &A, &factor);
    if (!status) status = qc_solve_real(s->ctx, factor, 1, a->x);
    for (int32_t v = 0; !status && v < mesh->n_vertices; v++)
        if (a->local[v] >= 0) s->g[v] = a->x[a->local[v]];
    qc_symbolic_free(symbolic);
    qc_factor_free(factor);
    return status;
}

/* Each free value becomes a weighted mean of those around. */
static qc_status fill(simplifier *s) {
    local_system a = {.local = QC__NEW(s->ctx, int32_t, s->mesh->n_vertices)};
    qc_status status = a.local ? QC_OK : QC_ERR_NOMEM;
    for (int32_t v = 0; !status && v < s->mesh->n_vertices; v++)
        a.local[v] = s->hill_of[v] >= 0 ? a.n++ : -1;
    if (!status) status = solve(s, &a);
    void *const blocks[] = {a.local, a.colptr, a.row, a.value, a.x};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}

/* --- the whole -------------------------------------------------------------------------------- */

/* Cotangents, but positive, so that no value leaves the range of those around. */
static qc_status make_weights(simplifier *s) {
    const double least = 0.1;
    const qc_mesh *mesh = s->mesh;
    double *cotangent = QC__NEW(s->ctx, double, 3 * (int64_t)mesh->n_faces);
    qc_status status = cotangent ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_mesh_geometry(s->ctx, mesh, NULL, NULL, cotangent, NULL, NULL, NULL);
    for (int32_t e = 0; !status && e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[2 * e], g = mesh->edge_halfedge[2 * e + 1];
        s->weight[e] = fmax(0.5 * (cotangent[h] + (g >= 0 ? cotangent[g] : 0)), least);
    }
    qc__free(cotangent);
    return status;
}

static int32_t count_extrema(const simplifier *s) {
    int32_t n = 0;
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
        int32_t c = -1, w, e;
        bool low = false, high = false;
        while ((w = next_neighbour(s->mesh, v, &c, &e)) >= 0)
            if (s->rank[w] < s->rank[v])
                low = true;
            else
                high = true;
        n += !low || !high;
    }
    return n;
}

/* Hollows and hills in turn. First between true values on the shore, down to a floor which keeps
 * new extrema low: the fill is smooth, but on a ridge it may sink below the far shore. Then between
 * saddle and level shore, where no vertex becomes an extremum. */
static qc_status rounds(simplifier *s, int32_t *removed, int32_t *left) {
    qc_status status = make_weights(s);
    int32_t n[2] = {1, 1};
    for (int32_t i = 0; !status && i < ROUNDS && n[0] + n[1] > 0; i++) {
        if (!qc__progress(s->ctx, (double)i / ROUNDS)) return QC_ERR_CANCELLED;
        s->sign = i % 2 ? -1 : 1;
        s->flat = i >= 2;
        status = sort(s);
        if (status) break;
        if (i == 0) *removed = count_extrema(s);
        sweep(s);
        for (int32_t v = 0; i < 2 && v < s->mesh->n_vertices; v++) s->keep[v] |= s->extreme[v];
        n[i % 2] = free_hills(s);
        if (n[i % 2] > 0) status = fill(s);
    }
    if (!status) status = sort(s);
    if (!status) *removed -= count_extrema(s);
    *left = n[0] + n[1];
    return status;
}

static qc_status allocate(simplifier *s) {
    const size_t n = (size_t)s->mesh->n_vertices;
    s->weight = QC__NEW(s->ctx, double, s->mesh->n_edges);
    s->order = QC__NEW(s->ctx, int32_t, n);
    s->rank = QC__NEW(s->ctx, int32_t, n);
    s->key = QC__NEW(s->ctx, uint64_t, n);
    s->set = QC__NEW(s->ctx, int32_t, n);
    s->oldest = QC__NEW(s->ctx, int32_t, n);
    s->queue = QC__NEW(s->ctx, int32_t, n);
    s->hills = QC__NEW(s->ctx, hill, n);
    s->keep = QC__ZERO(s->ctx, uint8_t, n);
    s->extreme = QC__NEW(s->ctx, uint8_t, n);
    s->hill_of = QC__NEW(s->ctx, int32_t, n);
    return s->weight && s->order && s->rank && s->key && s->set && s->oldest && s->queue &&
                   s->hills && s->keep && s->extreme && s->hill_of
               ? QC_OK
               : QC_ERR_NOMEM;
}

qc_status qc_scalar_simplify(qc_ctx *ctx, const qc_mesh *mesh, double persistence, double *g,
                             int32_t *removed) {
    double least = INFINITY, most = -INFINITY;
    int32_t found = 0, left = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (!isfinite(g[v]))
            return qc__fail(ctx, QC_ERR_ARGUMENT, v, "the function is not finite at vertex %d",
                            (int)v);
        least = fmin(least, g[v]);
        most = fmax(most, g[v]);
    }
    if (!(persistence >= 0 && persistence < 1))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "persistence is %g, not in [0, 1)", persistence);
    simplifier s = {.ctx = ctx, .mesh = mesh, .height = persistence * (most - least)};
    qc_status status = QC_OK;
    if (s.height > 0) {
        s.g = QC__NEW(ctx, double, mesh->n_vertices);
        status = s.g ? allocate(&s) : QC_ERR_NOMEM;
        if (!status) memcpy(s.g, g, sizeof *g * (size_t)mesh->n_vertices);
        if (!status) status = rounds(&s, &found, &left);
        if (!status) memcpy(g, s.g, sizeof *g * (size_t)mesh->n_vertices);
        if (!status && left > 0)
            qc__log(ctx, QC_LOG_WARNING, "%d low extrema of the function stay", (int)left);
    }
    if (!status && removed) *removed = found;
    void *const blocks[] = {s.g,      s.weight, s.order, s.rank, s.key,     s.set,
                            s.oldest, s.queue,  s.hills, s.keep, s.extreme, s.hill_of};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
