/* Any allocation of the default pipeline may fail: the run answers "out of memory", nothing leaks
 * and the bag holds only its input. A sample of all allocations; the stage in which one failed is
 * named. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <qc/qc.h>
#include <stdlib.h>
#include "tests/counting.h"

static void out_of_memory_anywhere_is_an_error(void **state) {
    (void)state;
    enum { SAMPLES = 150 };
    static const char sphere[] = "v 1 0 0\nv -1 0 0\nv 0 1.5 0\nv 0 -1.5 0\nv 0 0 2\nv 0 0 -2\n"
                                 "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\n"
                                 "f 1 4 6\n";
    counter c = {0, -1, 0};
    qc_ctx_options o = QC_CTX_OPTIONS_INIT;
    qc_default_pipeline_options p = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    qc_ctx *ctx;
    qc_registry *registry;
    qc_pipeline *pipeline;
    qc_polygon_mesh *input;
    qc_bag *bag;
    o.resize = counting_resize;
    o.user = &c;
    o.threads = 1; /* the allocator is not thread-safe */
    p.quads = 50;
    p.crease_angle = -1;
    assert_int_equal(qc_ctx_create(&o, &ctx), QC_OK);
    assert_int_equal(qc_registry_create(ctx, &registry), QC_OK);
    assert_int_equal(qc_default_pipeline(ctx, registry, &p, &pipeline), QC_OK);
    assert_int_equal(qc_polygon_mesh_parse(ctx, sphere, sizeof sphere - 1, "in.obj", &input),
                     QC_OK);
    int64_t total = SAMPLES;
    for (int64_t i = -1; i < SAMPLES; i++) { /* -1: counts, nothing fails */
        assert_int_equal(qc_bag_create(ctx, &bag), QC_OK);
        assert_int_equal(qc_bag_put(bag, "input", input), QC_OK);
        const int64_t before = c.blocks;
        c.made = 0;
        c.fail_at = i < 0 ? -1 : i * total / SAMPLES;
        const qc_status status = qc_pipeline_run(pipeline, bag);
        if (i < 0) {
            assert_int_equal(status, QC_OK);
            total = c.made;
        } else if (status != QC_OK) {
            const qc_error *e = qc_ctx_error(ctx);
            if (status != QC_ERR_NOMEM || e->status != status || c.blocks != before)
                print_error("allocation %lld, stage %s: %s; %lld blocks left\n",
                            (long long)c.fail_at, e->stage, e->text,
                            (long long)(c.blocks - before));
            assert_int_equal(status, QC_ERR_NOMEM);
            assert_int_equal(e->status, QC_ERR_NOMEM);
            assert_int_equal(c.blocks, before);
            assert_int_equal(qc_bag_count(bag), 1);
        } /* some allocations are optional: the run may do without */
        c.fail_at = -1;
        qc_bag_free(bag);
    }
    qc_object_release(input);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
    qc_ctx_free(ctx);
    assert_int_equal(c.blocks, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(out_of_memory_anywhere_is_an_error)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
