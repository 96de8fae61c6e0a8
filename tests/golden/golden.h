/* Runs the default pipeline and checks what every quad mesh must hold (docs/files.md): only quads,
 * manifold, the topology of the input, no fold-over, exact seams, the number asked for, indices
 * which sum to 4 chi. */
#ifndef QC_TESTS_GOLDEN_H
#define QC_TESTS_GOLDEN_H

#include "tests/test_data.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <qc/qc.h>

/* A model which may still fail, and how; it must not fail in any other way. */
typedef struct golden_failure {
    const char *name;        /* of the model */
    const char *step, *text; /* of the pipeline; part of the message */
} golden_failure;

static inline const golden_failure *golden_expected(const golden_failure *list, const char *name) {
    for (; list->name; list++)
        if (strcmp(list->name, name) == 0) return list;
    return NULL;
}

static inline qc_ctx *golden_context(uint32_t threads) {
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx = NULL;
    options.threads = threads;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    return ctx;
}

static inline qc_polygon_mesh *golden_soup(qc_ctx *ctx, const qc_mesh *mesh) {
    qc_polygon_mesh *soup = NULL;
    assert_int_equal(qc_polygon_mesh_create(ctx, mesh->n_vertices, mesh->n_faces, 3 * mesh->n_faces,
                                            0, 0, 0, &soup),
                     QC_OK);
    memcpy(soup->position, mesh->position, 3 * sizeof(double) * (size_t)mesh->n_vertices);
    memcpy(soup->face_vertex, mesh->face_vertex, 3 * sizeof(int32_t) * (size_t)mesh->n_faces);
    for (int32_t t = 0; t <= mesh->n_faces; t++) soup->face_offset[t] = 3 * t;
    return soup;
}

static inline qc_status golden_run(qc_ctx *ctx, const qc_polygon_mesh *soup, double quads,
                                   const char *field, qc_remesh_result *result) {
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    qc_remesh_options strict = QC_REMESH_OPTIONS_INIT;
    qc_registry *registry = NULL;
    qc_pipeline *pipeline = NULL;
    options.quads = quads;
    options.field_path = field;
    strict.strict = 1;
    assert_int_equal(qc_registry_create(ctx, &registry), QC_OK);
    qc_status status = qc_default_pipeline(ctx, registry, &options, &pipeline);
    if (status == QC_OK) status = qc_remesh(ctx, pipeline, soup, &strict, result);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
    return status;
}

#define golden_equal(name, what, value, wanted)                                                    \
    do {                                                                                           \
        if ((long long)(value) != (long long)(wanted))                                             \
            fail_msg("%s: %s is %lld, not %lld", name, what, (long long)(value),                   \
                     (long long)(wanted));                                                         \
    } while (0)

static inline void golden_check(qc_ctx *ctx, const char *name, double quads,
                                const qc_remesh_result *r) {
    const qc_mesh *mesh = r->mesh;
    qc_polygon_topology t;
    assert_non_null(r->quads);
    assert_int_equal(qc_polygon_mesh_topology(ctx, r->quads, &t), QC_OK);
    golden_equal(name, "failed components", r->n_failed, 0);
    golden_equal(name, "faces other than quads", t.non_quads, 0);
    golden_equal(name, "non-manifold edges", t.non_manifold_edges, 0);
    golden_equal(name, "non-manifold vertices", t.non_manifold_vertices, 0);
    golden_equal(name, "inconsistent edges", t.inconsistent_edges, 0);
    golden_equal(name, "duplicate faces", t.duplicate_faces, 0);
    golden_equal(name, "degenerate faces", t.degenerate_faces, 0);
    golden_equal(name, "unreferenced vertices", t.unreferenced_vertices, 0);
    golden_equal(name, "Euler characteristic", t.euler, mesh->euler);
    golden_equal(name, "boundary loops", t.boundary_loops, mesh->n_boundary_loops);
    golden_equal(name, "components", t.components, mesh->n_components);
    golden_equal(name, "reversed faces of the map", r->report->uv.flipped, 0);
    golden_equal(name, "degenerate faces of the map", r->report->uv.degenerate, 0);
    if (r->report->uv.max_seam_error != 0)
        fail_msg("%s: seam error %g", name, r->report->uv.max_seam_error);
    if (fabs(r->quads->n_faces / quads - 1) > 0.05)
        fail_msg("%s: %d quads instead of %g", name, (int)r->quads->n_faces, quads);
    for (int32_t i = 0; i < 3 * r->quads->n_vertices; i++)
        if (!isfinite(r->quads->position[i])) fail_msg("%s: vertex %d", name, (int)(i / 3));
    int64_t sum = 0, singularities = 0;
    for (int i = -8; i <= 8; i++) {
        sum += i * r->report->field.index4[8 + i];
        singularities += i ? r->report->field.index4[8 + i] : 0;
    }
    golden_equal(name, "singularities", r->report->field.singularities, singularities);
    if (mesh->n_boundary_loops == 0) golden_equal(name, "index sum", sum, 4 * mesh->euler);
}

/* On a closed surface every vertex of index i/4 becomes one of valence 4 - i, and all others have
 * valence 4. */
static inline void golden_check_valences(const char *name, const qc_remesh_result *r) {
    int32_t *valence = calloc((size_t)r->quads->n_vertices, sizeof *valence);
    int64_t count[13] = {0};
    assert_non_null(valence);
    for (int32_t c = 0; c < r->quads->n_corners; c++) valence[r->quads->face_vertex[c]]++;
    for (int32_t v = 0; v < r->quads->n_vertices; v++) count[valence[v] < 12 ? valence[v] : 12]++;
    free(valence);
    for (int i = -8; i < 4; i++)
        if (i != 0)
            golden_equal(name, "vertices of the valence of an index", count[4 - i],
                         r->report->field.index4[8 + i]);
}

/* Runs and checks; a model on the list may fail as the list says. */
static inline void golden(qc_ctx *ctx, const char *name, const qc_polygon_mesh *soup, double quads,
                          const char *field, const golden_failure *list, qc_remesh_result *result) {
    const golden_failure *expected = golden_expected(list, name);
    const qc_status status = golden_run(ctx, soup, quads, field, result);
    if (status == QC_OK) {
        golden_check(ctx, name, quads, result);
        if (result->mesh->n_boundary_loops == 0) golden_check_valences(name, result);
        if (expected) print_message("%s succeeds: take it off the list\n", name);
        return;
    }
    const qc_error *error = qc_ctx_error(ctx);
    if (!expected) fail_msg("%s, %g quads: %s: %s", name, quads, error->stage, error->text);
    if (status != QC_ERR_FAILED || strcmp(error->stage, expected->step) != 0 ||
        !strstr(error->text, expected->text))
        fail_msg("%s fails in another way: %s: %s", name, error->stage, error->text);
    print_message("%s, %g quads, fails as expected: %s: %s\n", name, quads, error->stage,
                  error->text);
}

#endif
