/* Unusable files are refused with the place, the reason and a way out. */
#include "unit/mesh_io/common.h"
#include "unit/mesh_io/cube.h"

typedef struct bad {
    const char *name, *text;
    int64_t where;
    const char *part;
} bad;

static void check_all(qc_ctx *ctx, const bad *cases, size_t n) {
    for (size_t i = 0; i < n; i++)
        expect_bad(ctx, cases[i].text, strlen(cases[i].text), cases[i].name, cases[i].where,
                   cases[i].part);
}
#define CHECK(ctx, cases) check_all(ctx, cases, sizeof(cases) / sizeof *(cases))

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

static void test_any(void **state) {
    const bad cases[] = {
        {"a.obj", "", 1, "empty"},
        {"a.ply", "", 1, "empty"},
        {"a.obj", " \n\t\n", 3, "only comments"},
        {"a", "# x\n# y\n", 3, "only comments"},
        {"a", "hello world\n", 1, "not recognised"},
        {"a.txt", "\x7f\x45\x4c\x46\1\2\3", 1, "not recognised"},
        {"a.ply", "plywood\n", 1, "begins with 'ply'"},
    };
    CHECK(*state, cases);
}

static void test_obj(void **state) {
    const bad cases[] = {
        {"a.obj", "v 0 0 0\n", 2, "no faces"},
        {"a.obj", TRIANGLE "f 1 2 4\n", 4, "vertex index 4 is out of range (3 vertices)"},
        {"a.obj", TRIANGLE "\nf 1 2 -4\n", 5, "vertex index -4 is out of range (3 read so far)"},
        {"a.obj", TRIANGLE "f 0 1 2\n", 4, "index 0"},
        {"a.obj", TRIANGLE "f 1 2 99999999999999999999\n", 4, "out of range"},
        {"a.obj", TRIANGLE "f 1 2 -99999999999999999999\n", 4, "out of range"},
        {"a.obj", TRIANGLE "f 1 2 2147483648\n", 4, "out of range"},
        {"a.obj", TRIANGLE "f 1 2\n", 4, "2 corners"},
        {"a.obj", TRIANGLE "f\n", 4, "0 corners"},
        {"a.obj", TRIANGLE "f 1 2 x\n", 4, "'x' is not a vertex index"},
        {"a.obj", TRIANGLE "f 1/1 2/1 3/1\n", 4, "texture index 1 is out of range (0"},
        {"a.obj", TRIANGLE "vt 0 0\nf 1/1 2/1 3/2\n", 5, "texture index 2"},
        {"a.obj", TRIANGLE "vt nan 0\nf 1 2 3\n", 4, "texture coordinate 1"},
        {"a.obj", TRIANGLE "f 1/1/1/1 2 3\n", 4, "v/vt/vn"},
        {"a.obj", TRIANGLE "f 1 2 3\nl 1 7\n", 0, "line segment 0"},
        {"a.obj", "v 0 0\nf 1 1 1\n", 1, "coordinate 3 of vertex 1 is not a number"},
        {"a.obj", "v 0 0 nan\n", 1, "coordinate 3 of vertex 1 is not finite"},
        {"a.obj", "v 0 0 0\n\nv -inf 0 0\n", 3, "coordinate 1 of vertex 2 is not finite"},
        {"a.obj", "v 1e999 0 0\n", 1, "not finite"},
        {"a.obj", "v 1.#IND 0 0\n", 1, "not a number: '1.#IND'"},
        {"a.obj", "v 1,5 0 0\n", 1, "'1,5'"},
        {"a.obj", "v 0 0 0 \\", 1, "no faces"},
    };
    CHECK(*state, cases);
}

#define OFF_TRIANGLE "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n"

