/* Chains of feature edges: their ends are corners, arc length and points agree. */
#include "sdk/finish/internal.h"
#include "unit/mesh/fixtures.h"

/* Every point is on the halfedge it is said to be on, at the arc length asked for. */
static void check_arcs(const qc__curves *c) {
    for (int32_t i = 0; i < c->n; i++) {
        double last[3], at = 0;
        for (int k = 0; k <= 40; k++) {
            double x[3], weight[3], tangent[3], step = 0;
            int32_t face;
            const double s = c->length[i] * k / 40;
            const double used = qc__curve_point(c, i, s, &face, weight, tangent);
            if (k < 40 || !c->closed[i]) assert_near(used, s, 1e-12);
            assert_near(qc__norm3(tangent), 1, 1e-12);
            qc__face_point(c->mesh, face, weight, x);
            for (int d = 0; k > 0 && d < 3; d++) step += (x[d] - last[d]) * (x[d] - last[d]);
            assert_true(sqrt(step) <= s - at + 1e-12); /* a chord is no longer than its arc */
            memcpy(last, x, sizeof x);
            at = s;
        }
    }
}

static void a_square_has_four_sides(void **state) {
    qc_mesh *m = grid(*state, 5, 4, 0, 1);
    qc__curves c;
    assert_int_equal(qc__curves_create(*state, m, NULL, &c), QC_OK);
    assert_int_equal(c.n, 4);
    int corners = 0;
    for (int32_t v = 0; v < m->n_vertices; v++) corners += c.corner[v];
    assert_int_equal(corners, 4);
    for (int32_t i = 0; i < 4; i++) {
        assert_near(c.length[i], 1, 1e-12);
        assert_false(c.closed[i]);
        assert_true(c.corner[qc__curve_end(&c, i, 0)] && c.corner[qc__curve_end(&c, i, 1)]);
    }
    check_arcs(&c);
    qc__curves_clear(&c);
    qc_object_release(m);
}

static void circles_are_closed(void **state) {
    qc_mesh *m = grid(*state, 24, 4, 1, 1);
    qc__curves c;
    assert_int_equal(qc__curves_create(*state, m, NULL, &c), QC_OK);
    assert_int_equal(c.n, 2);
    assert_true(c.closed[0] && c.closed[1]);
    assert_near(c.length[0], 48 * sin(PI / 24), 1e-12);
    int32_t face[2];
    double weight[2][3];
    qc__curve_point(&c, 1, -0.3, &face[0], weight[0], NULL);
    qc__curve_point(&c, 1, c.length[1] - 0.3, &face[1], weight[1], NULL);
    assert_int_equal(face[0], face[1]);
    for (int k = 0; k < 3; k++) assert_near(weight[0][k], weight[1][k], 1e-9);
    check_arcs(&c);
    qc__curves_clear(&c);
    qc_object_release(m);
}

static void a_cube_has_twelve_edges(void **state) {
    qc_mesh *m = voxels(*state, 1, 1, 1, "#", 1);
    qc_features *features = NULL;
    qc__curves c;
    assert_int_equal(qc_features_detect(*state, m, 0.5, 0, NULL, &features), QC_OK);
    assert_int_equal(qc__curves_create(*state, m, features->edge, &c), QC_OK);
    assert_int_equal(c.n, 12);
    check_arcs(&c);
    qc__curves_clear(&c);
    qc_object_release(features);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_square_has_four_sides),
        cmocka_unit_test(circles_are_closed),
        cmocka_unit_test(a_cube_has_twelve_edges),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
