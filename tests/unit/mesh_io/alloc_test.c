/* When the n-th allocation fails, reading and repair answer NOMEM and free everything, for every n.
 */
#include "unit/mesh_io/common.h"
#include "unit/mesh_io/cube.h"
#include "unit/mesh_io/rich.h"

static int budget, live;
static void *resize(void *user, void *p, size_t old_size, size_t new_size) {
    (void)user, (void)old_size;
    if (new_size == 0) {
        live -= p != NULL;
        free(p);
        return NULL;
    }
    if (budget-- <= 0) return NULL;
    live += p == NULL;
    return realloc(p, new_size);
}

static qc_status run(qc_ctx *ctx, const void *data, size_t size, const char *name) {
    qc_polygon_mesh *soup = NULL;
    qc_mesh *mesh = NULL;
    qc_repair_report *report = NULL;
    qc_status status = parse_bytes(ctx, data, size, name, &soup);
    if (status == QC_OK) status = qc_mesh_repair(ctx, soup, &mesh, &report);
    if (status != QC_OK) {
        assert_null(mesh);
        assert_null(report);
    }
    qc_object_release(soup);
    qc_object_release(mesh);
    qc_object_release(report);
    return status;
}

static void fail_each(const void *data, size_t size, const char *name) {
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.resize = resize;
    options.threads = 1;
    for (int n = 0;; n++) {
        qc_ctx *ctx = NULL;
        budget = 1 << 20;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        int before = live;
        budget = n;
        qc_status status = run(ctx, data, size, name);
        assert_int_equal(live, before);
        if (status != QC_OK) {
            assert_int_equal(status, QC_ERR_NOMEM);
            assert_int_equal(qc_ctx_error(ctx)->status, QC_ERR_NOMEM);
        }
        qc_ctx_free(ctx);
        assert_int_equal(live, 0);
        if (status == QC_OK) break;
        assert_true(n < 1000);
    }
}

static void test_formats(void **state) {
    (void)state;
    for (int format = 0; format < CUBE_FORMATS; format++) {
        bytes b;
        cube_bytes(format, &b);
        fail_each(b.data, b.n, CUBE_NAME[format]);
    }
    fail_each(RICH_PLY, sizeof RICH_PLY - 1, "rich.ply");
}

static void test_repairs(void **state) {
    (void)state;
    /* polygons, groups, texture coordinates, lines, a seam, a fin, a needle */
    const char *text =
        "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 1 2\nv 1 0 -1\nv 1 -1 -2\nv 0 -1 "
        "-2\nv 2 -1 -2\nv 1 1 2\n"
        "vt 0 0\nvn 0 0 1\ng a\ng b\nf 4/1/1 3/1 2/1 1/1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf "
        "1 2 6\nf 6 2 7\nf 1 6 7\n"
        "f 1 7 8\nf 2 9 7\nl 1 2 3\nf 4 10 1\n";
    fail_each(text, strlen(text), "a.obj");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_formats),
                                       cmocka_unit_test(test_repairs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
