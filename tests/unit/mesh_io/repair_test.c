/* Each kind of repair on a small example; what cannot be repaired is refused with the face. */
#include "unit/mesh_io/common.h"
#include "unit/mesh_io/cube.h"

#include <math.h>
#include <stdio.h>

typedef struct repaired {
    qc_mesh *mesh;
    qc_repair_report *report;
} repaired;

static repaired repair_text(qc_ctx *ctx, const char *text) {
    repaired r = {0};
    qc_polygon_mesh *soup = parse_text(ctx, text, "a.obj");
    qc_status status = qc_mesh_repair(ctx, soup, &r.mesh, &r.report);
    if (status) print_error("%s\n", qc_ctx_error(ctx)->text);
    assert_int_equal(status, QC_OK);
    for (int32_t f = 0; f < r.mesh->n_faces; f++)
        assert_in_range(r.mesh->source_face[f], 0, soup->n_faces - 1);
    for (int32_t v = 0; v < r.mesh->n_vertices; v++)
        assert_memory_equal(r.mesh->position + 3 * v, soup->position + 3 * r.mesh->source_vertex[v],
                            3 * sizeof(double));
    qc_object_release(soup);
    return r;
}

static void release(repaired r) {
    qc_object_release(r.mesh);
    qc_object_release(r.report);
}

/* The counts by kind in the order of the enum: "4 0 0 ...". */
static void expect_counts(const qc_repair_report *r, const char *wanted) {
    char text[128] = "";
    size_t n = 0;
    for (int k = 0; k < QC_REPAIR_KINDS; k++)
        n += (size_t)snprintf(text + n, sizeof text - n, k ? " %d" : "%d", (int)r->count[k]);
    assert_string_equal(text, wanted);
    for (int k = 0; k < QC_REPAIR_KINDS; k++)
        for (int i = 0; i < 4; i++) assert_int_equal(r->first[k][i] >= 0, i < r->count[k]);
}

static void refused(qc_ctx *ctx, const char *text, int64_t where, const char *part) {
    qc_polygon_mesh *soup = parse_text(ctx, text, "a.obj");
    qc_mesh *mesh = NULL;
    qc_repair_report *report = NULL;
    assert_int_equal(qc_mesh_repair(ctx, soup, &mesh, &report), QC_ERR_INPUT);
    assert_null(mesh);
    assert_null(report);
    assert_int_equal(qc_ctx_error(ctx)->where, where);
    if (!strstr(qc_ctx_error(ctx)->text, part)) print_error("%s\n", qc_ctx_error(ctx)->text);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, part));
    qc_object_release(soup);
}

/* A pyramid over the square 1..4 with the apex 5, closed: 4 sides and the bottom. */
#define PYRAMID "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 1\n"
#define SIDES   "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"

static void test_clean(void **state) {
    repaired r = repair_text(*state, PYRAMID SIDES "f 1 3 2\nf 1 4 3\n");
    expect_counts(r.report, "0 0 0 0 0 0 0 0 0 0");
    assert_int_equal(r.mesh->n_faces, 6);
    assert_int_equal(r.mesh->euler, 2);
    release(r);
}

static void test_triangulated(void **state) {
    repaired r = repair_text(*state, PYRAMID SIDES "f 1 4 3 2\n");
    expect_counts(r.report, "1 0 0 0 0 0 0 0 0 0");
    assert_int_equal(r.report->first[QC_REPAIR_TRIANGULATED][0], 4);
    assert_int_equal(r.mesh->n_faces, 6);
    release(r);
}

/* The triangles of non-convex polygons cover the polygon once: areas add up, all are upward. */
static void check_planar(qc_ctx *ctx, const char *text, double area, int n_faces) {
    repaired r = repair_text(ctx, text);
    double normal[64 * 3], sum = 0, areas[64];
    assert_int_equal(r.mesh->n_faces, n_faces);
    assert_int_equal(qc_mesh_geometry(ctx, r.mesh, NULL, areas, NULL, NULL, normal, NULL), QC_OK);
    for (int f = 0; f < n_faces; f++) {
        sum += areas[f];
        assert_true(normal[3 * f + 2] > 0.99);
    }
    assert_true(fabs(sum - area) < 1e-12);
    assert_int_equal(r.mesh->euler, 1);
    release(r);
}

