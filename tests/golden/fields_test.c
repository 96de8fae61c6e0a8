/* The default pipeline with fields made elsewhere: their indices survive the import, quads come
 * out. */
#include "tests/golden/golden.h"

/* No quad mesh of a torus has one vertex of valence 3, one of valence 5 and all others of valence 4
 * (Izmestiev, Kusner, Rote, Springborn, Sullivan 2013: the holonomy of a flat torus with two cones
 * of curvature +-pi/2 is more than the quarter turns). So torus_twosings has to fail. */
static const golden_failure expected_failure[] = {
    {"torus_twosings.rawfield", "round", "no quad mesh of a torus"},
    {NULL, NULL, NULL},
};

typedef struct reference {
    const char *mesh, *field;
    int64_t minus, plus; /* vertices of index -1/4 and +1/4; there are no others */
} reference;

static const reference references[] = {
    {"eight.off", "eight.rawfield", 16, 8},         {"torus.obj", "torus.rawfield", 3, 3},
    {"torus.obj", "torus_twosings.rawfield", 1, 1}, {"bumpy.off", "bumpy.rawfield", 0, 8},
    {"sphere.obj", "sphere_param.rawfield", 0, 8},  {"sphere.obj", "sphere_poles.rawfield", 2, 10},
};

static void check_indices(const reference *c, const qc_report *report) {
    golden_equal(c->field, "index -1/4", report->field.index4[7], c->minus);
    golden_equal(c->field, "index +1/4", report->field.index4[9], c->plus);
    golden_equal(c->field, "singularities", report->field.singularities, c->minus + c->plus);
}

/* The steps up to the matching: indices are those drawn by the authors of the fields. */
static void imported_fields_keep_their_indices(void **state) {
    (void)state;
    qc_ctx *ctx = golden_context(2);
    for (size_t i = 0; i < sizeof references / sizeof *references; i++) {
        const reference *c = &references[i];
        char name[64], path[4096];
        qc_polygon_mesh *soup = NULL;
        qc_mesh *mesh = NULL;
        qc_repair_report *repairs = NULL;
        qc_face_field *field = NULL;
        qc_matching *matching = NULL;
        qc_report *report = NULL;
        snprintf(name, sizeof name, "fields/%s", c->mesh);
        assert_int_equal(qc_polygon_mesh_read(ctx, test_data(name, path), &soup), QC_OK);
        assert_int_equal(qc_mesh_repair(ctx, soup, &mesh, &repairs), QC_OK);
        snprintf(name, sizeof name, "fields/%s", c->field);
        assert_int_equal(qc_face_field_read(ctx, mesh, test_data(name, path), &field), QC_OK);
        assert_int_equal(qc_matching_create(ctx, field, NULL, &matching), QC_OK);
        assert_int_equal(qc_report_create(ctx, &report), QC_OK);
        assert_int_equal(qc_report_measure(ctx, mesh, NULL, matching, NULL, NULL, NULL, report),
                         QC_OK);
        check_indices(c, report);
        qc_object_release(report);
        qc_object_release(matching);
        qc_object_release(field);
        qc_object_release(repairs);
        qc_object_release(mesh);
        qc_object_release(soup);
    }
    qc_ctx_free(ctx);
}

static void imported_fields_make_quads(void **state) {
    (void)state;
    qc_ctx *ctx = golden_context(2);
    for (size_t i = 0; i < sizeof references / sizeof *references; i++) {
        const reference *c = &references[i];
        char name[64], mesh[4096], field[4096];
        qc_polygon_mesh *soup = NULL;
        qc_remesh_result result = {0};
        snprintf(name, sizeof name, "fields/%s", c->mesh);
        assert_int_equal(qc_polygon_mesh_read(ctx, test_data(name, mesh), &soup), QC_OK);
        snprintf(name, sizeof name, "fields/%s", c->field);
        golden(ctx, c->field, soup, 5000, test_data(name, field), expected_failure, &result);
        if (result.report) check_indices(c, result.report);
        qc_remesh_result_clear(&result);
        qc_object_release(soup);
    }
    qc_ctx_free(ctx);
}

int main(void) {
    const int skip = test_data_missing();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(imported_fields_keep_their_indices),
        cmocka_unit_test(imported_fields_make_quads),
    };
    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
