/* The cells which become quads on meshes with boundary: the largest edge-connected set of each
 * component, compared with the component by Euler characteristic and boundary loops. Where they
 * differ more cells along the loops concerned are tried. */
#include "sdk/map/extract/internal.h"
#include "sdk/mesh/internal.h"
#include "sdk/mesh/names.h"

enum { ATTEMPTS = 6 }; /* cells covered by half, the same with bridges, then 0.4 down to 0.1 */

typedef struct component {
    int32_t best, size, dropped; /* largest set, its cells, those of the other sets */
    int32_t euler, loops;        /* of the quads less those of the mesh */
} component;

typedef struct keeper {
    qc_ctx *ctx;
    const qc__ports *ports;
    const qc_mesh *mesh;
    qc__cells *cells;
    qc__loops loops;
    component *component;
    int32_t *corner_set; /* 4 cells */
    int32_t *set, *size; /* cells */
    int32_t *gap;        /* loops */
    uint8_t *seen;       /* 4 cells: sides on a loop which is counted */
} keeper;

static component *component_of(const keeper *k, int32_t cell) {
    return &k->component[k->mesh->face_component[k->cells->face[cell]]];
}

/* set[cell] = lowest cell of its edge-connected set; the largest set of a component stays. */
static void keep_largest(keeper *k) {
    qc__cells *c = k->cells;
    qc__sets_init(k->set, c->n);
    for (int32_t i = 0; i < c->n; i++) k->size[i] = 0;
    for (int32_t i = 0; i < k->mesh->n_components; i++) k->component[i] = (component){.best = -1};
    for (int32_t a = 0; a < 4 * c->n; a++)
        if (c->keep[a / 4] && c->across[a] >= 0) qc__sets_unite(k->set, a / 4, c->across[a] / 4);
    for (int32_t i = 0; i < c->n; i++)
        if (c->keep[i]) k->size[qc__sets_find(k->set, i)]++;
    for (int32_t i = 0; i < c->n; i++) {
        component *b = component_of(k, i);
        if (k->size[i] > b->size) {
            b->best = i;
            b->size = k->size[i];
        }
    }
    for (int32_t i = 0; i < c->n; i++) {
        if (!c->keep[i] || qc__sets_find(k->set, i) == component_of(k, i)->best) continue;
        component_of(k, i)->dropped++;
        c->keep[i] = 0;
    }
}

/* --- topology --------------------------------------------------------------------------------- */

/* V - E + F, twice; a side is half an edge, or a whole one on the boundary. */
static void count_cells(keeper *k) {
    const qc__cells *c = k->cells;
    for (int32_t a = 0; a < 4 * c->n; a++) {
        k->seen[a] = 0;
        if (c->keep[a / 4]) k->seen[qc__sets_find(k->corner_set, a)] = 1;
    }
    for (int32_t a = 0; a < 4 * c->n; a++) {
        if (k->seen[a]) component_of(k, a / 4)->euler += 2;
        if (c->keep[a / 4]) component_of(k, a / 4)->euler -= c->across[a] >= 0 ? 1 : 2;
        if (c->keep[a / 4] && (a & 3) == 0) component_of(k, a / 4)->euler += 2;
    }
}

static void count_loops(keeper *k) {
    const qc__cells *c = k->cells;
    for (int32_t a = 0; a < 4 * c->n; a++) k->seen[a] = 0;
    for (int32_t a = 0; a < 4 * c->n; a++) {
        if (!c->keep[a / 4] || c->across[a] >= 0 || k->seen[a]) continue;
        component_of(k, a / 4)->loops++;
        for (int32_t b = a; !k->seen[b]; b = qc__next_boundary_side(c, b)) k->seen[b] = 1;
    }
}