static void test_non_convex(void **state) {
    /* an L, from each of its corners as the first */
    const double l[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (int s = 0; s < 6; s++) {
        char text[512];
        int n = 0;
        for (int i = 0; i < 6; i++)
            n += snprintf(text + n, sizeof text - (size_t)n, "v %g %g 0\n", l[(s + i) % 6][0],
                          l[(s + i) % 6][1]);
        snprintf(text + n, sizeof text - (size_t)n, "f 1 2 3 4 5 6\n");
        check_planar(*state, text, 3, 4);
    }
    /* a dart, and a comb whose teeth hide each other */
    check_planar(*state,
                 "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nv 8 0 0\nv 8 8 0\nv 1 2 0\nf 1 2 3 4\nf 2 5 "
                 "6 3\nf 4 3 6\n",
                 48, 5);
    check_planar(
        *state,
        "v 0 0 0\nv 5 0 0\nv 5 3 0\nv 4 3 0\nv 4 1 0\nv 3 1 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 0\n"
        "v 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6 7 8 9 10 11 12\n",
        11, 10);
    /* corners in the middle of straight sides */
    check_planar(*state,
                 "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\nv 0 2 0\nv 0 1 0\nf 1 2 3 "
                 "4 5 6 7 8\n",
                 4, 6);
}

/* Two quads share two consecutive sides: they must not use the same diagonal. */
static void test_pocket(void **state) {
    repaired r = repair_text(*state, "v 0 0 0\nv 1 0 0\nv 1 .1 .3\nv 2 .5 0\nv 0 -.5 0\n"
                                     "f 1 2 3 4\nf 1 5 3 2\nf 1 4 5\n");
    assert_int_equal(r.report->count[QC_REPAIR_DUPLICATE], 0);
    assert_int_equal(r.report->count[QC_REPAIR_NON_MANIFOLD_EDGE], 0);
    assert_int_equal(r.mesh->n_faces, 5);
    assert_int_equal(r.mesh->n_components, 1);
    release(r);
}

static void test_welded_soup(void **state) {
    for (int format = 0; format < CUBE_FORMATS; format++) {
        bytes b;
        qc_polygon_mesh *soup = NULL;
        repaired r = {0};
        cube_bytes(format, &b);
        assert_int_equal(parse_bytes(*state, b.data, b.n, CUBE_NAME[format], &soup), QC_OK);
        assert_int_equal(qc_mesh_repair(*state, soup, &r.mesh, &r.report), QC_OK);
        assert_int_equal(r.mesh->n_vertices, 8);
        assert_int_equal(r.mesh->n_faces, 12);
        assert_int_equal(r.mesh->euler, 2);
        expect_counts(r.report,
                      format < CUBE_STL_ASCII ? "0 0 0 0 0 0 0 0 0 0" : "0 28 0 0 0 0 0 0 0 0");
        for (int i = 0; i < 36; i++)
            for (int k = 0; k < 3; k++)
                assert_true(r.mesh->position[3 * r.mesh->face_vertex[i] + k] ==
                            CUBE_POINT[CUBE_FACE[i / 3][i % 3]][k]);
        qc_object_release(soup);
        release(r);
    }
}

/* A grid of n x n squares in the plane z = 0 from (x, 0), vertices appended; returns the text
 * length. */
static size_t put_grid(char *text, size_t size, int n, double x, double z, int first) {
    size_t used = 0;
    for (int i = 0; i <= n; i++)
        for (int j = 0; j <= n; j++)
            used +=
                (size_t)snprintf(text + used, size - used, "v %g %d %g\n", x + i, j, z * (i > 0));
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            int a = first + i * (n + 1) + j, b = a + n + 1;
            used += (size_t)snprintf(text + used, size - used, "f %d %d %d\nf %d %d %d\n", a, b,
                                     b + 1, a, b + 1, a + 1);
        }
    return used;
}

static void test_welded_seam(void **state) {
    static char text[8192];
    size_t n = put_grid(text, sizeof text, 4, 0, 0, 1);
    put_grid(text + n, sizeof text - n, 4, 4, 0, 26);
    repaired r = repair_text(*state, text);
    expect_counts(r.report, "0 5 0 0 0 0 0 0 0 0");
    assert_int_equal(r.mesh->n_vertices, 45);
    assert_int_equal(r.mesh->n_components, 1);
    release(r);
    /* a third sheet at the same seam: three boundary edges coincide, nothing is glued */
    n += put_grid(text + n, sizeof text - n, 4, 4, 0, 26);
    put_grid(text + n, sizeof text - n, 4, 4, 7, 51);
    r = repair_text(*state, text);
    assert_int_equal(r.report->count[QC_REPAIR_WELDED], 0);
    assert_int_equal(r.mesh->n_components, 3);
    release(r);
}

