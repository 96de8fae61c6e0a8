/* Hills and hollows of a function, by the persistence of their extrema (Edelsbrunner, Letscher,
 * Zomorodian 2002): see hills.h. */
#include "hills.h"
#include "sdk/mesh/internal.h"

void qc__hills_free(qc__hills *h) {
    void *const blocks[] = {h->order, h->rank, h->key,  h->set,     h->oldest,
                            h->queue, h->hill, h->keep, h->extreme, h->hill_of};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
}

qc_status qc__hills_create(qc_ctx *ctx, const qc_mesh *mesh, double *g, double height,
                           qc__hills *out) {
    const int32_t n = mesh->n_vertices;
    *out = (qc__hills){.mesh = mesh,
                       .g = g,
                       .height = height,
                       .order = QC__NEW(ctx, int32_t, n),
                       .rank = QC__NEW(ctx, int32_t, n),
                       .key = QC__NEW(ctx, uint64_t, n),
                       .set = QC__NEW(ctx, int32_t, n),
                       .oldest = QC__NEW(ctx, int32_t, n),
                       .queue = QC__NEW(ctx, int32_t, n),
                       .hill = QC__NEW(ctx, qc__hill, n),
                       .keep = QC__ZERO(ctx, uint8_t, n),
                       .extreme = QC__NEW(ctx, uint8_t, n),
                       .hill_of = QC__NEW(ctx, int32_t, n)};
    return out->order && out->rank && out->key && out->set && out->oldest && out->queue &&
                   out->hill && out->keep && out->extreme && out->hill_of
               ? QC_OK
               : QC_ERR_NOMEM;
}

int32_t qc__next_neighbour(const qc_mesh *mesh, int32_t v, int32_t *c, int32_t *edge) {
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

qc_status qc__hills_sort(qc_ctx *ctx, qc__hills *s) {
    const int32_t n = s->mesh->n_vertices;
    double least = INFINITY;
    for (int32_t v = 0; v < n; v++) least = fmin(least, s->g[v]);
    for (int32_t v = 0; v < n; v++) {
        s->key[v] = qc__sort_key(s->g[v] - least);
        s->order[v] = v;
    }
    const qc_status status = qc__sort_keys(ctx, n, s->key, s->order);
    for (int32_t i = 0; status == QC_OK && i < n; i++) s->rank[s->order[i]] = i;
    return status;
}

/* v comes before w in the sweep. */
static bool before(const qc__hills *s, int32_t v, int32_t w) {
    return s->sign * (s->rank[v] - s->rank[w]) < 0;
}

/* Joins the components at v; the younger extremum ends here. */
static void join(qc__hills *s, int32_t v, int32_t w) {
    const int32_t a = qc__sets_find(s->set, v), b = qc__sets_find(s->set, w);
    if (a == b) return;
    const bool a_older = before(s, s->oldest[a], s->oldest[b]);
    const int32_t older = s->oldest[a_older ? a : b], younger = s->oldest[a_older ? b : a];
    const double height = fabs(s->g[v] - s->g[younger]);
    if (younger != v && height < s->height) {
        s->extreme[younger] = 0;
        if (height > 0) s->hill[s->n++] = (qc__hill){younger, v, 0};
    }
    qc__sets_unite(s->set, a, b);
    s->oldest[qc__sets_find(s->set, a)] = older;
}

void qc__hills_sweep(qc__hills *s) {
    const int32_t n = s->mesh->n_vertices;
    qc__sets_init(s->set, n);
    s->n = 0;
    for (int32_t i = 0; i < n; i++) {
        const int32_t v = s->order[s->sign > 0 ? i : n - 1 - i];
        int32_t c = -1, w, e;
        bool extremum = true;
        s->oldest[v] = v;
        while ((w = qc__next_neighbour(s->mesh, v, &c, &e)) >= 0) {
            if (!before(s, w, v)) continue;
            extremum = false;
            join(s, v, w);
        }
        s->extreme[v] = extremum;
    }
}

/* Frees the vertices of hill i and chooses its floor: as far from the saddle as the extremum, or
 * the level of the shore, the value nearest to the saddle around the hill. */
static void free_hill(qc__hills *s, int32_t i) {
    const int32_t saddle = s->hill[i].saddle;
    int32_t head = 0, tail = 0, shore = -1;
    s->queue[tail++] = s->hill[i].extremum;
    s->hill_of[s->hill[i].extremum] = i;
    while (head < tail) {
        const int32_t v = s->queue[head++];
        int32_t c = -1, w, e;
        while ((w = qc__next_neighbour(s->mesh, v, &c, &e)) >= 0) {
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
    s->hill[i].floor = !s->flat     ? 2 * level - s->g[s->hill[i].extremum]
                       : shore >= 0 ? s->g[shore]
                                    : level;
}

/* Wide hills first: those inside them are done then. */
int32_t qc__hills_release(qc__hills *s) {
    int32_t n = 0;
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) s->hill_of[v] = -1;
    for (int32_t i = s->n - 1; i >= 0; i--) {
        if (s->keep[s->hill[i].extremum]) continue;
        n++;
        if (s->hill_of[s->hill[i].extremum] < 0) free_hill(s, i);
    }
    return n;
}
