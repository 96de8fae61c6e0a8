/* Every allocation of the mesh module is made to fail once: the calls report NOMEM, leave their
 * outputs alone and give all memory back. */
#include <qc/ray.h>

#include "unit/mesh/failing_allocator.h"
#include "unit/mesh/fixtures.h"

/* Everything once; stops at the first failure. */
static qc_status work(qc_ctx *ctx, const void *unused) {
    (void)unused;
    static const double position[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const int32_t face[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    static const uint8_t base[] = {1, 0, 1, 0};
    qc_mesh *m = NULL, *part = NULL, *half = NULL;
    qc_features *features = NULL;
    static const double ray[] = {0.1, 0.1, 5, 0, 0, -1, 0.3, 0.3, 5, 0, 0, -1};
    static const int32_t stroke[] = {0, 2};
    qc_polygon_mesh *p = NULL, *both = NULL, *strokes = NULL;
    qc_pick pick[2];
    qc_polygon_topology topology;
    uint8_t cut[6], edge[6];
    int32_t chain[6], n_chains;
    qc_feature_chain measured[6];
    int32_t offset[1];
    double gauss[4];
    qc_status s = qc_mesh_create_from(ctx, 4, position, 4, face, face, face, &m);
    if (s == QC_OK) s = qc_mesh_component(ctx, m, 0, &part);
    if (s == QC_OK) s = qc_mesh_boundary_loops(ctx, m, offset, NULL);
    if (s == QC_OK) s = qc_mesh_geometry(ctx, m, NULL, NULL, NULL, NULL, NULL, gauss);
    if (s == QC_OK) s = qc_mesh_cut_graph(ctx, m, NULL, base, cut);
    if (s == QC_OK) s = qc_features_detect(ctx, m, 0.5, 2, face, &features);
    for (int i = 0; s == QC_OK && i < 6; i++) edge[i] = features->edge[i];
    if (s == QC_OK) s = qc_features_chains(ctx, m, edge, chain, &n_chains);
    if (s == QC_OK) s = qc_features_measure_chains(ctx, m, edge, measured);
    if (s == QC_OK) s = qc_features_prune(ctx, m, NULL, edge);
    if (s == QC_OK) s = qc_polygon_mesh_create(ctx, 4, 4, 12, 2, 1, 7, &p);
    for (int i = 0; s == QC_OK && i < 12; i++) p->face_vertex[i] = face[i];
    for (int i = 0; s == QC_OK && i < 5; i++) p->face_offset[i] = 3 * i;
    if (s == QC_OK) memcpy(p->position, position, sizeof position);
    if (s == QC_OK) s = qc_mesh_pick(ctx, m, features, NULL, NULL, 2, ray, pick);
    if (s == QC_OK) s = qc_ray_strokes(ctx, p, NULL, 1, stroke, ray, 0.05, &strokes);
    qc_plane plane = {{0, 0, 1}, 0.2};
    double deviation;
    if (s == QC_OK) s = qc_mesh_half(ctx, m, &plane, &half);
    if (s == QC_OK) s = qc_mesh_find_symmetry(ctx, m, -1, 1, NULL, &plane, &deviation);
    const qc_polygon_mesh *parts[] = {p, p};
    if (s == QC_OK) s = qc_polygon_mesh_merge(ctx, 2, parts, NULL, &both);
    if (s == QC_OK) s = qc_polygon_mesh_topology(ctx, both, &topology);
    assert_true(s != QC_OK || topology.components == 2);
    qc_object_release(both);
    qc_object_release(strokes);
    qc_object_release(p);
    qc_object_release(features);
    qc_object_release(part);
    qc_object_release(half);
    qc_object_release(m);
    return s;
}

static void test_failures(void **state) {
    (void)state;
    fail_every_allocation(work, NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_failures)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
