/* Every allocation of the relaxation is made to fail once. */
#include "unit/finish/quads.h"
#include "unit/mesh/failing_allocator.h"

typedef struct input {
    const qc_mesh *mesh;
    const qc_polygon_mesh *quads;
} input;

static qc_status work(qc_ctx *ctx, const void *data) {
    const input *in = data;
    qc_polygon_mesh *out = NULL;
    const qc_status status = qc_quads_relax(ctx, in->mesh, in->quads, NULL, &out);
    assert_true((status == QC_OK) == (out != NULL));
    qc_object_release(out);
    return status;
}

static void test_failures(void **state) {
    qc_mesh *m = grid(*state, 3, 3, 0, 1);
    qc_polygon_mesh *q = quad_grid(*state, 3, 0.2, -1, 1);
    const input in = {m, q};
    fail_every_allocation(work, &in);
    qc_object_release(q);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_failures)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