static void test_faces_dropped(void **state) {
    repaired r = repair_text(*state, PYRAMID SIDES
                             "f 1 3 2\nf 1 4 3\nf 1 1 2\nf 1 2 2 1\nf 5 1 2\nf 2 1 5\n");
    expect_counts(r.report, "1 0 2 2 0 0 0 0 0 0");
    const int32_t duplicate[] = {8, 9, -1, -1};
    assert_memory_equal(r.report->first[QC_REPAIR_DUPLICATE], duplicate, sizeof duplicate);
    assert_int_equal(r.mesh->n_faces, 6);
    release(r);
}

static void test_non_manifold_edge(void **state) {
    static char text[4096]; /* a fin which stands on an edge of a plane */
    size_t n = put_grid(text, sizeof text, 2, 0, 0, 1);
    snprintf(text + n, sizeof text - n,
             "v 1 1.5 1\nv 1 1 2\nv 1 2 2\n"
             "f 5 6 10\nf 5 10 11\nf 11 10 12\nf 10 6 12\n");
    repaired r = repair_text(*state, text);
    expect_counts(r.report, "0 0 0 0 1 0 0 0 0 0");
    assert_int_equal(r.mesh->n_faces, 12);
    assert_int_equal(r.mesh->n_components, 2);
    assert_int_equal(r.mesh->n_boundary_loops, 2);
    release(r);
    /* two pyramids which touch in an edge come apart as solids */
    r = repair_text(*state, PYRAMID "v 1 -1 0\nv 0 -1 0\nv .5 -.5 -1\n" SIDES "f 1 3 2\nf 1 4 3\n"
                                    "f 1 2 8\nf 7 1 8\nf 6 7 8\nf 2 6 8\nf 2 1 6\nf 6 1 7\n");
    assert_int_equal(r.report->count[QC_REPAIR_NON_MANIFOLD_EDGE], 1);
    assert_int_equal(r.mesh->n_components, 2);
    assert_int_equal(r.mesh->n_boundary_loops, 0);
    assert_int_equal(r.mesh->euler, 4);
    release(r);
}

static void test_oriented(void **state) {
    repaired r =
        repair_text(*state, PYRAMID "f 1 2 5\nf 2 5 3\nf 3 4 5\nf 4 1 5\nf 1 3 2\nf 1 4 3\n");
    expect_counts(r.report, "0 0 0 0 0 1 0 0 0 0");
    assert_int_equal(r.report->first[QC_REPAIR_ORIENTED][0], 1);
    release(r);
    /* mostly inward and mixed: turned outward as a whole; consistently inward: left alone */
    r = repair_text(*state, PYRAMID "f 1 2 5\nf 2 5 3\nf 3 5 4\nf 4 5 1\nf 1 2 3\nf 1 3 4\n");
    expect_counts(r.report, "0 0 0 0 0 5 0 0 0 0");
    release(r);
    r = repair_text(*state, PYRAMID "f 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\nf 1 2 3\nf 1 3 4\n");
    expect_counts(r.report, "0 0 0 0 0 0 0 0 0 0");
    release(r);
    /* with boundary: the majority decides */
    r = repair_text(*state, PYRAMID "f 1 5 2\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    expect_counts(r.report, "0 0 0 0 0 1 0 0 0 0");
    assert_int_equal(r.report->first[QC_REPAIR_ORIENTED][0], 0);
    release(r);
}

static void test_moebius(void **state) {
    char text[1024];
    int n = 0;
    for (int i = 0; i < 5; i++)
        for (int k = -1; k < 2; k += 2)
            n += snprintf(text + n, sizeof text - (size_t)n, "v %g %g %g\n",
                          cos(1.2566 * i) * (2 + k * cos(.6283 * i)),
                          sin(1.2566 * i) * (2 + k * cos(.6283 * i)), k * sin(.6283 * i));
    for (int i = 0; i < 5; i++) {
        int a = 2 * i, b = a + 1, c = i < 4 ? a + 2 : 1, d = i < 4 ? a + 3 : 0;
        n += snprintf(text + n, sizeof text - (size_t)n, "f %d %d %d\nf %d %d %d\n", a + 1, c + 1,
                      b + 1, b + 1, c + 1, d + 1);
    }
    qc_polygon_mesh *soup = parse_text(*state, text, "a.obj");
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_repair(*state, soup, &mesh, NULL), QC_ERR_INPUT);
    assert_in_range(qc_ctx_error(*state)->where, 0, 9);
    assert_non_null(strstr(qc_ctx_error(*state)->text, "one-sided"));
    assert_non_null(strstr(qc_ctx_error(*state)->text, "cut it open"));
    qc_object_release(soup);
}