static void subtract_mesh(keeper *k) {
    const qc_mesh *m = k->mesh;
    for (int32_t v = 0; v < m->n_vertices; v++)
        k->component[m->face_component[m->vertex_corner[v] / 3]].euler -= 2;
    for (int32_t e = 0; e < m->n_edges; e++)
        k->component[m->face_component[m->edge_halfedge[2 * (int64_t)e] / 3]].euler += 2;
    for (int32_t t = 0; t < m->n_faces; t++) k->component[m->face_component[t]].euler -= 2;
    for (int32_t i = 0; i < m->n_components; i++) k->component[i].euler /= 2;
    for (int32_t i = 0; i < k->loops.n; i++)
        k->component[m->face_component[m->vertex_corner[k->loops.start[i]] / 3]].loops--;
}

/* More than a tenth lost, or another topology. */
static bool differs(const component *c) {
    return c->best < 0 || c->dropped > c->size / 9 || c->euler != 0 || c->loops != 0;
}

/* --- repair ----------------------------------------------------------------------------------- */

static int32_t loop_component(const keeper *k, int32_t loop) {
    return k->mesh->face_component[k->mesh->vertex_corner[k->loops.start[loop]] / 3];
}

/* Loops of a component which share a gap (or all of them when none do) ask for more cells. */
static qc_status relax(keeper *k, int32_t attempt) {
    const qc_status status = qc__loops_gaps(k->ctx, k->ports, k->cells, &k->loops, k->gap);
    if (status != QC_OK) return status;
    for (int32_t i = 0; i < k->mesh->n_components; i++) k->size[i] = 0;
    for (int32_t i = 0; i < k->loops.n; i++) /* loops which share a gap */
        k->size[loop_component(k, i)] += k->gap[i] != i;
    uint8_t *shared = k->seen;
    for (int32_t i = 0; i < k->loops.n; i++) shared[i] = 0;
    for (int32_t i = 0; i < k->loops.n; i++)
        if (k->gap[i] != i) shared[i] = shared[k->gap[i]] = 1;
    for (int32_t i = 0; i < k->loops.n; i++) {
        const int32_t j = loop_component(k, i);
        if (!differs(&k->component[j]) || (k->size[j] > 0 && !shared[i])) continue;
        k->loops.bridge[i] = 1;
        k->loops.limit[i] = attempt == 0 ? 0.5 : 0.5 - 0.1 * attempt;
    }
    return QC_OK;
}

/* --- errors ----------------------------------------------------------------------------------- */

static int32_t first_face(const qc_mesh *m, int32_t i) {
    int32_t t = 0;
    while (m->face_component[t] != i) t++;
    return t;
}

static qc_status refuse(keeper *k, int32_t i) {
    const component *c = &k->component[i];
    char name[2][QC__ELEMENT_NAME];
    const int32_t face = first_face(k->mesh, i), number = qc__face_number(k->mesh, face);
    if (c->best < 0)
        return qc__fail(k->ctx, QC_ERR_FAILED, face,
                        "component %d (face %d ...) is smaller than a quad; try a finer density",
                        (int)i, (int)number);
    if (c->dropped > c->size / 9)
        return qc__fail(k->ctx, QC_ERR_FAILED, face,
                        "component %d (face %d ...) has a neck narrower than a quad: it would cut "
                        "off %d quads of %d; try a finer density",
                        (int)i, (int)number, (int)c->dropped, (int)(c->dropped + c->size));
    const qc_status status = qc__loops_gaps(k->ctx, k->ports, k->cells, &k->loops, k->gap);
    if (status != QC_OK) return status;
    for (int32_t j = 0; j < k->loops.n; j++)
        if (k->gap[j] != j && loop_component(k, j) == i)
            return qc__fail(k->ctx, QC_ERR_FAILED, k->loops.start[k->gap[j]],
                            "the boundary loops through %s and %s come closer than a quad "
                            "and would merge; try a finer density",
                            qc__vertex_name(k->mesh, k->loops.start[k->gap[j]], name[0]),
                            qc__vertex_name(k->mesh, k->loops.start[j], name[1]));
    return qc__fail(k->ctx, QC_ERR_FAILED, face,
                    "the quads of component %d (face %d ...) differ from it by %d in the Euler "
                    "characteristic and %d boundary loops: a neck or handle is narrower than a "
                    "quad; try a finer density",
                    (int)i, (int)number, (int)c->euler, (int)c->loops);
}

