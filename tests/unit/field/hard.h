/* Fields with hard features for the tests: surfaces with creases and boundaries, the steps from the
 * mesh to the matching, and what holds after each of them. */
#ifndef QC_TEST_FIELD_HARD_H
#define QC_TEST_FIELD_HARD_H

#include "surfaces.h"

#include <qc/shape.h>

#include "sdk/field/sector.h"

static inline qc_mesh *shape(qc_ctx *ctx, const char *name, int32_t resolution, double scale) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    options.resolution = resolution;
    qc_mesh *mesh = NULL, *scaled = NULL;
    assert_int_equal(qc_shape_create(ctx, name, &options, &mesh), QC_OK);
    double *p = malloc(sizeof *p * 3 * (size_t)mesh->n_vertices);
    for (int32_t i = 0; i < 3 * mesh->n_vertices; i += 3) {
        const double *q = mesh->position + i; /* sheared: symmetric surfaces have ties */
        p[i] = scale * (q[0] + 0.13 * q[1]);
        p[i + 1] = scale * (1.07 * q[1] - 0.05 * q[2]);
        p[i + 2] = scale * (q[2] + 0.08 * q[0]);
    }
    assert_int_equal(
        qc_mesh_create(ctx, mesh->n_vertices, p, mesh->n_faces, mesh->face_vertex, &scaled), QC_OK);
    free(p);
    qc_object_release(mesh);
    return scaled;
}

/* Creases above 35 degrees and boundaries without noise shorter than `least`, on a mesh with room
 * for them; takes the mesh. */
static inline qc_features *pruned_features(qc_ctx *ctx, qc_mesh *mesh, double least) {
    qc_features *found = NULL, *hard = NULL, *out = NULL;
    qc_mesh *refined = NULL;
    uint8_t *edge = malloc((size_t)mesh->n_edges);
    assert_int_equal(qc_features_detect(ctx, mesh, 35 * PI / 180, 0, NULL, &found), QC_OK);
    memcpy(edge, found->edge, (size_t)mesh->n_edges);
    qc_prune_options options = QC_PRUNE_OPTIONS_INIT;
    options.half = 0.25 * least;
    options.least = least;
    assert_int_equal(qc_features_prune(ctx, mesh, &options, edge), QC_OK);
    assert_int_equal(qc_features_create(ctx, mesh, edge, true, &hard), QC_OK);
    assert_int_equal(qc_features_split(ctx, hard, NULL, &refined, &out, NULL), QC_OK);
    assert_ptr_equal(refined, out->mesh);
    const void *made[] = {found, hard, refined, mesh};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) qc_object_release(made[i]);
    free(edge);
    return out;
}

static inline qc_features *hard_features(qc_ctx *ctx, qc_mesh *mesh) {
    return pruned_features(ctx, mesh, 0);
}

/* No other edge joins two features, no face has two feature edges. */
static inline void check_room(const qc_features *f) {
    const qc_mesh *mesh = f->mesh;
    assert_true(f->hard);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        assert_true(f->edge[e] || !f->vertex[mesh->edge_vertex[2 * e]] ||
                    !f->vertex[mesh->edge_vertex[2 * e + 1]]);
        assert_true(mesh->edge_halfedge[2 * e + 1] >= 0 || f->edge[e] == QC_FEATURE_BOUNDARY);
    }
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        int n = 0;
        for (int k = 0; k < 3; k++) n += f->edge[mesh->halfedge_edge[3 * t + k]] != 0;
        assert_true(n <= 1);
    }
}

/* Every cross beside a feature runs along it to 1e-12. */
static inline void check_along(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *aligned,
                               const qc_complex *x) {
    qc_complex *tangent = malloc(sizeof *tangent * 3 * (size_t)mesh->n_faces);
    assert_int_equal(qc_tangent_edges(ctx, mesh, tangent), QC_OK);
    for (int32_t h = 0; h < 3 * mesh->n_faces; h++)
        if (aligned[mesh->halfedge_edge[h]]) {
            const double off = qc__axis_deviation(tangent[h], x[h / 3]);
            if (!(off < 1e-12)) print_error("face %d is %g off\n", h / 3, off);
            assert_true(off < 1e-12);
        }
    free(tangent);
}

