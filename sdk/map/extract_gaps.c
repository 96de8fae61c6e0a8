/* Which boundary loops lie in one gap of the kept cells: sets of sectors between ports which no
 * cell fills, joined along isolines, through split vertices and with the loops they meet. */
#include "sdk/map/extract_internal.h"
#include "sdk/mesh/internal.h"

/* loop[e] of every boundary edge; start[i]: first vertex of a loop. */
static void number_loops(const qc_mesh *m, int32_t *loop, int32_t *start) {
    int32_t n = 0;
    for (int32_t e = 0; e < m->n_edges; e++) loop[e] = -1;
    for (int32_t first = 0; first < 3 * m->n_faces; first++) {
        if (m->twin[first] >= 0 || loop[m->halfedge_edge[first]] >= 0) continue;
        start[n] = qc_halfedge_start(m, first);
        int32_t h = first;
        do {
            loop[m->halfedge_edge[h]] = n;
            h = qc_prev(m->vertex_corner[qc_halfedge_end(m, h)]);
        } while (h != first);
        n++;
    }
}

/* The loop through a lattice vertex on the boundary. */
static int32_t loop_at(const qc__lattice *l, int32_t id, const int32_t *loop) {
    const qc_mesh *m = l->g->mesh;
    const int32_t home = l->home[id];
    return loop[id < l->n_at_vertices ? m->halfedge_edge[qc_prev(m->vertex_corner[home])] : home];
}

/* Set members: the sectors counter-clockwise of the ports, then the loops. */
static void join(const qc__ports *p, const qc__cells *c, const int32_t *loop, int32_t *set) {
    const qc__lattice *l = p->lattice;
    const qc_mesh *m = l->g->mesh;
    for (int32_t id = 0; id < l->n; id++) {
        int32_t gap = qc__lattice_on_boundary(l, id) ? p->n + loop_at(l, id, loop) : -1;
        for (int32_t i = p->first[id]; i < p->first[id + 1]; i++) {
            if (c->left[i] >= 0) continue;
            if (gap >= 0) qc__sets_unite(set, i, gap);
            gap = i;
            const int32_t next = qc__next_side(p, i);
            const int32_t exit = p->mate[i] < 0 ? qc__port_exit(p, i) : -1;
            if (next >= 0)
                qc__sets_unite(set, i, next);
            else if (exit >= 0)
                qc__sets_unite(set, i, p->n + loop[m->halfedge_edge[exit]]);
            else if (p->mate[i] >= 0)
                qc__sets_unite(set, i, p->n + loop_at(l, p->vertex[p->mate[i]], loop));
        }
    }
    for (int64_t i = 0; i < c->n_refused; i++)
        qc__sets_unite(set, c->refused[2 * i],
                       p->n + loop[m->halfedge_edge[c->refused[2 * i + 1]]]);
}

qc_status qc__cells_merged_loops(qc_ctx *ctx, const qc__ports *ports, const qc__cells *cells,
                                 int32_t vertex[2]) {
    const qc_mesh *m = ports->lattice->g->mesh;
    const int32_t n = m->n_boundary_loops;
    int32_t *loop = QC__NEW(ctx, int32_t, m->n_edges), *start = QC__NEW(ctx, int32_t, n);
    int32_t *set = QC__NEW(ctx, int32_t, (int64_t)ports->n + n);
    int32_t *owner = QC__NEW(ctx, int32_t, (int64_t)ports->n + n);
    const qc_status status = loop && start && set && owner ? QC_OK : QC_ERR_NOMEM;
    vertex[0] = vertex[1] = -1;
    if (status == QC_OK) {
        number_loops(m, loop, start);
        qc__sets_init(set, ports->n + n);
        join(ports, cells, loop, set);
        for (int32_t i = 0; i < ports->n + n; i++) owner[i] = -1;
        for (int32_t i = 0; i < n && vertex[0] < 0; i++) {
            int32_t *first = &owner[qc__sets_find(set, ports->n + i)];
            if (*first >= 0) {
                vertex[0] = start[*first];
                vertex[1] = start[i];
            }
            *first = i;
        }
    }
    qc__free(loop);
    qc__free(start);
    qc__free(set);
    qc__free(owner);
    return status;
}
