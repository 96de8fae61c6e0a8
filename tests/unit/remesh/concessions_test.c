/* Which hard features are given up first: the weakest near a place, boundaries last without one. */
#include "unit/mesh/fixtures.h"

#include "sdk/remesh/internal.h"

enum { N = 20 };
static const double quad = 0.05;

static int32_t at(int32_t i, int32_t j) {
    return i * (N + 1) + j;
}

/* The unit square with three strokes: one of 2 cells at x = 0.2, ones of 4 and 6 cells at x = 0.8.
 */
static qc__concessions square(qc_ctx *ctx) {
    int32_t line[2 * 12], n = 0;
    for (int32_t j = 9; j < 11; j++) line[n++] = at(4, j), line[n++] = at(4, j + 1);
    for (int32_t j = 8; j < 12; j++) line[n++] = at(16, j), line[n++] = at(16, j + 1);
    for (int32_t j = 7; j < 13; j++) line[n++] = at(15, j), line[n++] = at(15, j + 1);
    qc_mesh *mesh = grid(ctx, N, N, 0, 1);
    qc_features *features = NULL;
    qc__concessions c;
    assert_int_equal(qc_features_detect(ctx, mesh, 0.5, n / 2, line, &features), QC_OK);
    assert_int_equal(qc__concessions_create(ctx, features, &c), QC_OK);
    qc_object_release(features);
    qc_object_release(mesh);
    assert_int_equal(c.n, 4);
    assert_int_equal(c.n_boundaries, 1);
    return c;
}

/* Edges of the chain which went last: more chains are gone one by one. */
static int32_t next(qc_ctx *ctx, qc__concessions *c, const double *place) {
    uint8_t before[4];
    memcpy(before, c->gone, sizeof before);
    assert_int_equal(qc__concessions_grow(ctx, c, c->n_gone + 1, place, quad, "a test"), QC_OK);
    for (int i = 0; i < 4; i++)
        if (c->gone[i] != before[i]) return c->chain[i].n_edges;
    return 0;
}

static void the_weakest_goes_first_and_boundaries_last(void **state) {
    qc__concessions c = square(*state);
    static const int32_t order[] = {2, 4, 6, 4 * N};
    for (int i = 0; i < 4; i++) assert_int_equal(next(*state, &c, NULL), order[i]);
    qc__concessions_clear(&c);
}

static void what_is_near_the_place_goes_first(void **state) {
    qc__concessions c = square(*state);
    const double place[3] = {0.85, 0.5, 0};
    static const int32_t order[] = {4, 6, 2, 4 * N};
    for (int i = 0; i < 4; i++) assert_int_equal(next(*state, &c, place), order[i]);
    qc__concessions_clear(&c);
}

static void a_short_boundary_goes_before_what_is_far(void **state) {
    qc__concessions c = square(*state);
    const double place[3] = {0, 0.5, 0};
    for (int32_t i = 0; i < c.n; i++)
        if (c.chain[i].kinds & QC_FEATURE_BOUNDARY) c.chain[i].length = quad;
    assert_int_equal(next(*state, &c, place), 4 * N);
    assert_int_equal(next(*state, &c, place), 2);
    qc__concessions_clear(&c);
}

static void the_others_are_left(void **state) {
    qc__concessions c = square(*state);
    qc_features *left = NULL;
    next(*state, &c, NULL);
    assert_int_equal(qc__concessions_features(*state, &c, &left), QC_OK);
    assert_int_equal(left->n_feature_edges, c.features->n_feature_edges - 2);
    qc_object_release(left);
    qc__concessions_clear(&c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_weakest_goes_first_and_boundaries_last),
        cmocka_unit_test(what_is_near_the_place_goes_first),
        cmocka_unit_test(a_short_boundary_goes_before_what_is_far),
        cmocka_unit_test(the_others_are_left),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
