/* Every allocation of the module is made to fail once: the calls report NOMEM, give all memory
 * back, and a distortion that exists stays valid. */
#include "unit/mesh/failing_allocator.h"
#include "unit/optimize/scratch.h"

typedef struct start {
    const qc_matching *m;
    qc_ctx *other; /* one that does not fail */
} start;

static qc_status work(qc_ctx *ctx, const void *data) {
    const start *s = data;
    qc_distortion *d = NULL;
    qc_matching *result = NULL;
    qc_reduce_options reduce = QC_REDUCE_OPTIONS_INIT;
    reduce.create = 1;
    reduce.evaluations = 24;
    qc_status status = qc_distortion_create(ctx, s->m, NULL, 0.9, &d);
    if (!status) status = qc_distortion_reduce(ctx, d, &reduce);
    if (!status) status = qc_distortion_cancel(ctx, d, NULL, NULL);
    if (!status) status = qc_distortion_matching(ctx, d, &result);
    if (status && d) check_energy(s->other, d, NULL);
    qc_object_release(result);
    result = NULL;
    if (!status) status = qc_matching_merge(ctx, s->m, 5, INT32_MAX, NULL, &result);
    qc_object_release(result);
    qc_distortion_free(d);
    return status;
}

static void failures_leave_a_valid_state(void **state) {
    qc_mesh *mesh = ellipsoid(*state, 8, 6, 1, 1.2, 3);
    qc_matching *m = smooth_matching(*state, mesh, true);
    const start s = {m, *state};
    fail_every_allocation(work, &s);
    qc_object_release(m);
    qc_object_release(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(failures_leave_a_valid_state, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
