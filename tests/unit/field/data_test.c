/* Reference fields have the indices their authors drew; index sums hold on every data mesh. */
#include "read_mesh.h"
#include "surfaces.h"

static void reference_fields_have_their_indices(void **state) {
    qc_ctx *ctx = *state;
    const struct {
        const char *mesh, *field;
        int minus, plus;
    } cases[] = {
        {"fields/eight.off", "fields/eight.rawfield", 16, 8},
        {"fields/torus.obj", "fields/torus.rawfield", 3, 3},
        {"fields/torus.obj", "fields/torus_twosings.rawfield", 1, 1},
        {"fields/bumpy.off", "fields/bumpy.rawfield", 0, 8},
        {"fields/sphere.obj", "fields/sphere_param.rawfield", 0, 8},
        {"fields/sphere.obj", "fields/sphere_poles.rawfield", 2, 10},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        qc_mesh *mesh = read_mesh(ctx, cases[i].mesh);
        qc_face_field *field = NULL;
        qc_matching *m = NULL;
        char path[TEST_DATA_PATH];
        assert_non_null(mesh);
        assert_int_equal(qc_face_field_read(ctx, mesh, test_data(cases[i].field, path), &field),
                         QC_OK);
        assert_int_equal(qc_matching_create(ctx, field, NULL, &m), QC_OK);
        int minus = 0, plus = 0;
        for (int32_t v = 0; v < mesh->n_vertices; v++) {
            assert_true(abs(m->index4[v]) <= 1);
            minus += m->index4[v] == -1;
            plus += m->index4[v] == 1;
        }
        assert_int_equal(minus, cases[i].minus);
        assert_int_equal(plus, cases[i].plus);
        assert_int_equal(m->index4_sum, 4 * mesh->euler);
        qc_object_release(m);
        qc_object_release(field);
        qc_object_release(mesh);
    }
}

static void index_sums_hold_on_all_meshes(void **state) {
    qc_ctx *ctx = *state;
    const char *names[] = {
        "3holes.off",         "armadillo.obj", "beetle.off",  "botijo.obj",     "bumpy.off",
        "bunny.off",          "camelhead.off", "cow.off",     "cylinder.obj",   "elephant.obj",
        "fandisk.off",        "fertility.off", "planexy.off", "rocker-arm.obj", "screwdriver.off",
        "stanford-bunny.obj", "suzanne.obj"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char name[64];
        snprintf(name, sizeof name, "meshes/%s", names[i]);
        qc_mesh *mesh = read_mesh(ctx, name);
        if (!mesh) continue;
        qc_complex *x = random_crosses(mesh, i);
        qc_matching *m = match(ctx, mesh, x);
        if (mesh->n_boundary_edges == 0) assert_int_equal(m->index4_sum, 4 * mesh->euler);
        qc_object_release(m);
        qc_object_release(mesh);
        free(x);
    }
}

int main(void) {
    const int skip = test_data_missing();
    if (skip) return skip;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference_fields_have_their_indices),
        cmocka_unit_test(index_sums_hold_on_all_meshes),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
