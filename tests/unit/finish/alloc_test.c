/* Every allocation of the relaxation is made to fail once. */
#include "unit/finish/quads.h"
#include "unit/mesh/failing_allocator.h"

typedef struct input {
    const qc_mesh *mesh;
    const qc_polygon_mesh *quads, *all; /* all: triangles with every attribute */
} input;

static qc_status work(qc_ctx *ctx, const void *data) {
    const input *in = data;
    qc_polygon_mesh *out = NULL;
    const qc_status status = qc_quads_relax(ctx, in->mesh, in->quads, NULL, &out);
    assert_true((status == QC_OK) == (out != NULL));
    qc_object_release(out);
    if (status != QC_OK) return status;
    out = NULL;
    const qc_status second = qc_quads_transfer(ctx, in->all, in->mesh, in->quads, &out);
    assert_true((second == QC_OK) == (out != NULL));
    qc_object_release(out);
    return second;
}

static void test_failures(void **state) {
    qc_mesh *m = grid(*state, 3, 3, 0, 1);
    qc_polygon_mesh *q = quad_grid(*state, 3, 0.2, -1, 1);
    qc_polygon_mesh *all = NULL;
    assert_int_equal(qc_polygon_mesh_create(*state, m->n_vertices, m->n_faces, 3 * m->n_faces, 1, 0,
                                            QC_POLYGON_FACE_GROUP, &all),
                     QC_OK);
    memcpy(all->position, m->position, 3 * sizeof(double) * (size_t)m->n_vertices);
    memcpy(all->face_vertex, m->face_vertex, 3 * sizeof(int32_t) * (size_t)m->n_faces);
    for (int32_t f = 0; f < m->n_faces; f++) all->face_offset[f + 1] = 3 * f + 3;
    for (int at = QC_AT_VERTEX; at <= QC_AT_CORNER; at++)
        assert_int_equal(
            qc_polygon_mesh_add_attribute(*state, all, "a", at, QC_ATTRIBUTE_DIRECTION, 2, NULL),
            QC_OK);
    const char *const name[] = {"g a"};
    assert_int_equal(qc__polygon_name_groups(*state, all, 1, name, "mtllib m"), QC_OK);
    const input in = {m, q, all};
    fail_every_allocation(work, &in);
    qc_object_release(all);
    qc_object_release(q);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_failures)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
