/* All meshes of the test data are read and repaired into valid meshes. */
#include "tests/test_data.h"
#include "unit/mesh_io/common.h"

#include <dirent.h>
#include <stdio.h>

static void check(qc_ctx *ctx, const char *path) {
    qc_polygon_mesh *soup = NULL;
    qc_mesh *mesh = NULL;
    qc_repair_report *report = NULL;
    qc_status status = qc_polygon_mesh_read(ctx, path, &soup);
    if (status == QC_OK) status = qc_mesh_repair(ctx, soup, &mesh, &report);
    if (status != QC_OK) print_error("%s\n", qc_ctx_error(ctx)->text);
    assert_int_equal(status, QC_OK);
    assert_int_equal(mesh->euler, mesh->n_vertices - mesh->n_edges + mesh->n_faces);
    assert_int_equal(mesh->euler,
                     2 * mesh->n_components - 2 * mesh->genus - mesh->n_boundary_loops);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        assert_memory_equal(mesh->position + 3 * v, soup->position + 3 * mesh->source_vertex[v],
                            3 * sizeof(double));
    /* nothing of these meshes is lost */
    assert_int_equal(report->count[QC_REPAIR_SMALL_COMPONENT], 0);
    assert_true(mesh->n_faces >= soup->n_faces);
    qc_object_release(soup);
    qc_object_release(mesh);
    qc_object_release(report);
}

static void test_all(void **state) {
    char meshes[TEST_DATA_PATH], path[2 * TEST_DATA_PATH];
    int n = 0;
    DIR *directory = opendir(test_data("meshes", meshes));
    assert_non_null(directory);
    for (struct dirent *entry; (entry = readdir(directory));) {
        if (!strstr(entry->d_name, ".obj") && !strstr(entry->d_name, ".off")) continue;
        snprintf(path, sizeof path, "%s/%s", meshes, entry->d_name);
        check(*state, path);
        n++;
    }
    closedir(directory);
    assert_true(n > 0);
}

int main(void) {
    const int skip = test_data_missing();
    if (skip) return skip;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_all)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
