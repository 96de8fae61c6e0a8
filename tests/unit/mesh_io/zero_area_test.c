/* Needles and caps are removed without changing the topology, at any scale of the coordinates. */
#include "unit/mesh_io/common.h"

#include <math.h>
#include <stdio.h>

static double worst_face(const qc_mesh *m) {
    double worst = 1;
    for (int32_t f = 0; f < m->n_faces; f++) {
        const double *p[3];
        double n2 = 0, longest = 0;
        for (int k = 0; k < 3; k++) p[k] = m->position + 3 * m->face_vertex[3 * f + k];
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            double n = (p[1][i] - p[0][i]) * (p[2][j] - p[0][j]) -
                       (p[1][j] - p[0][j]) * (p[2][i] - p[0][i]);
            double d = 0;
            n2 += n * n;
            for (int c = 0; c < 3; c++) d += (p[i][c] - p[j][c]) * (p[i][c] - p[j][c]);
            longest = d > longest ? d : longest;
        }
        double quality = sqrt(n2) / (2 * longest);
        worst = quality < worst ? quality : worst;
    }
    return worst;
}

static qc_repair_report *repaired(qc_ctx *ctx, const char *text, double scale, qc_mesh **mesh) {
    qc_polygon_mesh *soup = parse_text(ctx, text, "a.obj");
    qc_repair_report *report = NULL;
    for (int32_t i = 0; i < 3 * soup->n_vertices; i++) soup->position[i] *= scale;
    assert_int_equal(qc_mesh_repair(ctx, soup, mesh, &report), QC_OK);
    qc_object_release(soup);
    return report;
}

typedef struct example {
    const char *text;
    int removed, n_vertices, n_faces, euler, loops;
} example;

static void check(qc_ctx *ctx, const example *x, double worst) {
    const double scales[] = {1, 0x1p-20, 0x1p20};
    for (int i = 0; i < 3; i++) {
        qc_mesh *m = NULL;
        qc_repair_report *r = repaired(ctx, x->text, scales[i], &m);
        assert_int_equal(r->count[QC_REPAIR_ZERO_AREA], x->removed);
        assert_int_equal(m->n_vertices, x->n_vertices);
        assert_int_equal(m->n_faces, x->n_faces);
        assert_int_equal(m->euler, x->euler);
        assert_int_equal(m->n_boundary_loops, x->loops);
        assert_true(worst_face(m) > worst);
        assert_int_equal(r->count[QC_REPAIR_UNREFERENCED], 0);
        qc_object_release(r);
        qc_object_release(m);
    }
}

/* An octahedron 1..6. */
#define OCTAHEDRON "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
#define LOWER      "f 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n"

/* The edge 1-2 is split in its middle on one side only: a cap between. */
static void test_cap(void **state) {
    const example x = {OCTAHEDRON "v .5 .5 0\n" LOWER
                                  "f 1 7 5\nf 7 2 5\nf 1 2 7\nf 2 3 5\nf 3 4 5\nf 4 1 5\n",
                       1,
                       7,
                       10,
                       2,
                       0};
    check(*state, &x, 0.01);
}

/* The same with a cap of 1e-8 of its length, whose cotangents no factorisation survives. */
static void test_thin_cap(void **state) {
    const example x = {OCTAHEDRON "v .50000001 .50000001 0\n" LOWER
                                  "f 1 7 5\nf 7 2 5\nf 1 2 7\nf 2 3 5\nf 3 4 5\nf 4 1 5\n",
                       1,
                       7,
                       10,
                       2,
                       0};
    check(*state, &x, 0.01);
}

/* The top is two vertices 1e-14 apart: two needles between them. */
static void test_needle(void **state) {
    const example x = {OCTAHEDRON "v 1e-14 0 1\n" LOWER
                                  "f 1 2 7\nf 2 5 7\nf 2 3 5\nf 3 4 5\nf 4 7 5\nf 4 1 7\n",
                       1,
                       6,
                       8,
                       2,
                       0};
    check(*state, &x, 0.01);
}

/* The same with equal coordinates, which welding leaves alone as the vertices are inside. */
static void test_zero_edge(void **state) {
    const example x = {OCTAHEDRON "v 0 0 1\n" LOWER
                                  "f 1 2 7\nf 2 5 7\nf 2 3 5\nf 3 4 5\nf 4 7 5\nf 4 1 7\n",
                       1,
                       6,
                       8,
                       2,
                       0};
    check(*state, &x, 0.01);
}

/* Caps at the boundary: one whose apex is inside is removed, an ear is flipped. */
static void test_boundary(void **state) {
    const example inside = {"v -1 0 0\nv 1 0 0\nv 0 0 0\nv 1 1 0\nv -1 1 0\nv 0 2 0\n"
                            "f 1 2 3\nf 3 2 4\nf 3 4 5\nf 1 3 5\nf 5 4 6\n",
                            1,
                            6,
                            4,
                            1,
                            1};
    check(*state, &inside, 0.01);
    const example ear = {"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 0\nv .5 0 0\n"
                         "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 2 1 6\n",
                         1,
                         6,
                         5,
                         1,
                         1};
    check(*state, &ear, 0.01);
}

/* A row of collinear points on a closed surface: caps hide behind caps. */
static void test_many_caps(void **state) {
    char text[8192];
    enum { N = 30 };
    int n = snprintf(text, sizeof text, OCTAHEDRON);
    for (int i = 1; i < N; i++)
        n += snprintf(text + n, sizeof text - (size_t)n, "v %.17g %.17g 0\n", 1 - i / (double)N,
                      i / (double)N);
    n += snprintf(text + n, sizeof text - (size_t)n, LOWER "f 2 3 5\nf 3 4 5\nf 4 1 5\n");
    for (int i = 0; i < N; i++) { /* fan from 5 to the points, fan of flat caps from 1 */
        int a = i == 0 ? 1 : 6 + i, b = i == N - 1 ? 2 : 7 + i;
        n += snprintf(text + n, sizeof text - (size_t)n, "f %d %d 5\n", a, b);
        if (i > 0) n += snprintf(text + n, sizeof text - (size_t)n, "f 1 %d %d\n", b, a);
    }
    qc_mesh *m = NULL;
    qc_repair_report *r = repaired(*state, text, 1, &m);
    assert_true(r->count[QC_REPAIR_ZERO_AREA] >= N - 1);
    assert_int_equal(m->euler, 2);
    assert_true(worst_face(m) > 1e-6);
    qc_object_release(r);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cap),      cmocka_unit_test(test_thin_cap),
        cmocka_unit_test(test_needle),   cmocka_unit_test(test_zero_edge),
        cmocka_unit_test(test_boundary), cmocka_unit_test(test_many_caps)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
