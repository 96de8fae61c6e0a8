/* The default pipeline on all meshes of the test data, at 10 000 quads. */
#include <dirent.h>

#include "tests/golden/golden.h"

static const golden_failure expected_failure[] = {
    {NULL, NULL, NULL},
};

static int is_mesh(const struct dirent *entry) {
    return strstr(entry->d_name, ".obj") || strstr(entry->d_name, ".off");
}

static void ten_thousand_quads(void **state) {
    (void)state;
    char folder[4096], path[8192];
    struct dirent **entry = NULL;
    const int n = scandir(test_data("meshes", folder), &entry, is_mesh, alphasort);
    assert_true(n > 0);
    for (int i = 0; i < n; i++) {
        qc_ctx *ctx = golden_context(2);
        qc_polygon_mesh *soup = NULL;
        qc_remesh_result result = {0};
        snprintf(path, sizeof path, "%s/%s", folder, entry[i]->d_name);
        assert_int_equal(qc_polygon_mesh_read(ctx, path, &soup), QC_OK);
        golden(ctx, entry[i]->d_name, soup, 10000, NULL, expected_failure, &result);
        qc_remesh_result_clear(&result);
        qc_object_release(soup);
        qc_ctx_free(ctx);
        free(entry[i]);
    }
    free(entry);
}

int main(void) {
    const int skip = test_data_missing();
    const struct CMUnitTest tests[] = {cmocka_unit_test(ten_thousand_quads)};
    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
