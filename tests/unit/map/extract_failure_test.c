/* Extraction when memory runs out, when cancelled, and with wrong arguments. */
#include "unit/map/maps.h"

typedef struct host {
    int64_t allocations, fail_at; /* the fail_at-th allocation fails; 0 = none */
    int64_t blocks, polls, cancel_at;
    double fraction;
} host;

static void *resize(void *user, void *p, size_t old_size, size_t new_size) {
    host *h = user;
    (void)old_size;
    if (new_size == 0) {
        h->blocks -= p != NULL;
        free(p);
        return NULL;
    }
    if (++h->allocations == h->fail_at) return NULL;
    void *q = realloc(p, new_size);
    h->blocks += !p && q;
    return q;
}

static bool progress(void *user, const char *stage, double fraction) {
    host *h = user;
    (void)stage;
    assert_true(fraction >= 0 && fraction <= 1);
    h->fraction = fraction;
    return ++h->polls != h->cancel_at;
}

static qc_ctx *context(host *h) {
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx = NULL;
    options.threads = 1;
    options.resize = resize;
    options.progress = progress;
    options.user = h;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    return ctx;
}

/* Everything from polygons to quads. */
static qc_status whole(qc_ctx *ctx, const qc_polygon_mesh *soup) {
    qc_corner_map *map = NULL, *back = NULL;
    qc_grid_map *grid = NULL;
    qc_polygon_mesh *quads = NULL, *polygons = NULL;
    qc_status status = qc_corner_map_from_polygons(ctx, soup, &map);
    if (status == QC_OK) status = qc_grid_map_create(ctx, map, 0, &grid);
    if (status == QC_OK) status = qc_grid_map_to_corner_map(ctx, grid, map, &back);
    if (status == QC_OK) status = qc_corner_map_to_polygons(ctx, back, &polygons);
    if (status == QC_OK) status = qc_map_extract(ctx, grid, &quads);
    assert_true((status == QC_OK) == (quads != NULL));
    qc_object_release(quads);
    qc_object_release(polygons);
    qc_object_release(back);
    qc_object_release(grid);
    qc_object_release(map);
    return status;
}

static qc_polygon_mesh *soup(bool closed) {
    qc_ctx *ctx = maps_context();
    maps_rng r = {31};
    static const uint8_t one[1] = {1};
    maps_list l =
        closed ? maps_voxels(1, one, 3, 2, 0.2, &r) : maps_plane(5, 4.5, 4.5, 0.2, 0.3, 0, 0, &r);
    qc_corner_map *map = maps_finish(ctx, &l);
    qc_polygon_mesh *p = NULL;
    maps_ok(ctx, qc_corner_map_to_polygons(ctx, map, &p));
    qc_object_release(map);
    qc_ctx_free(ctx);
    return p;
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    for (int closed = 0; closed < 2; closed++) {
        qc_polygon_mesh *p = soup(closed);
        qc_status status = QC_ERR_NOMEM;
        for (int64_t n = 2; status != QC_OK; n++) { /* the first one is the context */
            host h = {.fail_at = n};
            qc_ctx *ctx = context(&h);
            status = whole(ctx, p);
            assert_true(status == QC_OK || status == QC_ERR_NOMEM);
            if (status != QC_OK) assert_int_equal(qc_ctx_error(ctx)->status, status);
            qc_ctx_free(ctx);
            assert_int_equal(h.blocks, 0);
            assert_true(n < 1000);
        }
        qc_object_release(p);
    }
}

static void every_poll_may_cancel(void **state) {
    (void)state;
    for (int closed = 0; closed < 2; closed++) {
        qc_polygon_mesh *p = soup(closed);
        qc_status status = QC_ERR_CANCELLED;
        int64_t n = 1;
        for (; status != QC_OK; n++) {
            host h = {.cancel_at = n};
            qc_ctx *ctx = context(&h);
            status = whole(ctx, p);
            assert_true(status == QC_OK || status == QC_ERR_CANCELLED);
            qc_ctx_free(ctx);
            assert_int_equal(h.blocks, 0);
        }
        assert_true(n > 8);
        qc_object_release(p);
    }
}

static void wrong_arguments_are_refused(void **state) {
    (void)state;
    qc_ctx *ctx = maps_context();
    qc_polygon_mesh *p = soup(true), *quads = NULL;
    qc_corner_map *map = NULL;
    qc_grid_map *grid = NULL;
    maps_ok(ctx, qc_corner_map_from_polygons(ctx, p, &map));
    assert_int_equal(qc_grid_map_create(ctx, NULL, 0, &grid), QC_ERR_ARGUMENT);
    assert_int_equal(qc_grid_map_create(ctx, map, 0.5, &grid), QC_ERR_ARGUMENT);
    assert_int_equal(qc_grid_map_create(ctx, map, NAN, &grid), QC_ERR_ARGUMENT);
    assert_int_equal(qc_map_extract(ctx, NULL, &quads), QC_ERR_ARGUMENT);
    assert_int_equal(qc_grid_map_to_corner_map(ctx, NULL, NULL, &map), QC_ERR_ARGUMENT);
    qc_object_release(map);
    qc_object_release(p);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(every_poll_may_cancel),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