static void test_non_manifold_vertex(void **state) {
    repaired r = repair_text(*state, PYRAMID
                             "v 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\n" SIDES "f 1 3 2\nf 1 4 3\n"
                             "f 7 6 5\nf 8 7 5\nf 9 8 5\nf 6 9 5\nf 6 7 8\nf 6 8 9\n");
    expect_counts(r.report, "0 0 0 0 0 0 1 0 0 0");
    assert_int_equal(r.report->first[QC_REPAIR_NON_MANIFOLD_VERTEX][0], 4);
    assert_int_equal(r.mesh->n_vertices, 10);
    assert_int_equal(r.mesh->n_components, 2);
    release(r);
}

static void test_unreferenced_and_small(void **state) {
    repaired r = repair_text(
        *state,
        "v 9 9 9\n"
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 1\nv 7 7 7\nv 8 7 7\nv 7 8 7\nv 3 3 3\n"
        "f 2 3 6\nf 3 4 6\nf 4 5 6\nf 5 2 6\nf 2 4 3\nf 2 5 4\nf 7 8 9\n");
    expect_counts(r.report, "0 0 0 0 0 0 0 0 2 1");
    assert_int_equal(r.report->first[QC_REPAIR_UNREFERENCED][0], 0);
    assert_int_equal(r.report->first[QC_REPAIR_UNREFERENCED][1], 9);
    assert_int_equal(r.report->first[QC_REPAIR_SMALL_COMPONENT][0], 6);
    assert_int_equal(r.mesh->n_vertices, 5);
    release(r);
    refused(*state, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 0, "at least 4 triangles");
    refused(*state, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n", 0, "at least 4 triangles");
}

/* Random triangles of few vertices: anything becomes a manifold mesh or is refused as one-sided. */
static void test_random_soups(void **state) {
    uint64_t seed = 42;
    int valid = 0;
    for (int round = 0; round < 400; round++) {
        qc_polygon_mesh *soup = NULL;
        int n_vertices = 4 + round % 9, n_faces = 4 + round % 29;
        assert_int_equal(
            qc_polygon_mesh_create(*state, n_vertices, n_faces, 3 * n_faces, 0, 0, 0, &soup),
            QC_OK);
        for (int i = 0; i < 3 * n_vertices; i++)
            soup->position[i] =
                (double)((seed = seed * 6364136223846793005u + 1442695040888963407u) >> 60);
        for (int i = 0; i < 3 * n_faces; i++)
            soup->face_vertex[i] =
                (int32_t)((seed = seed * 6364136223846793005u + 1442695040888963407u) >> 33) %
                n_vertices;
        for (int f = 0; f <= n_faces; f++) soup->face_offset[f] = 3 * f;
        repaired r = {0};
        qc_status status = qc_mesh_repair(*state, soup, &r.mesh, &r.report);
        if (status != QC_OK && status != QC_ERR_INPUT)
            print_error("%s\n", qc_ctx_error(*state)->text);
        assert_true(status == QC_OK || status == QC_ERR_INPUT);
        valid += status == QC_OK;
        qc_object_release(soup);
        release(r);
    }
    assert_true(valid > 50);
}

static void test_names(void **state) {
    (void)state;
    for (int i = 0; i < QC_REPAIR_KINDS; i++)
        for (int j = 0; j < i; j++)
            assert_string_not_equal(qc_repair_kind_name(i), qc_repair_kind_name(j));
    assert_string_equal(qc_repair_kind_name(QC_REPAIR_TRIANGULATED), "polygons triangulated");
    assert_string_equal(qc_repair_kind_name(-1), "unknown repair");
    assert_string_equal(qc_repair_kind_name(QC_REPAIR_KINDS), "unknown repair");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_clean),
                                       cmocka_unit_test(test_triangulated),
                                       cmocka_unit_test(test_non_convex),
                                       cmocka_unit_test(test_pocket),
                                       cmocka_unit_test(test_welded_soup),
                                       cmocka_unit_test(test_welded_seam),
                                       cmocka_unit_test(test_faces_dropped),
                                       cmocka_unit_test(test_non_manifold_edge),
                                       cmocka_unit_test(test_oriented),
                                       cmocka_unit_test(test_moebius),
                                       cmocka_unit_test(test_non_manifold_vertex),
                                       cmocka_unit_test(test_unreferenced_and_small),
                                       cmocka_unit_test(test_random_soups),
                                       cmocka_unit_test(test_names)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
