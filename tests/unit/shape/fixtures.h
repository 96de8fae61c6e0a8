/* Common to the tests of sdk/shape. */
#ifndef QC_TEST_SHAPE_FIXTURES_H
#define QC_TEST_SHAPE_FIXTURES_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <qc/shape.h>

#include "unit/context.h"

static inline qc_mesh *shape(qc_ctx *ctx, const char *name, const qc_shape_options *options) {
    qc_mesh *m = NULL;
    qc_status status = qc_shape_create(ctx, name, options, &m);
    if (status != QC_OK) print_error("%s: %s\n", name, qc_ctx_error(ctx)->text);
    assert_int_equal(status, QC_OK);
    return m;
}

/* Smallest angle in degrees. */
static inline double smallest_angle(qc_ctx *ctx, const qc_mesh *m) {
    double *angle = malloc(3 * (size_t)m->n_faces * sizeof *angle), least = 4;
    assert_int_equal(qc_mesh_geometry(ctx, m, NULL, NULL, NULL, angle, NULL, NULL), QC_OK);
    for (int32_t c = 0; c < 3 * m->n_faces; c++) least = fmin(least, angle[c]);
    free(angle);
    return least * 180 / 3.14159265358979323846;
}

static inline void expect_topology(const qc_mesh *m, const qc_shape_info *info, int32_t genus) {
    assert_int_equal(m->n_components, 1);
    assert_int_equal(m->genus, info->genus < 0 ? genus : info->genus);
    assert_int_equal(m->n_boundary_loops, info->boundary_loops);
}

#endif