static void test_off(void **state) {
    const bad cases[] = {
        {"a.off", "OFF", 1, "number of vertices"},
        {"a.off", "OFF BINARY\n", 1, "binary OFF is not supported"},
        {"a.off", "4OFF\n1 1 1\n", 1, "more than 3 coordinates"},
        {"a.off", "nOFF\n4\n1 1 1\n", 1, "more than 3 coordinates"},
        {"a.off", "OFF\n-3 1 0\n", 2, "promises -3 vertices"},
        {"a.off", "OFF\n4000000000 1 0\n0 0 0\n", 2, "promises 4000000000 vertices"},
        {"a.off", "OFF\n99999999999999999999999 1 0\n0 0 0\n", 2, "promises"},
        {"a.off", "OFF\n1 99999999 0\n0 0 0\n", 2, "promises 99999999 faces"},
        {"a.off", "OFF\nx y z\n", 2, "instead of 'x'"},
        {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1\n3 0 1 2\n", 5, "coordinate 3 of vertex 2"},
        {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", 5, "ends before vertex 2 of 3"},
        {"a.off", OFF_TRIANGLE, 6, "ends before face 0 of 1"},
        {"a.off", OFF_TRIANGLE "3 0 1 4000\n", 6,
         "a.off:6: vertex index 4000 is out of range (3 vertices)"},
        {"a.off", OFF_TRIANGLE "3 0 1 -1\n", 6, "vertex index -1"},
        {"a.off", OFF_TRIANGLE "2 0 1\n", 6, "2 corners"},
        {"a.off", OFF_TRIANGLE "-2 0 1\n", 6, "-2 corners"},
        {"a.off", OFF_TRIANGLE "2000000000 0 1 2\n", 7, "corner 4 of 2000000000"},
        {"a.off", OFF_TRIANGLE "3 0 1\n", 7, "corner 3 of 3"},
        {"a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", 6, "no faces"},
        {"a.off", "OFF\n3 1 0\n0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", 4,
         "coordinate 2 of vertex 1 is not finite"},
    };
    CHECK(*state, cases);
}

#define PLY_ASCII "ply\nformat ascii 1.0\n"
#define XYZ       "property float x\nproperty float y\nproperty float z\n"
#define LIST      "property list uchar int vertex_indices\n"

static void test_ply(void **state) {
    const bad cases[] = {
        {"a.ply", "ply\n", 2, "no end_header"},
        {"a.ply", "ply\nformat morse 1.0\n", 2, "'morse'"},
        {"a.ply", "ply\nelement vertex 0\n" XYZ "end_header\n", 6, "no format"},
        {"a.ply", PLY_ASCII "element vertex\n", 3, "a name and a count"},
        {"a.ply", PLY_ASCII "element vertex -5\n", 3, "a name and a count"},
        {"a.ply", PLY_ASCII "property float x\n", 3, "before any element"},
        {"a.ply", PLY_ASCII "element vertex 1\nproperty complex x\n", 4, "type 'complex'"},
        {"a.ply", PLY_ASCII "element face 1\nproperty list float int vertex_indices\n", 4,
         "property type"},
        {"a.ply", PLY_ASCII "element vertex 1\nproperty float x\nend_header\n0\n", 3,
         "lacks a property"},
        {"a.ply", PLY_ASCII "element face 1\nproperty int x\nend_header\n0\n", 3, "lacks the list"},
        {"a.ply", PLY_ASCII "garbage\n", 3, "'garbage'"},
        {"a.ply", PLY_ASCII "element vertex 4000000000\n" XYZ "end_header\n0 0 0\n", 3,
         "promises 4000000000"},
        {"a.ply", PLY_ASCII "element vertex 1\n" XYZ "end_header\n0 0 nan\n", 8, "not finite"},
        {"a.ply", PLY_ASCII "element vertex 1\n" XYZ "end_header\n0 0 zero\n", 8, "not a number"},
        {"a.ply", PLY_ASCII "element vertex 1\n" XYZ "end_header\n0 0 0\n", 8, "no faces"},
        {"a.ply",
         PLY_ASCII "element vertex 1\n" XYZ "element face 1\n" LIST "end_header\n0 0 0\n3 0 0 1\n",
         10, "vertex index 1 is out of range (1 vertices)"},
        {"a.ply",
         PLY_ASCII "element vertex 1\n" XYZ "element face 1\n" LIST "end_header\n0 0 0\n2 0 0\n",
         11, "fewer than 3 corners"},
        {"a.ply",
         PLY_ASCII "element vertex 1\n" XYZ "element face 1\n" LIST "end_header\n0 0 0\n-3 0 0\n",
         11, "negative length"},
        {"a.ply",
         PLY_ASCII "element vertex 1\n" XYZ "element face 1\n" LIST "end_header\n0 0 0\n3 0 -1 0\n",
         11, "no valid vertex index"},
    };
    CHECK(*state, cases);
}

/* Every proper prefix of a binary file is refused, and the byte lies inside the file. */
static void test_truncated(void **state) {
    for (int format = CUBE_PLY_LITTLE; format < CUBE_FORMATS; format++) {
        bytes b;
        cube_bytes(format, &b);
        if (format == CUBE_STL_ASCII) continue;
        size_t needed = b.n - (format == CUBE_STL_BINARY ? 0 : 4);
        for (size_t n = 1; n < needed; n++) {
            qc_polygon_mesh *m = NULL;
            qc_status status = parse_bytes(*state, b.data, n, CUBE_NAME[format], &m);
            assert_int_equal(status, QC_ERR_INPUT);
            assert_in_range(qc_ctx_error(*state)->where, 0, n);
        }
    }
}

static void test_binary_values(void **state) {
    bytes b;
    cube_bytes(CUBE_PLY_BIG, &b);
    const char *end = strstr(b.data, "end_header\n");
    size_t data = (size_t)(end - b.data) + 11 + 10; /* behind the element before the vertices */
    memcpy(b.data + data, "\x7f\xc0\0\0", 4);
    expect_bad(*state, b.data, b.n, "nan.ply", (int64_t)data + 17,
               "vertex 0 of 8: a coordinate is not finite");
    cube_bytes(CUBE_PLY_BIG, &b);
    size_t face = data + 8 * 17 + 5; /* first corner of the first face */
    memcpy(b.data + face, "\0\0\1\0", 4);
    expect_bad(*state, b.data, b.n, "index.ply", 0,
               "vertex index 256 is out of range (8 vertices)");
    memcpy(b.data + face, "\xff\xff\xff\xff", 4);
    expect_bad(*state, b.data, b.n, "index.ply", (int64_t)face + 4, "no valid vertex index");
    cube_bytes(CUBE_STL_BINARY, &b);
    memcpy(b.data + 84 + 50 + 12, "\0\0\x80\x7f", 4);
    expect_bad(*state, b.data, b.n, "inf.stl", 134,
               "triangle 1 has a coordinate which is not finite");
    memcpy(b.data + 80, "\xff\xff\xff\xff", 4);
    expect_bad(*state, b.data, b.n, "count.stl", (int64_t)b.n, "promises 4294967295 triangles");
}

static void test_stl(void **state) {
    const bad cases[] = {
        {"a.stl", "solid x\nendsolid x\n", 3, "no faces"},
        {"a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n", 6,
         "2 vertices"},
        {"a.stl", "solid\nvertex 0 0 0\n", 2, "outside of 'outer loop'"},
        {"a.stl",
         "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n", 7,
         "cut off"},
        {"a.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 nan 0\n", 5,
         "coordinate 2 of vertex 1"},
        {"a.stl", "solid\nfacet\nouter loop\nvertex 0 0\n", 4, "coordinate 3 of vertex 0"},
        {"a.stl", "abc", 3, "84 bytes"},
    };
    CHECK(*state, cases);
}

static void test_files(void **state) {
    qc_polygon_mesh *m = NULL;
    assert_int_equal(qc_polygon_mesh_read(*state, "/nonexistent/mesh.obj", &m), QC_ERR_IO);
    assert_int_equal(qc_polygon_mesh_read(*state, "/", &m), QC_ERR_IO);
    assert_non_null(strstr(qc_ctx_error(*state)->text, "director"));
    assert_null(m);
}

static bool cancel(void *user, const char *stage, double fraction) {
    (void)user, (void)stage, (void)fraction;
    return false;
}

static void test_cancelled(void **state) {
    (void)state;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.progress = cancel;
    qc_ctx *ctx = NULL;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    for (int format = 0; format < CUBE_FORMATS; format++) {
        qc_polygon_mesh *m = NULL;
        bytes b;
        cube_bytes(format, &b);
        assert_int_equal(parse_bytes(ctx, b.data, b.n, CUBE_NAME[format], &m), QC_ERR_CANCELLED);
        assert_null(m);
    }
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any),       cmocka_unit_test(test_obj),
        cmocka_unit_test(test_off),       cmocka_unit_test(test_ply),
        cmocka_unit_test(test_truncated), cmocka_unit_test(test_binary_values),
        cmocka_unit_test(test_stl),       cmocka_unit_test(test_files),
        cmocka_unit_test(test_cancelled)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