static qc_status verify(keeper *k) {
    for (int32_t i = 0; i < k->mesh->n_components; i++)
        if (differs(&k->component[i])) return refuse(k, i);
    for (int32_t i = 0; i < k->mesh->n_components; i++)
        if (k->component[i].dropped > 0)
            qc__log(k->ctx, QC_LOG_WARNING,
                    "component %d: %d quads cut off by the boundary are dropped", (int)i,
                    (int)k->component[i].dropped);
    return QC_OK;
}

static qc_status search(keeper *k) {
    for (int32_t attempt = 0; attempt < ATTEMPTS; attempt++) {
        if (!qc__progress(k->ctx, 0.85 + 0.03 * attempt / ATTEMPTS)) return QC_ERR_CANCELLED;
        qc_status status = qc__choose(k->ctx, k->cells, &k->loops, k->corner_set);
        if (status != QC_OK) return status;
        keep_largest(k);
        count_cells(k);
        count_loops(k);
        subtract_mesh(k);
        bool good = true;
        for (int32_t i = 0; i < k->mesh->n_components; i++) good &= !differs(&k->component[i]);
        if (good) break;
        if (attempt + 1 < ATTEMPTS) status = relax(k, attempt);
        if (status != QC_OK) return status;
    }
    return verify(k);
}

/* Which sides of the kept cells look at the hole of a pole. */
static qc_status mark_poles(keeper *k) {
    qc__cells *c = k->cells;
    if (k->mesh->n_poles == 0) return QC_OK;
    c->rim_pole = QC__NEW(k->ctx, int32_t, 4 * (int64_t)c->n);
    if (!c->rim_pole) return QC_ERR_NOMEM;
    for (int32_t a = 0; a < 4 * c->n; a++) c->rim_pole[a] = -1;
    for (int32_t i = 0; i < c->n - c->n_complete; i++)
        for (int32_t j = c->contact_first[i]; j < c->contact_first[i + 1]; j++) {
            const int32_t side = c->contact[2 * (int64_t)j + 1];
            if (c->keep[side / 4] && c->across[side] < 0) c->rim_pole[side] = k->loops.pole[i];
        }
    return QC_OK;
}

qc_status qc__cells_keep(qc_ctx *ctx, const qc__ports *ports, qc__cells *cells) {
    keeper k = {.ctx = ctx, .ports = ports, .mesh = ports->lattice->g->mesh, .cells = cells};
    const int64_t n_scratch = 4 * (int64_t)cells->n + k.mesh->n_components + k.mesh->n_edges;
    qc_status status = qc__loops_create(ctx, cells, &k.loops);
    if (status == QC_OK) {
        for (int32_t i = 0; i < k.loops.n; i++) k.loops.limit[i] = 0.5;
        k.component = QC__NEW(ctx, component, k.mesh->n_components);
        k.corner_set = QC__NEW(ctx, int32_t, 4 * (int64_t)cells->n);
        k.set = QC__NEW(ctx, int32_t, cells->n);
        k.size = QC__NEW(ctx, int32_t, (int64_t)cells->n + k.mesh->n_components);
        k.gap = QC__NEW(ctx, int32_t, k.loops.n);
        k.seen = QC__NEW(ctx, uint8_t, n_scratch);
        status = k.component && k.corner_set && k.set && k.size && k.gap && k.seen ? QC_OK
                                                                                   : QC_ERR_NOMEM;
    }
    if (status == QC_OK) status = search(&k);
    if (status == QC_OK) status = mark_poles(&k);
    qc__loops_free(&k.loops);
    qc__free(k.component);
    qc__free(k.corner_set);
    qc__free(k.set);
    qc__free(k.size);
    qc__free(k.gap);
    qc__free(k.seen);
    return status;
}
