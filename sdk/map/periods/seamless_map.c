/* The Hodge step: from a matched cross field to a locally integrable field and its integral on the
 * cut surface (thesis 4.1; 2007 paper, section 4, eq. (9)). */
#include <math.h>
#include "sdk/map/periods/frame_form.h"
#include "sdk/map/periods/wrong_cones.h"
#include <qc/map.h>
#include <string.h>
#include "sdk/dec/internal.h"

static void seamless_map_destroy(qc_object *object) {
    qc_seamless_map *map = (qc_seamless_map *)object;
    qc_object_release(map->matching);
    qc_object_release(map->sizing);
    qc__free((void *)(uintptr_t)map->z);
    qc__free((void *)(uintptr_t)map->cut);
    qc__free((void *)(uintptr_t)map->face_turn);
    qc__free((void *)(uintptr_t)map->f);
    qc__free((void *)(uintptr_t)map->weight);
    qc__free(map);
}

/* Shortest cut graph with the cones as base vertices (thesis 4.2). */
static qc_status cut_at_cones(qc_ctx *ctx, const qc_matching *matching, const qc_cover *cover,
                              uint8_t *cut) {
    const qc_mesh *mesh = cover->mesh;
    uint8_t *base = QC__ZERO(ctx, uint8_t, mesh->n_vertices);
    int8_t *shift = QC__NEW(ctx, int8_t, mesh->n_vertices);
    qc_status status = base && shift ? qc_cover_shifts(ctx, cover, shift) : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            base[v] =
                !qc_vertex_on_boundary(mesh, v) && (shift[v] != 0 || matching->index4[v] != 0);
        status = qc_mesh_cut_graph(ctx, mesh, NULL, base, cut);
    }
    qc__free(base);
    qc__free(shift);
    return status;
}

/* What the rounds of stiffening share. */
typedef struct hodge {
    qc_ctx *ctx;
    const qc_mesh *mesh;
    const int32_t *index4; /* n_vertices */
    const qc_solver *solver;
    qc__curl_system system; /* L*, kept from round to round */
    qc_cover cover;
    double *cotangent;  /* 3 n_faces */
    double *compliance; /* 3 n_faces: cotangents over the weights */
    double *weight;     /* n_faces */
    qc_complex *frame;  /* 3 n_faces: the given field  */
    qc_complex *z, *f;  /* 3 n_faces */
    uint8_t *cut;       /* n_edges */
    int8_t *face_turn;  /* n_faces */
} hodge;

/* The closest integrable field in the weighted norm sum w |Z^ - Z|^2: the multiplier of curl* = 0
 * solves L* with cotangents over w. */
static qc_status project(hodge *q) {
    const int64_t n_corners = 3 * (int64_t)q->mesh->n_faces;
    for (int64_t c = 0; c < n_corners; c++) q->compliance[c] = q->cotangent[c] / q->weight[c / 3];
    qc_status status = qc__remove_curl(q->ctx, &q->cover, q->compliance, q->solver, &q->system,
                                       q->frame, q->z, NULL, NULL);
    double residual = 0;
    if (status == QC_OK)
        status = qc_form_integrate(q->ctx, &q->cover, q->cut, q->face_turn, q->z, q->f, &residual);
    if (status == QC_OK && !(residual <= 1e-6))
        status = qc__fail(q->ctx, QC_ERR_FAILED, -1,
                          "the field is not integrable (mismatch %g); the mesh may have faces of "
                          "almost no area",
                          residual);
    return status;
}

/* Energy of the difference of two forms. */
static double half_distance2(const hodge *q, const qc_complex *a, const qc_complex *b) {
    double sum = 0;
    for (int64_t c = 0; c < 3 * (int64_t)q->mesh->n_faces; c++) {
        const double re = a[c].re - b[c].re, im = a[c].im - b[c].im;
        sum += 0.25 * q->cotangent[c] * (re * re + im * im);
    }
    return sum;
}

/* Weights in proportion to the distance from the poles (N.5): towards a pole unit crosses are
 * farther and farther from integrable. Relative to the least one, so that none is below 1. */
static qc_status weigh(hodge *q) {
    const qc_mesh *mesh = q->mesh;
    for (int32_t t = 0; t < mesh->n_faces; t++) q->weight[t] = 1;
    if (mesh->n_poles == 0) return QC_OK;
    uint8_t *tip = QC__ZERO(q->ctx, uint8_t, mesh->n_vertices);
    double *r = QC__NEW(q->ctx, double, mesh->n_vertices), least = INFINITY;
    qc_status status = tip && r ? QC_OK : QC_ERR_NOMEM;
    for (int32_t i = 0; !status && i < mesh->pole_start[mesh->n_poles]; i++)
        tip[mesh->face_vertex[mesh->pole_corner[i]]] = 1;
    if (!status) status = qc_mesh_shortest_paths(q->ctx, mesh, NULL, tip, r, NULL);
    double far = 0;
    for (int32_t v = 0; !status && v < mesh->n_vertices; v++)
        if (isfinite(r[v])) far = fmax(far, r[v]);
    for (int32_t t = 0; !status && t < mesh->n_faces; t++) {
        const int32_t *v = mesh->face_vertex + 3 * (int64_t)t;
        const double mean = (r[v[0]] + r[v[1]] + r[v[2]]) / 3;
        q->weight[t] = fmin(fmax(mean / far, 1e-3), 1);
        least = fmin(least, q->weight[t]);
    }
    for (int32_t t = 0; !status && t < mesh->n_faces; t++) q->weight[t] /= least;
    qc__free(tip);
    qc__free(r);
    return status;
}

