/* Every format of the same cube reads to the same mesh; details of OBJ, OFF and STL. */
#include "unit/mesh_io/common.h"
#include "unit/mesh_io/cube.h"

static void check_cube(const qc_polygon_mesh *m, bool loose) {
    assert_int_equal(m->n_vertices, loose ? 36 : 8);
    assert_int_equal(m->n_faces, 12);
    for (int f = 0; f < 12; f++) {
        assert_int_equal(m->face_offset[f], 3 * f);
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++)
                assert_true(m->position[3 * m->face_vertex[3 * f + k] + i] ==
                            CUBE_POINT[CUBE_FACE[f][k]][i]);
    }
    assert_int_equal(m->face_offset[12], 36);
    assert_non_null(m->face_line);
}

static void test_cube(void **state) {
    bytes b;
    for (int format = 0; format < CUBE_FORMATS; format++) {
        const char *names[] = {CUBE_NAME[format], "noextension", "wrong.obj", NULL};
        cube_bytes(format, &b);
        for (int i = 0; i < 4; i++) { /* the content decides, not the name */
            qc_polygon_mesh *m = NULL;
            qc_status status = parse_bytes(*state, b.data, b.n, names[i], &m);
            if (status) print_error("%s\n", qc_ctx_error(*state)->text);
            assert_int_equal(status, QC_OK);
            check_cube(m, format >= CUBE_STL_ASCII);
            qc_object_release(m);
        }
    }
}

static void test_obj_corners(void **state) {
    qc_polygon_mesh *m = parse_text(*state,
                                    "v 0 0 0 1\nv 1 0 0\nv 1 1 0 .1 .2 .3\nv 0 1 0\n"
                                    "vn 0 0 1\nvt 0.25 0.5\nvt 1 \nvt 0 1 0\n"
                                    "g a\nf 1/1 2/2/1 3/-1/1\nusemtl b # c\nf -4 3//1 4\n"
                                    "g a\nf 1/1/ 2/2 3/3 4\nl 1 2 3 # polyline\ncurv 0 1 1 2\n",
                                    "a.obj");
    assert_int_equal(m->n_vertices, 4);
    assert_int_equal(m->n_corners, 10);
    assert_int_equal(m->n_uvs, 3);
    const int32_t vertex[] = {0, 1, 2, 0, 2, 3, 0, 1, 2, 3},
                  uv[] = {0, 1, 2, -1, -1, -1, 0, 1, 2, -1};
    const int32_t group[] = {1, 2, 2}, line[] = {0, 1, 1, 2}, at[] = {10, 12, 14};
    assert_memory_equal(m->face_vertex, vertex, sizeof vertex);
    assert_memory_equal(m->corner_uv, uv, sizeof uv);
    assert_memory_equal(m->face_group, group, sizeof group);
    assert_int_equal(m->n_groups, 2);
    assert_string_equal(m->group_name[0], "g a");
    assert_string_equal(m->group_name[1], "g a\nusemtl b");
    const double colour[] = {0, 0, 0, 0, 0, 0, .1, .2, .3, 0, 0, 0};
    const qc_attribute *a = qc_polygon_mesh_attribute(m, QC_AT_VERTEX, "colour");
    assert_int_equal(a->width, 3);
    assert_memory_equal(a->value, colour, sizeof colour);
    assert_int_equal(m->n_lines, 2);
    assert_memory_equal(m->line, line, sizeof line);
    assert_memory_equal(m->face_line, at, sizeof at);
    assert_true(m->uv[0] == 0.25 && m->uv[3] == 0);
    qc_object_release(m);
}

static void test_obj_layout(void **state) {
    /* faces before vertices, byte order mark, CR line ends, continued lines, comment with backslash
     */
    qc_polygon_mesh *m = parse_text(*state,
                                    "\xef\xbb\xbf# note \\\rf 1 \\\r 2 \\\r\n3\r"
                                    "\tv 0 0 \\\n 0\rv 1 0 0\rv 0 1 0",
                                    "b.obj");
    assert_int_equal(m->n_vertices, 3);
    assert_int_equal(m->n_faces, 1);
    assert_int_equal(m->face_line[0], 2);
    assert_null(m->uv);
    assert_null(m->face_group);
    qc_object_release(m);
}

static void test_off_headers(void **state) {
    const char *const texts[] = {
        "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF\r\n\r\n# c\r\n3 1\r\n0 0 0\r\n1 0 0\r\n\r\n0 1 0\r\n3 0 1 2 255 0 0\r\n",
        "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1 # x\n3 0 1 2",
        "STOFF\n3\n1\n0\n0 0 0 0 0\n1 0 0 0 1\n0 1 0 1 0\n3 0\n1 2\n",
        "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        qc_polygon_mesh *m = parse_text(*state, texts[i], "a.off");
        assert_int_equal(m->n_vertices, 3);
        assert_int_equal(m->n_faces, 1);
        assert_int_equal(m->face_vertex[2], 2);
        assert_true(m->position[7] == 1);
        qc_object_release(m);
    }
}

static void test_stl_variants(void **state) {
    /* two solids, upper case, no name */
    qc_polygon_mesh *m =
        parse_text(*state,
                   "solid\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\n"
                   "VERTEX 0 1e0 0\nENDLOOP\nENDFACET\nendsolid\nsolid b\nfacet normal 0 0 1\n"
                   "outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n",
                   "a.stl");
    assert_int_equal(m->n_faces, 2);
    qc_object_release(m);
    /* a comment as the title of a binary file, nothing but blanks in it */
    bytes b = {.n = 0};
    char title[80] = "# only a comment";
    add(&b, title, 80);
    add_bits(&b, 1, 4, 0);
    for (int i = 0; i < 12; i++) add_float(&b, i == 6 || i == 10, 0);
    add_bits(&b, 0, 2, 0);
    assert_int_equal(parse_bytes(*state, b.data, b.n, "b", &m), QC_OK);
    assert_int_equal(m->n_faces, 1);
    qc_object_release(m);
}

static void test_ply_line_ends(void **state) {
    /* a lone CR ends the header; the first data byte is a line feed (a vertex coordinate) */
    for (int lone = 0; lone < 2; lone++) {
        const char *end = lone ? "\r" : "\r\n";
        const char *const lines[] = {"ply",
                                     "format binary_little_endian 1.0",
                                     "element vertex 3",
                                     "property char x",
                                     "property char y",
                                     "property char z",
                                     "element face 1",
                                     "property list uchar uchar vertex_index",
                                     "end_header"};
        bytes b = {.n = 0};
        for (size_t i = 0; i < 9; i++) {
            add_text(&b, lines[i]);
            add_text(&b, end);
        }
        add(&b, "\n\n\n\1\2\3\xff\5\6\3\0\1\2", 13);
        qc_polygon_mesh *m = NULL;
        assert_int_equal(parse_bytes(*state, b.data, b.n, "cr.ply", &m), QC_OK);
        assert_true(m->position[0] == 10 && m->position[6] == -1);
        qc_object_release(m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cube),         cmocka_unit_test(test_obj_corners),
        cmocka_unit_test(test_obj_layout),   cmocka_unit_test(test_off_headers),
        cmocka_unit_test(test_stl_variants), cmocka_unit_test(test_ply_line_ends)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
