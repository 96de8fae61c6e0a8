/* Noise and retriangulation keep the topology, depend on the seed alone, and do disturb. */
#include "unit/shape/fixtures.h"

static bool same(const qc_mesh *a, const qc_mesh *b) {
    return a->n_vertices == b->n_vertices && a->n_faces == b->n_faces &&
           memcmp(a->position, b->position, 24 * (size_t)a->n_vertices) == 0 &&
           memcmp(a->face_vertex, b->face_vertex, 12 * (size_t)a->n_faces) == 0;
}

static void test_topology(void **state) {
    size_t n;
    const qc_shape_info *table = qc_shape_list(&n);
    for (size_t i = 0; i < n; i++) {
        for (int k = 0; k < 2; k++) {
            qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
            options.resolution = k ? 4000 : 300;
            options.retriangulate = 1;
            qc_mesh *m = shape(*state, table[i].name, &options);
            expect_topology(m, &table[i], options.genus);
            assert_true(smallest_angle(*state, m) > 5);
            qc_object_release(m);
            options.noise = 0.1;
            m = shape(*state, table[i].name, &options);
            expect_topology(m, &table[i], options.genus);
            assert_true(smallest_angle(*state, m) > 1);
            qc_mesh *again = shape(*state, table[i].name, &options);
            assert_true(same(m, again));
            qc_object_release(again);
            options.seed = 2;
            again = shape(*state, table[i].name, &options);
            assert_false(same(m, again));
            qc_object_release(again);
            qc_object_release(m);
        }
    }
}

static int irregular(const qc_mesh *m) {
    int *valence = calloc((size_t)m->n_vertices, sizeof *valence), count = 0;
    for (int32_t c = 0; c < 3 * m->n_faces; c++) valence[m->face_vertex[c]]++;
    for (int32_t v = 0; v < m->n_vertices; v++) count += valence[v] != 6;
    free(valence);
    return count;
}

static void test_knot(void **state) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    qc_mesh *regular = shape(*state, "knot", &options);
    options.retriangulate = 1;
    qc_mesh *flipped = shape(*state, "knot", &options);
    assert_int_equal(irregular(regular), 0);
    assert_true(irregular(flipped) > flipped->n_vertices / 3);
    assert_int_equal(flipped->n_vertices, regular->n_vertices);
    assert_true(fabs(flipped->area / regular->area - 1) < 0.02);
    qc_object_release(regular);
    qc_object_release(flipped);
}

/* Standard deviation of the radii of a noisy sphere. */
static void test_noise_size(void **state) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    qc_mesh *smooth = shape(*state, "sphere", &options);
    options.noise = 0.3;
    qc_mesh *noisy = shape(*state, "sphere", &options);
    double sum = 0;
    for (int32_t v = 0; v < noisy->n_vertices; v++) {
        const double *p = noisy->position + 3 * v;
        sum += pow(sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 1, 2);
    }
    double sigma = sqrt(sum / noisy->n_vertices) / smooth->mean_edge_length;
    assert_true(fabs(sigma - 0.3) < 0.02);
    qc_object_release(smooth);
    qc_object_release(noisy);
}

/* Creases of the cube survive: its volume and box are exact. */
static void test_creases(void **state) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    options.retriangulate = 1;
    qc_mesh *m = shape(*state, "cube", &options);
    for (int32_t v = 0; v < m->n_vertices; v++) {
        const double *p = m->position + 3 * v;
        assert_true(fabs(fmax(fabs(p[0]), fmax(fabs(p[1]), fabs(p[2]))) - 1) < 1e-12);
    }
    assert_true(fabs(m->area - 24) < 1e-9);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_topology),
        cmocka_unit_test(test_knot),
        cmocka_unit_test(test_noise_size),
        cmocka_unit_test(test_creases),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