/* Crosses, axes and sectors: k >= 1 and within one quarter turn of the angle, and
 *     sum over interior vertices of index4 + sum over boundary vertices of (2 - k) = 4 chi. */
static inline void check_matching(qc_ctx *ctx, const qc_matching *m) {
    const qc_mesh *mesh = m->field->mesh;
    qc_complex *tangent = malloc(sizeof *tangent * 3 * (size_t)mesh->n_faces);
    int32_t *turns = calloc((size_t)mesh->n_vertices, sizeof *turns), sum = 0;
    bool *closed = calloc((size_t)mesh->n_vertices, sizeof *closed);
    qc__sectors all;
    assert_non_null(m->axis);
    check_along(ctx, mesh, m->field->aligned, m->field->x);
    assert_int_equal(qc_tangent_edges(ctx, mesh, tangent), QC_OK);
    assert_int_equal(qc__sectors_create(ctx, mesh, m->field->aligned, tangent, m->theta, &all),
                     QC_OK);
    for (int32_t i = 0; i < all.n; i++) {
        const qc__sector *s = &all.sector[i];
        assert_true(s->turns >= 1);
        assert_true(fabs(s->turns - 2 * s->angle / PI) < 1);
        turns[s->vertex] += s->turns;
        closed[s->vertex] = true;
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (qc_vertex_on_boundary(mesh, v)) {
            assert_true(closed[v]);
            sum += 2 - turns[v];
        } else {
            if (closed[v]) assert_int_equal(m->index4[v], 4 - turns[v]);
            sum += m->index4[v];
        }
    }
    assert_int_equal(sum, 4 * mesh->euler);
    qc__sectors_free(&all);
    free(tangent);
    free(turns);
    free(closed);
}

/* The field of the default pipeline: principal directions, smoothest, smooth, separate. */
static inline qc_face_field *hard_field(qc_ctx *ctx, const qc_features *f) {
    const qc_mesh *mesh = f->mesh;
    const size_t F = (size_t)mesh->n_faces;
    const double quad = sqrt(mesh->area / 1000);
    qc_complex *x = malloc(F * sizeof *x), *guide = malloc(F * sizeof *x);
    double *weight = malloc(F * sizeof *weight), *kappa = malloc(2 * F * sizeof *kappa);
    uint8_t *trusted = calloc(F, 1);
    qc_face_field *out = NULL;
    assert_int_equal(
        qc_field_curvature(ctx, mesh, QC_CURVATURE_COHEN_STEINER_MORVAN, quad, x, kappa), QC_OK);
    assert_int_equal(qc_field_stability(ctx, mesh, x, kappa, weight), QC_OK);
    assert_int_equal(qc_field_align(ctx, mesh, f->edge, (double)INFINITY, x, weight, trusted),
                     QC_OK);
    check_along(ctx, mesh, f->edge, x);
    assert_int_equal(qc_field_extend(ctx, mesh, weight, 0.3, x, trusted), QC_OK);
    check_along(ctx, mesh, f->edge, x);
    memcpy(guide, x, F * sizeof *x);
    assert_int_equal(qc_field_smoothest(ctx, mesh, weight, trusted, 1, quad / 2, x), QC_OK);
    check_along(ctx, mesh, f->edge, x);
    assert_int_equal(qc_field_smooth(ctx, mesh, guide, weight, trusted, f->edge, 0, 0.5, 20, x),
                     QC_OK);
    check_along(ctx, mesh, f->edge, x);
    assert_int_equal(qc_field_separate(ctx, mesh, 0.7 * quad, f->edge, trusted, x, NULL), QC_OK);
    check_along(ctx, mesh, f->edge, x);
    assert_int_equal(qc_face_field_create(ctx, mesh, x, weight, trusted, &out), QC_OK);
    assert_int_equal(qc_face_field_set_aligned(ctx, out, f->edge, 0), QC_OK);
    free(x);
    free(guide);
    free(weight);
    free(kappa);
    free(trusted);
    return out;
}

static inline qc_matching *hard_matching(qc_ctx *ctx, const qc_features *f) {
    qc_face_field *field = hard_field(ctx, f);
    qc_matching *m = NULL;
    const qc_status status = qc_matching_create(ctx, field, NULL, &m);
    if (status) print_error("%s\n", qc_ctx_error(ctx)->text);
    assert_int_equal(status, QC_OK);
    qc_object_release(field);
    return m;
}

#endif
