/* The boundary loops of the surface, the open cells they meet, and which loops lie in one gap of
 * the kept cells: sets of dropped cells joined across sides, around lattice vertices and with the
 * loops which cut them. */
#include "sdk/map/extract/internal.h"
#include "sdk/mesh/internal.h"

/* of_edge of every boundary edge; start[i]: first vertex of a loop. */
static void number_loops(const qc_mesh *m, int32_t *of_edge, int32_t *start) {
    int32_t n = 0;
    for (int32_t e = 0; e < m->n_edges; e++) of_edge[e] = -1;
    for (int32_t first = 0; first < 3 * m->n_faces; first++) {
        if (m->twin[first] >= 0 || of_edge[m->halfedge_edge[first]] >= 0) continue;
        start[n] = qc_halfedge_start(m, first);
        int32_t h = first;
        do {
            of_edge[m->halfedge_edge[h]] = n;
            h = qc_prev(m->vertex_corner[qc_halfedge_end(m, h)]);
        } while (h != first);
        n++;
    }
}

/* The loops of each piece, in the order of its visits; met NULL = count only. */
static int64_t collect_met(const qc__cells *c, const qc__loops *l, int32_t *met, int64_t n,
                           int32_t piece) {
    const qc_grid_map *g = c->pieces.ports->lattice->g;
    const int64_t unit = (int64_t)1 << g->bits, begin = n;
    int32_t latest = -1;
    for (int64_t i = c->pieces.piece[piece].first; i < qc__piece_end(&c->pieces, piece); i++) {
        const qc__visit *v = &c->pieces.visit[i];
        for (int k = 0; k < 3; k++) {
            const int32_t h = 3 * v->face + k, loop = l->of_edge[g->mesh->halfedge_edge[h]];
            if (loop < 0 || loop == latest) continue;
            if (!qc__meets_square(qc__in_square(v, qc__grid_corner(g, qc_next(h))),
                                  qc__in_square(v, qc__grid_corner(g, qc_prev(h))),
                                  (qc__point){0, 0}, unit))
                continue;
            latest = loop;
            bool known = false;
            for (int64_t j = begin; met && j < n; j++) known |= met[j] == loop;
            if (known) continue;
            if (met) met[n] = loop;
            n++;
        }
    }
    return n;
}

/* pole[i] of each open cell. */
static qc_status find_poles(qc_ctx *ctx, const qc_mesh *m, int32_t n_open, qc__loops *l) {
    int32_t *of_loop = QC__NEW(ctx, int32_t, l->n);
    l->pole = QC__NEW(ctx, int32_t, n_open);
    const qc_status status = of_loop && l->pole ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t i = 0; i < l->n; i++) of_loop[i] = -1;
        for (int32_t i = 0; i < m->n_poles; i++)
            of_loop[l->of_edge[m->halfedge_edge[qc_next(m->pole_corner[m->pole_start[i]])]]] = i;
        for (int32_t i = 0; i < n_open; i++) {
            l->pole[i] = -1;
            for (int32_t j = l->first[i]; j < l->first[i + 1] && l->pole[i] < 0; j++)
                l->pole[i] = of_loop[l->met[j]];
        }
    }
    qc__free(of_loop);
    return status;
}

qc_status qc__loops_create(qc_ctx *ctx, const qc__cells *cells, qc__loops *out) {
    const qc_mesh *m = cells->pieces.ports->lattice->g->mesh;
    const int32_t n_open = cells->n - cells->n_complete;
    qc__loops l = {.n = m->n_boundary_loops};
    l.of_edge = QC__NEW(ctx, int32_t, m->n_edges);
    l.start = QC__NEW(ctx, int32_t, l.n);
    l.limit = QC__NEW(ctx, double, l.n);
    l.bridge = QC__ZERO(ctx, uint8_t, l.n);
    l.first = QC__NEW(ctx, int32_t, (int64_t)n_open + 1);
    qc_status status =
        l.of_edge && l.start && l.limit && l.bridge && l.first ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        number_loops(m, l.of_edge, l.start);
        int64_t n = 0;
        for (int32_t i = 0; i < n_open; i++) n = collect_met(cells, &l, NULL, n, i);
        l.met = QC__NEW(ctx, int32_t, n);
        if (!l.met) status = QC_ERR_NOMEM;
    }
    if (status == QC_OK) {
        int64_t n = 0;
        for (int32_t i = 0; i < n_open; i++) {
            l.first[i] = (int32_t)n;
            n = collect_met(cells, &l, l.met, n, i);
        }
        l.first[n_open] = (int32_t)n;
        status = find_poles(ctx, m, n_open, &l);
    }
    if (status == QC_OK)
        *out = l;
    else
        qc__loops_free(&l);
    return status;
}

void qc__loops_free(qc__loops *l) {
    qc__free(l->of_edge);
    qc__free(l->start);
    qc__free(l->first);
    qc__free(l->met);
    qc__free(l->limit);
    qc__free(l->bridge);
    qc__free(l->pole);
    *l = (qc__loops){0};
}

/* The loop through a lattice vertex on the boundary. */
static int32_t loop_at(const qc__lattice *l, int32_t id, const int32_t *of_edge) {
    const qc_mesh *m = l->g->mesh;
    const int32_t home = l->home[id];
    return of_edge[id < l->n_at_vertices ? m->halfedge_edge[qc_prev(m->vertex_corner[home])]
                                         : home];
}

/* Set members: the loops, then the open cells. owner: a member at each lattice vertex. */
static void join(const qc__lattice *lattice, const qc__cells *c, const qc__loops *l, int32_t *set,
                 int32_t *owner) {
    for (int32_t id = 0; id < lattice->n; id++)
        owner[id] = qc__lattice_on_boundary(lattice, id) ? loop_at(lattice, id, l->of_edge) : -1;
    for (int32_t i = 0; i < c->n - c->n_complete; i++) {
        const int32_t cell = c->n_complete + i, member = l->n + i;
        if (c->keep[cell]) continue;
        for (int32_t j = l->first[i]; j < l->first[i + 1]; j++)
            qc__sets_unite(set, member, l->met[j]);
        for (int32_t j = c->contact_first[i]; j < c->contact_first[i + 1]; j++) {
            const int32_t other = c->contact[2 * (int64_t)j + 1] / 4;
            if (!c->keep[other]) qc__sets_unite(set, member, l->n + other - c->n_complete);
        }
        for (int k = 0; k < 4; k++) {
            const int32_t id = c->corner[4 * (int64_t)cell + k];
            if (id < 0) continue;
            if (owner[id] >= 0)
                qc__sets_unite(set, member, owner[id]);
            else
                owner[id] = member;
        }
    }
}

qc_status qc__loops_gaps(qc_ctx *ctx, const qc__ports *ports, const qc__cells *cells,
                         const qc__loops *loops, int32_t *gap) {
    const int32_t n = loops->n + cells->n - cells->n_complete;
    int32_t *set = QC__NEW(ctx, int32_t, n), *owner = QC__NEW(ctx, int32_t, ports->lattice->n);
    int32_t *lowest = QC__NEW(ctx, int32_t, n);
    const qc_status status = set && owner && lowest ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        qc__sets_init(set, n);
        join(ports->lattice, cells, loops, set, owner);
        for (int32_t i = 0; i < n; i++) lowest[i] = -1;
        for (int32_t i = 0; i < loops->n; i++) {
            int32_t *first = &lowest[qc__sets_find(set, i)];
            if (*first < 0) *first = i;
            gap[i] = *first;
        }
    }
    qc__free(set);
    qc__free(owner);
    qc__free(lowest);
    return status;
}
