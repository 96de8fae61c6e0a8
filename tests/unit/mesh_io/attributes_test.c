/* Attributes, uvs, groups and lines survive the formats which have a place for them. */
#include "unit/mesh_io/common.h"
#include "unit/mesh_io/rich.h"

#include <math.h>
#include <stdio.h>

static qc_polygon_mesh *round_trip(qc_ctx *ctx, const qc_polygon_mesh *m, const char *path,
                                   int32_t format) {
    qc_polygon_mesh *n = NULL;
    const qc_status status = qc_polygon_mesh_write_as(ctx, m, path, format, "two\nlines");
    if (status) print_error("%s\n", qc_ctx_error(ctx)->text);
    assert_int_equal(status, QC_OK);
    assert_int_equal(qc_polygon_mesh_read(ctx, path, &n), QC_OK);
    remove(path);
    return n;
}

static void same_shape(const qc_polygon_mesh *m, const qc_polygon_mesh *n) {
    assert_int_equal(n->n_vertices, m->n_vertices);
    assert_int_equal(n->n_faces, m->n_faces);
    assert_int_equal(n->n_corners, m->n_corners);
    assert_memory_equal(n->position, m->position, 3 * sizeof(double) * (size_t)m->n_vertices);
    assert_memory_equal(n->face_vertex, m->face_vertex, sizeof(int32_t) * (size_t)m->n_corners);
    assert_memory_equal(n->face_offset, m->face_offset, sizeof(int32_t) * (size_t)(m->n_faces + 1));
}

static void same_uvs(const qc_polygon_mesh *m, const qc_polygon_mesh *n) {
    assert_true(!m->uv == !n->uv);
    for (int32_t c = 0; m->uv && c < m->n_corners; c++) {
        const int32_t i = m->corner_uv[c], k = n->corner_uv[c];
        assert_true((i < 0) == (k < 0));
        if (i >= 0) assert_memory_equal(m->uv + 2 * i, n->uv + 2 * k, 2 * sizeof(double));
    }
}

static void same_attributes(const qc_polygon_mesh *m, const qc_polygon_mesh *n) {
    assert_int_equal(n->n_attributes, m->n_attributes);
    for (int32_t i = 0; i < m->n_attributes; i++) {
        const qc_attribute *a = &m->attribute[i], *b = qc_polygon_mesh_attribute(n, a->at, a->name);
        assert_non_null(b);
        assert_int_equal(b->kind, a->kind);
        assert_int_equal(b->width, a->width);
        assert_memory_equal(b->value, a->value,
                            sizeof(double) * (size_t)a->width *
                                (size_t)qc_polygon_mesh_elements(m, a->at));
    }
}

static void same_groups(const qc_polygon_mesh *m, const qc_polygon_mesh *n) {
    assert_memory_equal(n->face_group, m->face_group, sizeof(int32_t) * (size_t)m->n_faces);
    assert_int_equal(n->n_groups, m->n_groups);
    for (int32_t g = 0; g < m->n_groups; g++)
        assert_string_equal(n->group_name[g], m->group_name[g]);
    assert_string_equal(n->materials, m->materials);
    assert_int_equal(n->n_lines, m->n_lines);
    assert_memory_equal(n->line, m->line, 2 * sizeof(int32_t) * (size_t)m->n_lines);
}

static const qc_attribute *find(const qc_polygon_mesh *m, int32_t at, const char *name, int kind,
                                int width) {
    const qc_attribute *a = qc_polygon_mesh_attribute(m, at, name);
    assert_non_null(a);
    assert_int_equal(a->kind, kind);
    assert_int_equal(a->width, width);
    return a;
}