static qc_status solve(hodge *q, const qc_matching *matching, const qc_sizing *sizing,
                       int32_t rounds) {
    qc_status status =
        qc_mesh_geometry(q->ctx, q->mesh, NULL, NULL, q->cotangent, NULL, NULL, NULL);
    if (status == QC_OK) status = qc__frame_form(q->ctx, matching, sizing, q->frame);
    if (status == QC_OK) status = cut_at_cones(q->ctx, matching, &q->cover, q->cut);
    if (status == QC_OK)
        status = qc_cover_comb(q->ctx, &q->cover, q->cut, q->face_turn, NULL, NULL);
    if (status == QC_OK) status = weigh(q);
    for (int32_t i = 0; i <= rounds && status == QC_OK; i++) {
        if (i > 0) {
            if (qc__wrong_cones(q->mesh, q->index4, q->f) == 0) break;
            qc__stiffen(q->mesh, q->f, q->weight);
        }
        const qc__range outer =
            qc__range_begin(q->ctx, NULL, i / (rounds + 1.0), (i + 1) / (rounds + 1.0));
        status = project(q);
        qc__range_end(q->ctx, outer);
    }
    return status;
}

static qc_status allocate(hodge *q) {
    const int64_t n_corners = 3 * (int64_t)q->mesh->n_faces;
    q->cotangent = QC__NEW(q->ctx, double, n_corners);
    q->compliance = QC__NEW(q->ctx, double, n_corners);
    q->weight = QC__NEW(q->ctx, double, q->mesh->n_faces);
    q->frame = QC__NEW(q->ctx, qc_complex, n_corners);
    q->z = QC__NEW(q->ctx, qc_complex, n_corners);
    q->f = QC__NEW(q->ctx, qc_complex, n_corners);
    q->cut = QC__NEW(q->ctx, uint8_t, q->mesh->n_edges);
    q->face_turn = QC__NEW(q->ctx, int8_t, q->mesh->n_faces);
    return q->cotangent && q->compliance && q->weight && q->frame && q->z && q->f && q->cut &&
                   q->face_turn
               ? QC_OK
               : QC_ERR_NOMEM;
}

qc_status qc_seamless_map_create(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                                 const qc_hodge_options *options, qc_seamless_map **out) {
    const qc_mesh *mesh = matching->field->mesh;
    if (sizing->mesh != mesh)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "field and sizing belong to different meshes");
    qc_hodge_options o = QC_HODGE_OPTIONS_INIT;
    if (options)
        memcpy(&o, options, options->struct_size < sizeof o ? options->struct_size : sizeof o);
    hodge q = {.ctx = ctx,
               .mesh = mesh,
               .index4 = matching->index4,
               .cover = {mesh, matching->m},
               .solver = o.solver};
    qc_seamless_map *map = QC__ZERO(ctx, qc_seamless_map, 1);
    qc_status status = allocate(&q);
    if (!map) status = QC_ERR_NOMEM;
    if (status == QC_OK) status = solve(&q, matching, sizing, o.stiffening);
    if (status == QC_OK) {
        qc_object_init(&map->object, QC_TYPE_SEAMLESS_MAP, seamless_map_destroy);
        map->matching = qc_object_retain(matching);
        map->sizing = qc_object_retain(sizing);
        map->field_energy = 0.5 * qc_form_product(mesh, q.cotangent, q.frame, q.frame).re;
        map->curl_energy = half_distance2(&q, q.z, q.frame);
        map->z = q.z;
        map->cut = q.cut;
        map->face_turn = q.face_turn;
        map->f = q.f;
        bool stiff = false;
        for (int32_t t = 0; t < mesh->n_faces; t++) stiff |= q.weight[t] > 1;
        if (!stiff) qc__free(q.weight);
        map->weight = stiff ? q.weight : NULL;
        *out = map;
    } else {
        void *const blocks[] = {q.weight, q.z, q.f, q.cut, q.face_turn, map};
        for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    }
    qc__curl_system_free(&q.system);
    qc__free(q.cotangent);
    qc__free(q.compliance);
    qc__free(q.frame);
    return status;
}
