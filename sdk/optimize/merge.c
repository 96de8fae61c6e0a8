/* Merging branch points along paths of changed matchings (2007 paper, 4.2). With C_b = 1 at branch
 * points and C_ij the angle between matched directions, that is |theta|, the cost is
 *     C = lambda sum C_b + sum C_ij.
 * Turning the matching by a quarter of a turn per edge along a path carries the index of its first
 * vertex to its last. Greedy: of all branch points the one whose best path lowers C most goes
 * first. A change at an edge which lowers C_ij counts as 0 in the search (Dijkstra 1959), so C
 * falls by no less than found. */
#include <stdlib.h>
#include <string.h>

#include "sdk/mesh/internal.h"
#include "sdk/optimize/internal.h"

/* Turns of an edge beyond any use; int8_t ends at 127. */
enum { TURNS_MAX = 100 };

typedef struct merger {
    const qc_mesh *mesh;
    double lambda;
    int8_t *m;
    double *theta;    /* n_edges, of m                                       */
    int32_t *index4;  /* n_vertices                                          */
    uint8_t *kept;    /* n_vertices: 1 on the boundary and on hard features, whose turns stay */
    double *distance; /* n_vertices: of the search, INFINITY = not reached   */
    int32_t *arrival; /* n_vertices: halfedge of the path into the vertex    */
    int32_t *reached; /* n_vertices: those of this search                    */
    double *gain;     /* n_vertices: - change of C, as last found            */
    qc__heap search, order;               /* by distance; of branch points by -gain              */
    int32_t n_reached, n_branch, n_start; /* n_start: branch points at the beginning             */
    int32_t n_left;                       /* merges which may still be made                      */
} merger;

/* theta at the edge of halfedge h after index a/4 was carried along h. */
static double turned(const merger *s, int32_t h, int32_t a) {
    const int32_t e = s->mesh->halfedge_edge[h];
    const bool forward = s->mesh->edge_vertex[2 * (size_t)e] == qc_halfedge_start(s->mesh, h);
    return s->theta[e] + (forward ? a : -a) * QC__PI / 2;
}

static void relax(merger *s, int32_t h, int32_t u, int32_t v, int32_t a) {
    const int32_t e = s->mesh->halfedge_edge[h];
    if (s->kept[v] || abs(s->m[e]) > TURNS_MAX) return;
    const double cost = fmax(fabs(turned(s, h, a)) - fabs(s->theta[e]), 0);
    const double d = s->distance[u] + cost;
    if (!(d < s->distance[v])) return;
    if (s->distance[v] == INFINITY) s->reached[s->n_reached++] = v;
    s->distance[v] = d;
    s->arrival[v] = h;
    qc__heap_push(&s->search, v);
}

static void relax_star(merger *s, int32_t u, int32_t a) {
    const int32_t first = s->mesh->vertex_corner[u];
    int32_t c = first;
    do { /* the edge from u to the next corner of the face */
        relax(s, qc_prev(c), u, s->mesh->face_vertex[qc_next(c)], a);
        c = qc_corner_ccw(s->mesh, c);
    } while (c != first);
}

/* How much C falls when all of p's index is carried to q, at the distance found. */
static double gain_at(const merger *s, int32_t p, int32_t q) {
    const int32_t b = s->index4[q], sum = b + s->index4[p];
    if (q == p || b == 0 || !qc__index_allowed(b, sum)) return 0;
    return s->lambda * (sum == 0 ? 2 : 1) - s->distance[q];
}

/* The best vertex for the index of p to go to, -1 = none; *gain > 0 then. */
static int32_t find_target(merger *s, int32_t p, double *gain) {
    int32_t best = -1;
    *gain = 0;
    for (int32_t i = 0; i < s->n_reached; i++) s->distance[s->reached[i]] = INFINITY;
    s->distance[p] = 0;
    s->reached[0] = p;
    s->n_reached = 1;
    qc__heap_push(&s->search, p);
    while (s->search.n > 0) {
        const int32_t u = qc__heap_pop(&s->search);
        if (!(2 * s->lambda - s->distance[u] > *gain)) continue; /* too far: empty the heap */
        const double g = gain_at(s, p, u);
        if (g > *gain) {
            *gain = g;
            best = u;
        }
        relax_star(s, u, s->index4[p]);
    }
    return best;
}

static void merge_into(merger *s, int32_t p, int32_t q) {
    const qc_mesh *mesh = s->mesh;
    const int32_t a = s->index4[p];
    for (int32_t v = q; v != p; v = qc_halfedge_start(mesh, s->arrival[v])) {
        const int32_t h = s->arrival[v], e = mesh->halfedge_edge[h];
        const double theta = turned(s, h, a);
        s->m[e] = (int8_t)(s->m[e] + (theta > s->theta[e] ? -abs(a) : abs(a)));
        s->theta[e] = theta;
    }
    s->index4[q] += a;
    s->index4[p] = 0;
    s->n_branch -= s->index4[q] == 0 ? 2 : 1;
    s->n_left--;
}