static void what_a_ply_holds(void **state) {
    qc_polygon_mesh *m = parse_text(*state, RICH_PLY, "a.ply");
    const qc_attribute *a = find(m, QC_AT_VERTEX, "colour", QC_ATTRIBUTE_LINEAR, 4);
    assert_true(a->value[4] == 1 && a->value[7] == 51 / 255.0);
    a = find(m, QC_AT_VERTEX, "weight", QC_ATTRIBUTE_LINEAR, 3);
    assert_true(a->value[0] == 0.5 && a->value[5] == 0.125);
    a = find(m, QC_AT_VERTEX, "bone", QC_ATTRIBUTE_LABEL, 1);
    assert_true(a->value[0] == -3 && a->value[5] == 12);
    a = find(m, QC_AT_VERTEX, "quality", QC_ATTRIBUTE_LINEAR, 1);
    assert_true(a->value[2] == 0); /* nan */
    a = find(m, QC_AT_FACE, "label", QC_ATTRIBUTE_LABEL, 1);
    assert_true(a->value[0] == 7 && a->value[2] == 9);
    find(m, QC_AT_FACE, "heat", QC_ATTRIBUTE_LINEAR, 1);
    a = find(m, QC_AT_CORNER, "normal", QC_ATTRIBUTE_DIRECTION, 3);
    assert_true(a->value[2] == 1 && a->value[3 * 4 + 1] == -1);
    find(m, QC_AT_VERTEX, "normal", QC_ATTRIBUTE_DIRECTION, 3);
    assert_int_equal(m->n_attributes, 8);
    assert_int_equal(m->face_group[1], 2);
    assert_string_equal(m->group_name[1], "g b\nusemtl red paint");
    assert_string_equal(m->materials, "mtllib a b.mtl");
    assert_int_equal(m->n_uvs, 7); /* shared where equal, two at one vertex */
    assert_int_equal(m->corner_uv[0], m->corner_uv[10]);
    assert_int_equal(m->corner_uv[7], -1);
    assert_int_equal(m->n_lines, 2);
    qc_object_release(m);
}

static void ply_keeps_all(void **state) {
    qc_polygon_mesh *m = parse_text(*state, RICH_PLY, "a.ply");
    for (int32_t format = QC_FORMAT_PLY; format <= QC_FORMAT_PLY_ASCII; format++) {
        qc_polygon_mesh *n = round_trip(*state, m, "attributes_test.x", format);
        same_shape(m, n);
        same_uvs(m, n);
        assert_int_equal(n->n_uvs, m->n_uvs);
        same_attributes(m, n);
        same_groups(m, n);
        qc_object_release(n);
    }
    qc_object_release(m);
}

static void one_uv_for_each_vertex(void **state) {
    qc_polygon_mesh *m = parse_text(*state,
                                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                    "property float y\nproperty float z\nproperty float u\n"
                                    "property float v\nelement face 1\n"
                                    "property list uchar int vertex_index\nend_header\n"
                                    "0 0 0 .5 .25\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n",
                                    "a.ply");
    assert_int_equal(m->n_uvs, 3);
    assert_true(m->uv[0] == 0.5 && m->uv[1] == 0.25);
    qc_polygon_mesh *n = round_trip(*state, m, "attributes_test.ply", QC_FORMAT_AUTO);
    same_shape(m, n);
    same_uvs(m, n);
    assert_memory_equal(n->corner_uv, m->corner_uv, 3 * sizeof(int32_t));
    qc_object_release(n);
    qc_object_release(m);
}

static void obj_normals(void **state) {
    static const char *const texts[] = {
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0.6 0 0.8\n"
        "f 1//1 2//1 3//2\nf 1//1 3//2 4//2\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0.6 0 0.8\n"
        "f 1//1 2//1 3//1\nf 1//2 3//-1 4\n"};
    for (int i = 0; i < 2; i++) {
        const int32_t at = i == 0 ? QC_AT_VERTEX : QC_AT_CORNER;
        qc_polygon_mesh *m = parse_text(*state, texts[i], "a.obj");
        const qc_attribute *a = find(m, at, "normal", QC_ATTRIBUTE_DIRECTION, 3);
        assert_true(a->value[2] == 1);
        if (i == 1) assert_true(a->value[3 * 4] == 0.6 && a->value[3 * 5 + 2] == 0);
        qc_polygon_mesh *n = round_trip(*state, m, "attributes_test.obj", QC_FORMAT_AUTO);
        same_shape(m, n);
        same_attributes(m, n);
        qc_object_release(n);
        qc_object_release(m);
    }
}

/* What OBJ has a place for: first three numbers of colours, uvs, normals, groups, lines. */
static void obj_keeps_the_usual(void **state) {
    qc_polygon_mesh *m = parse_text(*state, RICH_PLY, "a.ply");
    qc_polygon_mesh *n = round_trip(*state, m, "attributes_test.x", QC_FORMAT_OBJ);
    same_shape(m, n);
    same_uvs(m, n);
    same_groups(m, n);
    const qc_attribute *a = find(n, QC_AT_VERTEX, "colour", QC_ATTRIBUTE_LINEAR, 3);
    assert_true(a->value[3] == 1 && a->value[4] == 0);
    find(n, QC_AT_CORNER, "normal", QC_ATTRIBUTE_DIRECTION, 3);
    qc_object_release(n);
    qc_object_release(m);
}

