/* Strokes: polylines near the surface become paths of edges. Each is the shortest path for the
 * weight |e| (1 + (d / |e|)^2), d the distance of the middle of the edge from the segment: beyond
 * about one edge from it every step is dear, so that few vertices are visited. */
#include "sdk/mesh/internal.h"

static double distance2(const double *a, const double *b) {
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

/* --- nearest vertices: sorted by their first coordinate --------------------------------------- */

typedef struct sweep {
    const qc_mesh *mesh;
    int32_t *vertex; /* n_vertices, ascending */
    uint64_t *key;
} sweep;

static qc_status sweep_create(qc_ctx *ctx, const qc_mesh *mesh, sweep *out) {
    sweep s = {mesh, QC__NEW(ctx, int32_t, mesh->n_vertices),
               QC__NEW(ctx, uint64_t, mesh->n_vertices)};
    qc_status status = s.vertex && s.key ? QC_OK : QC_ERR_NOMEM;
    double least = INFINITY;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        least = fmin(least, mesh->position[3 * (size_t)v]);
    for (int32_t v = 0; status == QC_OK && v < mesh->n_vertices; v++) {
        s.vertex[v] = v;
        s.key[v] = qc__sort_key(mesh->position[3 * (size_t)v] - least);
    }
    if (status == QC_OK) status = qc__sort_keys(ctx, mesh->n_vertices, s.key, s.vertex);
    *out = s;
    return status;
}

static double first_coordinate(const sweep *s, int32_t i) {
    return s->mesh->position[3 * (size_t)s->vertex[i]];
}

/* Number of vertices before x. */
static int32_t rank(const sweep *s, double x) {
    int32_t lo = 0, hi = s->mesh->n_vertices;
    while (lo < hi) {
        const int32_t middle = lo + (hi - lo) / 2;
        if (first_coordinate(s, middle) < x)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

static bool is_nearer(const sweep *s, const double *p, int32_t i, double *best, int32_t *found) {
    const int32_t v = s->vertex[i];
    const double dx = first_coordinate(s, i) - p[0];
    if (dx * dx > *best) return false;
    const double d = distance2(s->mesh->position + 3 * (size_t)v, p);
    if (d < *best || (!(d > *best) && (*found < 0 || v < *found))) {
        *best = d;
        *found = v;
    }
    return true;
}

/* -1 = none within reach; the lowest number of equally near ones. */
static int32_t nearest(const sweep *s, const double *p, double reach) {
    const int32_t start = rank(s, p[0]);
    double best = reach * reach;
    int32_t found = -1;
    for (int32_t i = start; i < s->mesh->n_vertices; i++)
        if (!is_nearer(s, p, i, &best, &found)) break;
    for (int32_t i = start; i-- > 0;)
        if (!is_nearer(s, p, i, &best, &found)) break;
    return found;
}

/* --- paths ------------------------------------------------------------------------------------ */

typedef struct search {
    const qc_mesh *mesh;
    const double *p, *q; /* the segment */
    double *distance;    /* n_vertices, infinite between searches */
    int32_t *parent;     /* edge */
    int32_t *seen, n_seen;
    qc__heap heap;
} search;

static qc_status search_create(qc_ctx *ctx, const qc_mesh *mesh, search *s) {
    *s = (search){.mesh = mesh};
    s->distance = QC__NEW(ctx, double, mesh->n_vertices);
    s->parent = QC__NEW(ctx, int32_t, mesh->n_vertices);
    s->seen = QC__NEW(ctx, int32_t, mesh->n_vertices);
    if (!s->distance || !s->parent || !s->seen) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < mesh->n_vertices; v++) s->distance[v] = INFINITY;
    return qc__heap_create(ctx, mesh->n_vertices, s->distance, &s->heap);
}

static void search_free(search *s) {
    qc__free(s->distance);
    qc__free(s->parent);
    qc__free(s->seen);
    qc__heap_free(&s->heap);
}

/* Squared distance of x from the segment. */
static double off_segment2(const search *s, const double *x) {
    const double whole = distance2(s->p, s->q);
    double along = 0, foot[3];
    for (int i = 0; i < 3; i++) along += (x[i] - s->p[i]) * (s->q[i] - s->p[i]);
    along = whole > 0 ? fmin(fmax(along / whole, 0), 1) : 0;
    for (int i = 0; i < 3; i++) foot[i] = s->p[i] + along * (s->q[i] - s->p[i]);
    return distance2(x, foot);
}

static double weight(const search *s, int32_t e) {
    const double *a = s->mesh->position + 3 * (size_t)s->mesh->edge_vertex[2 * e];
    const double *b = s->mesh->position + 3 * (size_t)s->mesh->edge_vertex[2 * e + 1];
    const double length = sqrt(distance2(a, b));
    double middle[3];
    for (int i = 0; i < 3; i++) middle[i] = a[i] / 2 + b[i] / 2;
    return length > 0 ? length + off_segment2(s, middle) / length : 0;
}

static void reach_vertex(search *s, int32_t v, double distance, int32_t edge) {
    if (!(distance < s->distance[v])) return;
    if (isinf(s->distance[v])) s->seen[s->n_seen++] = v;
    s->distance[v] = distance;
    s->parent[v] = edge;
    qc__heap_push(&s->heap, v);
}

static void relax(search *s, int32_t v, int32_t e) {
    const int32_t *ends = s->mesh->edge_vertex + 2 * (size_t)e;
    reach_vertex(s, ends[0] == v ? ends[1] : ends[0], s->distance[v] + weight(s, e), e);
}

static void relax_star(search *s, int32_t v) {
    const qc_mesh *m = s->mesh;
    const int32_t first = m->vertex_corner[v];
    int32_t c = first;
    if (m->twin[qc_prev(c)] < 0) relax(s, v, m->halfedge_edge[qc_prev(c)]);
    do {
        relax(s, v, m->halfedge_edge[qc_next(c)]);
        c = qc_corner_ccw(m, c);
    } while (c >= 0 && c != first);
}

/* Marks the edges of the path from a to b; false when there is none. */
static bool mark_path(search *s, int32_t a, int32_t b, uint8_t *edge) {
    bool found = false;
    reach_vertex(s, a, 0, -1);
    while (s->heap.n > 0 && !found) {
        const int32_t v = qc__heap_pop(&s->heap);
        found = v == b;
        if (!found) relax_star(s, v);
    }
    for (int32_t v = b; found && v != a;) {
        const int32_t *ends = s->mesh->edge_vertex + 2 * (size_t)s->parent[v];
        edge[s->parent[v]] |= QC_FEATURE_LINE;
        v = ends[0] == v ? ends[1] : ends[0];
    }
    while (s->heap.n > 0) qc__heap_pop(&s->heap);
    while (s->n_seen > 0) s->distance[s->seen[--s->n_seen]] = INFINITY;
    return found;
}

static qc_status mark_strokes(qc_ctx *ctx, const sweep *near, search *s, int32_t n_points,
                              const double *point, int32_t n_segments, const int32_t *segment,
                              double reach, uint8_t *edge) {
    int32_t ignored = 0;
    for (int32_t i = 0; i < n_segments; i++) {
        int32_t end[2] = {-1, -1};
        for (int k = 0; k < 2; k++) {
            const int32_t p = segment[2 * (size_t)i + (size_t)k];
            if (p >= 0 && p < n_points) end[k] = nearest(near, point + 3 * (size_t)p, reach);
        }
        if (end[0] >= 0 && end[1] >= 0) {
            s->p = point + 3 * (size_t)segment[2 * (size_t)i];
            s->q = point + 3 * (size_t)segment[2 * (size_t)i + 1];
            ignored += !mark_path(s, end[0], end[1], edge);
        } else {
            ignored++;
        }
        if (i % 64 == 63 && !qc__progress(ctx, (i + 1.0) / n_segments)) return QC_ERR_CANCELLED;
    }
    if (ignored > 0)
        qc__log(ctx, QC_LOG_INFO, "%d of %d segments of strokes are not on this mesh: ignored",
                (int)ignored, (int)n_segments);
    return QC_OK;
}

qc_status qc_features_add_strokes(qc_ctx *ctx, const qc_mesh *mesh, int32_t n_points,
                                  const double *point, int32_t n_segments, const int32_t *segment,
                                  double reach, uint8_t *edge) {
    if (n_segments == 0) return QC_OK;
    sweep near = {mesh, NULL, NULL};
    search s = {.mesh = mesh};
    uint8_t *marked = QC__ZERO(ctx, uint8_t, mesh->n_edges);
    qc_status status = marked ? sweep_create(ctx, mesh, &near) : QC_ERR_NOMEM;
    if (status == QC_OK) status = search_create(ctx, mesh, &s);
    if (status == QC_OK)
        status = mark_strokes(ctx, &near, &s, n_points, point, n_segments, segment, reach, marked);
    for (int32_t e = 0; status == QC_OK && e < mesh->n_edges; e++) edge[e] |= marked[e];
    search_free(&s);
    qc__free(near.vertex);
    qc__free(near.key);
    qc__free(marked);
    return status;
}
