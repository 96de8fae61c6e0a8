/* Choice of the cells on meshes with boundary: the largest edge-connected set of each component,
 * compared with the component by its Euler characteristic. */
#include "sdk/map/extract_internal.h"
#include "sdk/mesh/internal.h"

static int32_t component_of(const qc__ports *p, const qc__cells *c, int32_t cell) {
    return p->lattice->g->mesh->face_component[p->face[c->port[4 * (int64_t)cell]]];
}

/* set[cell] = lowest cell of its edge-connected set. */
static void connect(const qc__ports *p, const qc__cells *c, int32_t *set) {
    qc__sets_init(set, c->n);
    for (int64_t i = 0; i < 4 * (int64_t)c->n; i++) {
        const int32_t other = c->left[p->mate[c->port[i]]];
        if (other >= 0) qc__sets_unite(set, (int32_t)(i / 4), other);
    }
}

/* best[component] = set with most cells, the first of equals; -1 = none. */
static void largest_sets(const qc__ports *p, const qc__cells *c, int32_t *set, int32_t *size,
                         int32_t *best) {
    for (int32_t i = 0; i < c->n; i++) size[qc__sets_find(set, i)]++;
    for (int32_t i = 0; i < p->lattice->g->mesh->n_components; i++) best[i] = -1;
    for (int32_t i = 0; i < c->n; i++) {
        int32_t *b = &best[component_of(p, c, i)];
        if (size[i] > 0 && (*b < 0 || size[i] > size[*b])) *b = i;
    }
}

/* Drops the cells of other sets; dropped: their number for each component. */
static void compact(const qc__ports *p, qc__cells *c, int32_t *set, const int32_t *best,
                    int32_t *dropped) {
    int32_t kept = 0;
    for (int32_t i = 0; i < c->n; i++) {
        const int32_t *side = c->port + 4 * (int64_t)i;
        const bool keep = qc__sets_find(set, i) == best[component_of(p, c, i)];
        dropped[component_of(p, c, i)] += !keep;
        for (int k = 0; k < 4; k++) {
            const int32_t port = side[k];
            c->left[port] = keep ? kept : -1;
            if (keep) c->port[4 * (int64_t)kept + k] = port;
        }
        kept += keep;
    }
    c->n = kept;
}

/* V - E + F of the kept cells less that of the mesh, for each component: 4 F = 2 E - (boundary
 * sides). The vertices are counted as qc__quad_vertices splits them. */
static void compare_euler(const qc__ports *p, const qc__cells *c, int32_t *vertex,
                          int32_t *excess) {
    const qc_mesh *m = p->lattice->g->mesh;
    const int32_t n_vertices = qc__quad_vertices(p, c, vertex);
    int32_t counted = 0; /* vertices are numbered in the order of the ports */
    for (int32_t i = 0; i < m->n_components; i++) excess[i] = 0;
    for (int32_t port = 0; port < p->n && counted < n_vertices; port++)
        if (vertex[port] == counted) {
            counted++;
            excess[m->face_component[p->face[port]]] += 2;
        }
    for (int32_t i = 0; i < c->n; i++)
        for (int k = 0; k < 4; k++) /* each side is half an edge, or a whole one on the boundary */
            excess[component_of(p, c, i)] -=
                c->left[p->mate[c->port[4 * (int64_t)i + k]]] >= 0 ? 1 : 2;
    for (int32_t i = 0; i < c->n; i++) excess[component_of(p, c, i)] += 2;
    for (int32_t v = 0; v < m->n_vertices; v++)
        excess[m->face_component[m->vertex_corner[v] / 3]] -= 2;
    for (int32_t e = 0; e < m->n_edges; e++)
        excess[m->face_component[m->edge_halfedge[2 * (int64_t)e] / 3]] += 2;
    for (int32_t t = 0; t < m->n_faces; t++) excess[m->face_component[t]] -= 2;
    for (int32_t i = 0; i < m->n_components; i++) excess[i] /= 2;
}

static int32_t first_face(const qc_mesh *m, int32_t component) {
    int32_t t = 0;
    while (m->face_component[t] != component) t++;
    return t;
}

/* A component without quads, or one which a narrow neck divides: more than a tenth would be lost.
 */
static qc_status check_sizes(qc_ctx *ctx, const qc_mesh *m, const int32_t *size,
                             const int32_t *best, const int32_t *dropped) {
    for (int32_t i = 0; i < m->n_components; i++) {
        if (best[i] < 0)
            return qc__fail(ctx, QC_ERR_FAILED, first_face(m, i),
                            "component %d (face %d ...) is smaller than a quad; try a finer "
                            "density",
                            (int)i, (int)first_face(m, i));
        if (dropped[i] > size[best[i]] / 9)
            return qc__fail(ctx, QC_ERR_FAILED, first_face(m, i),
                            "component %d (face %d ...) has a neck narrower than a quad: it would "
                            "cut off %d quads of %d; try a finer density",
                            (int)i, (int)first_face(m, i), (int)dropped[i],
                            (int)(dropped[i] + size[best[i]]));
        if (dropped[i] > 0)
            qc__log(ctx, QC_LOG_WARNING,
                    "component %d: %d quads cut off by the boundary are dropped", (int)i,
                    (int)dropped[i]);
    }
    return QC_OK;
}

static qc_status verify(qc_ctx *ctx, const qc__ports *p, const qc__cells *c, int32_t *vertex,
                        int32_t *excess) {
    const qc_mesh *m = p->lattice->g->mesh;
    compare_euler(p, c, vertex, excess);
    int32_t i = 0, merged[2];
    while (i < m->n_components && excess[i] == 0) i++;
    if (i == m->n_components) return QC_OK;
    const qc_status status = qc__cells_merged_loops(ctx, p, c, merged);
    if (status != QC_OK) return status;
    if (merged[0] >= 0)
        return qc__fail(ctx, QC_ERR_FAILED, merged[0],
                        "the boundary loops through vertices %d and %d come closer than a quad "
                        "and would merge; try a finer density",
                        (int)merged[0], (int)merged[1]);
    return qc__fail(ctx, QC_ERR_FAILED, first_face(m, i),
                    "the quads of component %d (face %d ...) differ from it by %d in the Euler "
                    "characteristic: a neck or handle is narrower than a quad; try a finer density",
                    (int)i, (int)first_face(m, i), (int)excess[i]);
}

qc_status qc__cells_keep(qc_ctx *ctx, const qc__ports *ports, qc__cells *cells) {
    const int32_t n_components = ports->lattice->g->mesh->n_components;
    int32_t *set = QC__NEW(ctx, int32_t, cells->n), *size = QC__ZERO(ctx, int32_t, cells->n);
    int32_t *best = QC__NEW(ctx, int32_t, n_components);
    int32_t *excess = QC__ZERO(ctx, int32_t, n_components); /* first the number of cells dropped */
    int32_t *vertex = QC__NEW(ctx, int32_t, ports->n);
    qc_status status = set && size && best && excess && vertex ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        connect(ports, cells, set);
        largest_sets(ports, cells, set, size, best);
        compact(ports, cells, set, best, excess);
        status = check_sizes(ctx, ports->lattice->g->mesh, size, best, excess);
    }
    if (status == QC_OK) status = verify(ctx, ports, cells, vertex, excess);
    qc__free(set);
    qc__free(size);
    qc__free(best);
    qc__free(excess);
    qc__free(vertex);
    return status;
}