/* Groups in any order: faces of none behind one, and a material which does not go on. */
static void groups_end(void **state) {
    qc_polygon_mesh *m = parse_text(*state,
                                    "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\ng a\nf 1 2 3\n"
                                    "usemtl red\nf 1 2 3\ng\nf 1 2 3\nusemtl\nf 1 2 3\n",
                                    "a.obj");
    const int32_t group[] = {0, 1, 2, 3, 0}, other[] = {2, 0, 3, 1, 0}, back[] = {1, 0, 2, 3, 0};
    assert_memory_equal(m->face_group, group, sizeof group);
    assert_string_equal(m->group_name[2], "usemtl red");
    memcpy(m->face_group, other, sizeof other);
    qc_polygon_mesh *n = round_trip(*state, m, "attributes_test.obj", QC_FORMAT_AUTO);
    assert_memory_equal(n->face_group, back, sizeof back); /* numbered as faces meet them */
    for (int f = 0; f < 5; f++)
        if (back[f]) assert_string_equal(n->group_name[back[f] - 1], m->group_name[other[f] - 1]);
    qc_object_release(n);
    qc_object_release(m);
}

static void off_keeps_the_shape(void **state) {
    qc_polygon_mesh *m = parse_text(*state, RICH_PLY, "a.ply");
    qc_polygon_mesh *n = round_trip(*state, m, "attributes_test.OFF", QC_FORMAT_AUTO);
    same_shape(m, n);
    assert_int_equal(n->n_attributes, 0);
    qc_object_release(n);
    qc_object_release(m);
}

/* Whatever a PLY file calls its numbers, what is read can be written, and reads back the same. */
static void odd_names(void **state) {
    qc_polygon_mesh *m = parse_text(*state,
                                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                    "property float y\nproperty float z\nproperty float x\n"
                                    "property float s\nproperty float red\nproperty float u\n"
                                    "property float v\nproperty int a_0\nproperty float a_1\n"
                                    "element face 1\nproperty list uchar int vertex_indices\n"
                                    "property float x\nproperty float group\nend_header\n"
                                    "0 0 0 9 1 2 3 4 5 6\n1 0 0 9 1 2 3 4 5 6\n"
                                    "0 1 0 9 1 2 3 4 5 6\n3 0 1 2 7 8.5\n",
                                    "a.ply");
    assert_int_equal(m->n_attributes, 6); /* s, red, a_0, a_1; x, group of the face */
    assert_null(m->face_group);
    assert_int_equal(m->n_uvs, 3);
    qc_polygon_mesh *n = round_trip(*state, m, "attributes_test.ply", QC_FORMAT_AUTO);
    same_shape(m, n);
    same_uvs(m, n);
    same_attributes(m, n);
    qc_object_release(n);
    qc_object_release(m);
}

static void refusals(void **state) {
    qc_polygon_mesh *m = parse_text(*state, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj");
    double *x = NULL;
    assert_int_equal(qc_polygon_mesh_add_attribute(*state, m, "", QC_AT_FACE, 0, 1, &x),
                     QC_ERR_ARGUMENT);
    assert_int_equal(qc_polygon_mesh_add_attribute(*state, m, "a", QC_AT_FACE, 0, 0, &x),
                     QC_ERR_ARGUMENT);
    assert_int_equal(qc_polygon_mesh_add_attribute(*state, m, "y", QC_AT_VERTEX, 0, 1, &x), QC_OK);
    assert_int_equal(qc_polygon_mesh_add_attribute(*state, m, "s", QC_AT_FACE, 0, 2, NULL), QC_OK);
    assert_int_equal(qc_polygon_mesh_add_attribute(*state, m, "s", QC_AT_FACE, 0, 2, NULL),
                     QC_ERR_ARGUMENT);
    assert_int_equal(qc_polygon_mesh_write(*state, m, "attributes_test.ply", NULL),
                     QC_ERR_ARGUMENT); /* y is a coordinate there */
    assert_int_equal(qc_polygon_mesh_write_as(*state, m, "attributes_test.ply", 9, NULL),
                     QC_ERR_ARGUMENT);
    x[2] = NAN;
    assert_int_equal(qc_polygon_mesh_write(*state, m, "attributes_test.obj", NULL),
                     QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(*state)->where, 2);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_ply_holds),
        cmocka_unit_test(ply_keeps_all),
        cmocka_unit_test(one_uv_for_each_vertex),
        cmocka_unit_test(obj_normals),
        cmocka_unit_test(obj_keeps_the_usual),
        cmocka_unit_test(off_keeps_the_shape),
        cmocka_unit_test(groups_end),
        cmocka_unit_test(odd_names),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