static void enqueue(merger *s, int32_t p, double gain) {
    s->gain[p] = -gain;
    qc__heap_push(&s->order, p);
}

/* Until the queue is empty: a branch point whose gain is not what it was goes back in line. */
static qc_status drain(qc_ctx *ctx, merger *s, bool *merged) {
    while (s->order.n > 0) {
        const int32_t p = qc__heap_pop(&s->order);
        double gain;
        if (s->index4[p] == 0) continue;
        const int32_t q = find_target(s, p, &gain);
        if (!qc__progress(ctx, 1 - (double)s->n_branch / (1.0 + s->n_start)))
            return QC_ERR_CANCELLED;
        if (q < 0) continue;
        if (gain < -s->gain[p]) {
            enqueue(s, p, gain);
            continue;
        }
        if (s->n_left == 0) continue;
        merge_into(s, p, q);
        *merged = true;
        if (s->index4[q] != 0 && s->order.place[q] < 0) enqueue(s, q, INFINITY);
    }
    return QC_OK;
}

static qc_status run(qc_ctx *ctx, merger *s) {
    qc_status status = QC_OK;
    for (bool merged = true; !status && merged && s->n_left > 0;) {
        merged = false;
        for (int32_t p = 0; p < s->mesh->n_vertices; p++)
            if (s->index4[p] != 0 && !s->kept[p]) enqueue(s, p, INFINITY);
        status = drain(ctx, s, &merged);
    }
    return status;
}

static double cost(const merger *s) {
    double sum = s->lambda * s->n_branch;
    for (int32_t e = 0; e < s->mesh->n_edges; e++) sum += fabs(s->theta[e]);
    return sum;
}

static void release(merger *s) {
    qc__free(s->m);
    qc__free(s->theta);
    qc__free(s->index4);
    qc__free(s->kept);
    qc__free(s->distance);
    qc__free(s->arrival);
    qc__free(s->reached);
    qc__free(s->gain);
    qc__heap_free(&s->search);
    qc__heap_free(&s->order);
}

static qc_status prepare(qc_ctx *ctx, const qc_matching *matching, merger *s) {
    const size_t V = (size_t)s->mesh->n_vertices, E = (size_t)s->mesh->n_edges;
    s->m = QC__NEW(ctx, int8_t, E);
    s->theta = QC__NEW(ctx, double, E);
    s->index4 = QC__NEW(ctx, int32_t, V);
    s->kept = QC__ZERO(ctx, uint8_t, V);
    s->distance = QC__NEW(ctx, double, V);
    s->arrival = QC__NEW(ctx, int32_t, V);
    s->reached = QC__NEW(ctx, int32_t, V);
    s->gain = QC__NEW(ctx, double, V);
    if (!s->m || !s->theta || !s->index4 || !s->kept || !s->distance || !s->arrival ||
        !s->reached || !s->gain)
        return QC_ERR_NOMEM;
    memcpy(s->m, matching->m, E * sizeof *s->m);
    memcpy(s->theta, matching->theta, E * sizeof *s->theta);
    memcpy(s->index4, matching->index4, V * sizeof *s->index4);
    qc__find_hard(matching->field, s->kept);
    for (size_t v = 0; v < V; v++) {
        s->distance[v] = INFINITY;
        if (qc_vertex_on_boundary(s->mesh, (int32_t)v)) s->kept[v] = 1;
    }
    const qc_status status = qc__heap_create(ctx, (int32_t)V, s->distance, &s->search);
    return status ? status : qc__heap_create(ctx, (int32_t)V, s->gain, &s->order);
}

qc_status qc_matching_merge(qc_ctx *ctx, const qc_matching *matching, double lambda, int32_t most,
                            double costs[2], qc_matching **out) {
    if (!(lambda >= 0) || !isfinite(lambda))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "lambda = %g is negative or not finite", lambda);
    merger s = {.mesh = matching->field->mesh,
                .lambda = lambda,
                .n_branch = matching->n_singular,
                .n_start = matching->n_singular,
                .n_left = most};
    double found[2] = {0, 0};
    qc_status status = prepare(ctx, matching, &s);
    if (!status) found[0] = cost(&s);
    if (!status) status = run(ctx, &s);
    if (!status) found[1] = cost(&s);
    if (!status) status = qc_matching_create(ctx, matching->field, s.m, out);
    if (!status && costs) memcpy(costs, found, sizeof found);
    release(&s);
    return status;
}
