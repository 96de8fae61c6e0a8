/* Genus and boundary loops of every shape at every resolution are those of the table. */
#include "unit/shape/fixtures.h"

static void test_table(void **state) {
    size_t n;
    const qc_shape_info *table = qc_shape_list(&n);
    const int32_t resolution[] = {1, 300, 2000, 20000};
    assert_int_equal(n, 15);
    for (size_t i = 0; i < n; i++) {
        for (int k = 0; k < 4; k++) {
            qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
            options.resolution = resolution[k];
            qc_mesh *m = shape(*state, table[i].name, &options);
            expect_topology(m, &table[i], options.genus);
            if (k > 0)
                assert_true(m->n_faces > 0.6 * resolution[k] && m->n_faces < 1.5 * resolution[k]);
            if (k > 0) assert_true(smallest_angle(*state, m) > 10);
            qc_object_release(m);
        }
    }
}

static void test_every_genus(void **state) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    for (options.genus = 0; options.genus <= 50; options.genus++) {
        for (options.resolution = 300; options.resolution < 10000; options.resolution += 5000) {
            qc_mesh *m = shape(*state, "genus", &options);
            assert_int_equal(m->genus, options.genus);
            assert_int_equal(m->euler, 2 - 2 * options.genus);
            assert_int_equal(m->n_components, 1);
            assert_true(smallest_angle(*state, m) > 10);
            qc_object_release(m);
        }
    }
}

static void refuse(qc_ctx *ctx, const char *name, qc_shape_options options, qc_status status) {
    qc_mesh *out = (qc_mesh *)&options;
    assert_int_equal(qc_shape_create(ctx, name, &options, &out), status);
    assert_ptr_equal(out, &options);
}

static void test_errors(void **state) {
    qc_shape_options good = QC_SHAPE_OPTIONS_INIT, bad = good;
    refuse(*state, "shpere", good, QC_ERR_NOT_FOUND);
    assert_non_null(strstr(qc_ctx_error(*state)->text, "\"sphere\""));
    bad.genus = 51;
    refuse(*state, "genus", bad, QC_ERR_ARGUMENT);
    bad = good;
    bad.resolution = -1;
    refuse(*state, "cube", bad, QC_ERR_ARGUMENT);
    bad = good;
    bad.noise = NAN;
    refuse(*state, "cube", bad, QC_ERR_ARGUMENT);
}

static void test_defaults(void **state) {
    qc_mesh *m = shape(*state, "torus", NULL);
    assert_true(m->n_faces > 6000 && m->n_faces < 10000);
    qc_object_release(m);
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT; /* an older, shorter struct */
    options.struct_size = (uint32_t)offsetof(qc_shape_options, noise);
    options.resolution = 500;
    options.genus = -7;
    m = shape(*state, "genus", &options);
    assert_int_equal(m->genus, 2);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_every_genus),
        cmocka_unit_test(test_errors),
        cmocka_unit_test(test_defaults),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
