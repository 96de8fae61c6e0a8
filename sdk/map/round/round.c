/* Global continuity: rounds the periods of a seamless map and adds the harmonic map which closes
 * the gap (thesis 4.2.1, 4.2.2, 6.3). */
#include "sdk/map/round/round.h"
#include <string.h>

#include "sdk/map/round/room.h"
#include "sdk/mesh/names.h"

enum { LARGEST_PERIOD_MATRIX = 4000 }; /* variables; beyond it periods are rounded directly */

static qc_status prepare(qc__rounding *r) {
    const qc_seamless_map *seamless = r->seamless;
    const qc_cover cover = {r->mesh, seamless->matching->m};
    const int64_t n_corners = 3 * (int64_t)r->mesh->n_faces;
    r->cotangent = QC__NEW(r->ctx, double, n_corners);
    r->f = QC__NEW(r->ctx, qc_complex, n_corners);
    r->trial = QC__NEW(r->ctx, qc_complex, n_corners);
    r->best = QC__NEW(r->ctx, qc_complex, n_corners);
    if (!r->cotangent || !r->f || !r->trial || !r->best) return QC_ERR_NOMEM;
    memcpy(r->f, seamless->f, sizeof *r->f * (size_t)n_corners);
    qc_status status =
        qc_mesh_geometry(r->ctx, r->mesh, NULL, NULL, r->cotangent, NULL, NULL, NULL);
    if (status == QC_OK && seamless->weight)
        for (int64_t c = 0; c < n_corners; c++) r->cotangent[c] *= seamless->weight[c / 3];
    if (status == QC_OK)
        status = qc__seams_create(r->ctx, &cover, seamless->cut, seamless->face_turn,
                                  seamless->matching->index4, seamless->matching->axis, &r->seams);
    if (status == QC_OK) status = qc__seams_solve(r->ctx, r->seams, r->options.lattice);
    if (status != QC_OK) return status;
    const int64_t n = r->seams->n_free;
    r->period = QC__NEW(r->ctx, double, n);
    r->gap = QC__NEW(r->ctx, double, n);
    r->target = QC__NEW(r->ctx, double, n);
    r->rounded = QC__NEW(r->ctx, double, n);
    r->best_rounded = QC__NEW(r->ctx, double, n);
    r->symbol = QC__NEW(r->ctx, double, qc__seams_symbols(r->seams));
    r->wedge = QC__NEW(r->ctx, double _Complex, r->seams->n_wedges);
    r->F = QC__NEW(r->ctx, double _Complex, r->mesh->n_vertices);
    r->correction = QC__NEW(r->ctx, double _Complex, r->mesh->n_vertices);
    if (!r->period || !r->gap || !r->target || !r->rounded || !r->best_rounded || !r->symbol ||
        !r->wedge || !r->F || !r->correction)
        return QC_ERR_NOMEM;
    status = qc__seams_read(r->ctx, r->seams, r->f, r->period);
    if (status == QC_OK && (n > 0 || r->seams->n_levels > 0))
        status = qc__periods_create(r->ctx, r->seams, r->cotangent, r->options.solver, &r->periods);
    return status;
}

static qc_status make_period_matrix(qc__rounding *r) {
    const int64_t n = r->seams->n_free;
    if (n == 0) return QC_OK;
    if (n > LARGEST_PERIOD_MATRIX) {
        if (!r->options.trial)
            qc__log(r->ctx, QC_LOG_WARNING,
                    "%lld periods are too many for a period matrix; they are rounded directly",
                    (long long)n);
        return QC_OK;
    }
    r->P = QC__NEW(r->ctx, double, n *n);
    if (!r->P) return QC_ERR_NOMEM;
    const qc__range outer = qc__range_begin(r->ctx, NULL, 0.2, 0.7);
    const qc_status status = qc__period_matrix(r->ctx, r->periods, r->P);
    qc__range_end(r->ctx, outer);
    return status;
}

/* No quadrangulation of the torus has exactly two irregular vertices of valence 3 and 5: the
 * holonomy of such a flat metric would be trivial (Izmestiev, Kusner, Rote, Springborn, Sullivan
 * 2013). */
