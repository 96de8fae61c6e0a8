/* Every allocation of every shape is made to fail once. */
#include "unit/mesh/failing_allocator.h"
#include "unit/shape/fixtures.h"

static qc_status work(qc_ctx *ctx, const void *name) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    options.resolution = 60;
    options.retriangulate = 1;
    options.noise = 0.1;
    qc_mesh *m = NULL;
    qc_status status = qc_shape_create(ctx, name, &options, &m);
    assert_int_equal(m != NULL, status == QC_OK);
    qc_object_release(m);
    return status;
}

static void test_failures(void **state) {
    (void)state;
    size_t n;
    const qc_shape_info *table = qc_shape_list(&n);
    for (size_t i = 0; i < n; i++) fail_every_allocation(work, table[i].name);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_failures)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
