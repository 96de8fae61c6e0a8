/* Models of the test data as triangle meshes. */
#ifndef QC_TESTS_FIELD_READ_MESH_H
#define QC_TESTS_FIELD_READ_MESH_H

#include "surfaces.h"
#include "tests/test_data.h"

static inline qc_mesh *read_mesh(qc_ctx *ctx, const char *name) {
    char path[TEST_DATA_PATH];
    qc_polygon_mesh *soup = NULL;
    qc_mesh *mesh = NULL;
    qc_repair_report *report = NULL;
    assert_int_equal(qc_polygon_mesh_read(ctx, test_data(name, path), &soup), QC_OK);
    assert_int_equal(qc_mesh_repair(ctx, soup, &mesh, &report), QC_OK);
    qc_object_release(soup);
    qc_object_release(report);
    return mesh;
}

#endif