static qc_status refuse_impossible(const qc__rounding *r) {
    const qc_mesh *mesh = r->mesh;
    const qc_matching *matching = r->seamless->matching;
    if (mesh->n_components != 1 || mesh->n_boundary_edges > 0 || mesh->genus != 1 ||
        matching->n_singular != 2)
        return QC_OK;
    int32_t cone[2] = {-1, -1};
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (matching->index4[v] == 1 || matching->index4[v] == -1)
            cone[matching->index4[v] < 0] = v;
    if (cone[0] < 0 || cone[1] < 0) return QC_OK;
    char name[2][QC__ELEMENT_NAME];
    return qc__fail(r->ctx, QC_ERR_FAILED, cone[0],
                    "no quad mesh of a torus has exactly one vertex of valence 3 (here %s) and one "
                    "of valence 5 (here %s); smooth the field or give it more singularities",
                    qc__vertex_name(mesh, cone[0], name[0]),
                    qc__vertex_name(mesh, cone[1], name[1]));
}

/* At an inner vertex of index 3/4 one quad meets, two of whose sides are one edge. Next to a vertex
 * of negative index a fold may still hide it; but with hard features fewer of them help. */
static qc_status refuse_glued_quads(const qc__rounding *r) {
    const qc_matching *matching = r->seamless->matching;
    if (r->options.lattice != QC_LATTICE_QUADS || r->options.trial || !matching->axis) return QC_OK;
    for (int32_t v = 0; v < r->mesh->n_vertices; v++)
        if (matching->index4[v] == 3 && !qc_vertex_on_boundary(r->mesh, v)) {
            char name[QC__ELEMENT_NAME];
            return qc__fail(
                r->ctx, QC_ERR_FAILED, v,
                "%s has index 3/4, where a quad would be glued to itself; drop features near it",
                qc__vertex_name(r->mesh, v, name));
        }
    return QC_OK;
}

static void release(qc__rounding *r) {
    qc__imprint_free(&r->imprint);
    qc__separation_free(r->separation);
    qc__periods_free(r->periods);
    qc__seams_free(r->seams);
    void *const blocks[] = {r->cotangent, r->f,      r->trial,  r->best,    r->P,
                            r->period,    r->gap,    r->target, r->rounded, r->best_rounded,
                            r->z,         r->symbol, r->wedge,  r->F,       r->correction};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
}

/* All that comes before integers are chosen. */
static qc_status find_real_map(qc__rounding *r) {
    qc_status status = refuse_impossible(r);
    if (status == QC_OK) status = prepare(r);
    if (status == QC_OK) status = make_period_matrix(r);
    return status == QC_OK ? qc__round_align(r) : status;
}

qc_status qc__map_has_room(qc_ctx *ctx, const qc_seamless_map *seamless) {
    qc__rounding r = {.ctx = ctx, .seamless = seamless, .mesh = seamless->matching->field->mesh};
    r.options = (qc_round_options)QC_ROUND_OPTIONS_INIT;
    const qc_status status = find_real_map(&r);
    release(&r);
    return status;
}

qc_status qc_map_round(qc_ctx *ctx, const qc_seamless_map *seamless,
                       const qc_round_options *options, qc_corner_map **out) {
    qc__rounding r = {.ctx = ctx, .seamless = seamless, .mesh = seamless->matching->field->mesh};
    r.options = (qc_round_options)QC_ROUND_OPTIONS_INIT;
    if (options)
        memcpy(&r.options, options,
               options->struct_size < sizeof r.options ? options->struct_size : sizeof r.options);
    if (!(r.options.tolerance > 0)) r.options.tolerance = 0.02;
    if (!(r.options.refine > 0)) r.options.refine = 1;
    qc_status status = refuse_glued_quads(&r);
    if (status == QC_OK) status = find_real_map(&r);
    if (status == QC_OK) status = qc__round_meet(&r);
    if (status == QC_OK) status = qc__round_publish(&r, out);
    release(&r);
    return status;
}
