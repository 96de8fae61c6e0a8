/* .rawfield and .rosy: round trip, variants, bad files named by line. */
#include "surfaces.h"

static char *scratch_path(const char *name) {
    static char path[4096];
    const char *folder = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/qc_field_%s", folder ? folder : "/tmp", name);
    return path;
}

static void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void written_fields_come_back(void **state) {
    qc_ctx *ctx = *state;
    qc_mesh *mesh = ellipsoid(ctx, 12, 9, 1e-3, 2e-3, 3e-3);
    qc_complex *x = random_crosses(mesh, 12);
    const char *names[] = {"a.rawfield", "a.rosy"};
    for (int i = 0; i < 2; i++) {
        const char *path = scratch_path(names[i]);
        qc_face_field *field = NULL, *back = NULL;
        assert_int_equal(qc_face_field_create(ctx, mesh, x, NULL, NULL, &field), QC_OK);
        assert_int_equal(qc_face_field_write(ctx, field, path), QC_OK);
        assert_int_equal(qc_face_field_read(ctx, mesh, path, &back), QC_OK);
        assert_ptr_equal(back->mesh, mesh);
        for (int32_t t = 0; t < mesh->n_faces; t++)
            assert_true(hypot(back->x[t].re - x[t].re, back->x[t].im - x[t].im) < 1e-13);
        qc_object_release(field);
        qc_object_release(back);
        remove(path);
    }
    qc_object_release(mesh);
    free(x);
}

/* Two triangles in the plane z = 0, of a file with three faces of which the middle one was dropped.
 */
static qc_mesh *two_triangles(qc_ctx *ctx) {
    const double p[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const int32_t f[6] = {0, 1, 2, 0, 2, 3}, source[2] = {0, 2};
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create_from(ctx, 4, p, 2, f, NULL, source, &mesh), QC_OK);
    return mesh;
}

static void fields_follow_the_faces_of_the_file(void **state) {
    qc_ctx *ctx = *state;
    const char *path = scratch_path("b");
    const char *texts[] = {
        "4 3\n1 0 0 0 1 0 -1 0 0 0 -1 0\n0 0 9 0 0 9 0 0 9 0 0 9\n2 1 5 -1 2 5 -2 -1 5 1 -2 5\n",
        "3\n4\n1 0 0\n0 0 9\n2 1 5\n",
        "# comment\r\n3 4\r\n0 -1e300 0 # first\r\n0 0 9\r\n-1e-300 2e-300 0\r\n",
        "1 3\n3 0 0 0 0 9\n20 10 0\n",
    };
    qc_mesh *mesh = two_triangles(ctx);
    double real[6], imaginary[6], u[3] = {1, 0, 0}, v[3] = {2, 1, 0};
    assert_int_equal(qc_tangent_frames(ctx, mesh, real, imaginary), QC_OK);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        qc_face_field *field = NULL;
        write_text(path, texts[i]);
        assert_int_equal(qc_face_field_read(ctx, mesh, path, &field), QC_OK);
        assert_true(cross_angle(field->x[0], in_frame(real, imaginary, 0, u)) < 1e-12);
        assert_true(cross_angle(field->x[1], in_frame(real, imaginary, 1, v)) < 1e-12);
        qc_object_release(field);
    }
    remove(path);
    qc_object_release(mesh);
}

static void bad_files_are_named_by_line(void **state) {
    qc_ctx *ctx = *state;
    const struct {
        const char *text;
        int64_t line;
    } bad[] = {
        {"", 1},
        {"4", 1},
        {"four 3\n", 1},
        {"6 3\n", 1},          /* N */
        {"4 2\n", 1},          /* fewer faces than the file of the mesh */
        {"4 2000000000\n", 1}, /* a count which cannot be */
        {"4 -3\n", 1},
        {"1 3\n1 0 0\n0 0 1\n1 0\n", 5}, /* truncated */
        {"1 3\n1 0 0\n0 0 1\n1 0 x\n", 4},
        {"1 3\n1 0 0\n0 0 1\n1 nan 0\n", 4},
        {"1 3\n1 0 0\n0 0 1\n1 1e999 0\n", 4},
        {"1 3\n1 0 0\n0 0 1\n0 0 0\n", 4},    /* zero */
        {"1 3\n0 0 1\n0 0 1\n1 0 0\n", 2},    /* perpendicular */
        {"1 3\n1 0 0\n0 0 1\n1 0 0\n7\n", 5}, /* too long */
    };
    const char *path = scratch_path("c");
    qc_mesh *mesh = two_triangles(ctx);
    qc_face_field *field = NULL;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        write_text(path, bad[i].text);
        assert_int_equal(qc_face_field_read(ctx, mesh, path, &field), QC_ERR_INPUT);
        assert_int_equal(qc_ctx_error(ctx)->where, bad[i].line);
        assert_non_null(strstr(qc_ctx_error(ctx)->text, path));
    }
    remove(path);
    assert_int_equal(qc_face_field_read(ctx, mesh, path, &field), QC_ERR_IO);
    assert_null(field);
    qc_object_release(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(written_fields_come_back),
        cmocka_unit_test(fields_follow_the_faces_of_the_file),
        cmocka_unit_test(bad_files_are_named_by_line),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
