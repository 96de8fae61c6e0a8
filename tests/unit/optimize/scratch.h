/* A smooth matching to start from, and E_D of a state by sdk/dec. */
#ifndef QC_TEST_OPTIMIZE_SCRATCH_H
#define QC_TEST_OPTIMIZE_SCRATCH_H

#include "unit/field/surfaces.h"

#include <qc/optimize.h>

#include "sdk/base/internal.h"

/* E_D of the present matching by sdk/dec. */
static inline double from_scratch(qc_ctx *ctx, const qc_distortion *d, const qc_sizing *sizing) {
    qc_matching *m = NULL;
    assert_int_equal(qc_distortion_matching(ctx, d, &m), QC_OK);
    const qc_mesh *mesh = m->field->mesh;
    const size_t F = (size_t)mesh->n_faces;
    qc_complex *edge = malloc(sizeof *edge * 3 * F), *z = malloc(sizeof *z * 3 * F);
    double *scale = malloc(sizeof *scale * F), *cotangent = malloc(sizeof *cotangent * 3 * F);
    for (size_t t = 0; t < F; t++)
        scale[t] = !sizing ? 1 : 1 / (sizing->length ? sizing->length[t] : sizing->edge_length);
    assert_int_equal(qc_tangent_edges(ctx, mesh, edge), QC_OK);
    assert_int_equal(qc_form_from_cross(ctx, mesh, edge, m->field->x, scale, z), QC_OK);
    for (size_t h = 0; sizing && sizing->stretch && h < 3 * F; h++) {
        const qc_complex x = m->field->x[h / 3], s = sizing->stretch[h / 3];
        const double longer = exp(s.re * (x.re * x.re - x.im * x.im) + s.im * 2 * x.re * x.im);
        z[h].re /= longer;
        z[h].im *= longer;
    }
    assert_int_equal(qc_mesh_geometry(ctx, mesh, NULL, NULL, cotangent, NULL, NULL, NULL), QC_OK);
    const qc_cover cover = {mesh, m->m};
    double energy = -1;
    assert_int_equal(qc_hodge_remove_curl(ctx, &cover, cotangent, NULL, z, NULL, NULL, &energy),
                     QC_OK);
    qc_distortion_state s;
    qc_distortion_get_state(d, &s);
    assert_int_equal(s.branch_points, m->n_singular);
    assert_memory_equal(s.index4, m->index4, sizeof *s.index4 * (size_t)mesh->n_vertices);
    free(edge);
    free(z);
    free(scale);
    free(cotangent);
    qc_object_release(m);
    return energy;
}

static inline double present(const qc_distortion *d) {
    qc_distortion_state s;
    qc_distortion_get_state(d, &s);
    return s.energy;
}

static inline void check_energy(qc_ctx *ctx, const qc_distortion *d, const qc_sizing *sizing) {
    const double expected = from_scratch(ctx, d, sizing);
    if (fabs(present(d) - expected) > 1e-9 * expected)
        fail_msg("E_D %.15g, from scratch %.15g", present(d), expected);
}

static inline qc_matching *smooth_matching(qc_ctx *ctx, const qc_mesh *mesh, bool aligned) {
    qc_complex *x = random_crosses(mesh, 1);
    double *weight = malloc(sizeof *weight * (size_t)mesh->n_faces);
    uint64_t seed = 3;
    assert_int_equal(qc_field_smoothest(ctx, mesh, NULL, NULL, 0, 0, x), QC_OK);
    for (int32_t t = 0; t < mesh->n_faces; t++) weight[t] = uniform(&seed);
    qc_face_field *field = NULL;
    qc_matching *m = NULL;
    assert_int_equal(qc_face_field_create(ctx, mesh, x, aligned ? weight : NULL, NULL, &field),
                     QC_OK);
    assert_int_equal(qc_matching_create(ctx, field, NULL, &m), QC_OK);
    qc_object_release(field);
    free(x);
    free(weight);
    return m;
}

static inline qc_flip_step random_flip(const qc_distortion *d, const qc_mesh *mesh,
                                       uint64_t *seed) {
    for (;;) {
        const int32_t e = (int32_t)(uniform(seed) * mesh->n_edges);
        const qc_flip_step flip = {e, uniform(seed) < 0.5 ? 1 : -1};
        if (qc_distortion_can_flip(d, e)) return flip;
    }
}

#endif
