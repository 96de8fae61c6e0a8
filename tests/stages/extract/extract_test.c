/* The stage qc.extract: its ports, its parameter and its errors. */
#include <qc/pipeline.h>

#include "unit/map/maps.h"

extern const qc_stage qc_stage_extract;

static qc_bag *bag_with(qc_ctx *ctx, qc_corner_map *map) {
    qc_bag *bag = NULL;
    maps_ok(ctx, qc_bag_create(ctx, &bag));
    maps_ok(ctx, qc_bag_put(bag, "map", map));
    qc_object_release(map);
    return bag;
}

static qc_corner_map *cube(qc_ctx *ctx) {
    maps_rng r = {41};
    static const uint8_t one[1] = {1};
    maps_list l = maps_voxels(1, one, 4, 3, 0.2, &r);
    return maps_finish(ctx, &l);
}

static void quads_come_out(void **state) {
    (void)state;
    qc_ctx *ctx = maps_context();
    qc_bag *bag = bag_with(ctx, cube(ctx));
    maps_ok(ctx, qc_stage_run(ctx, &qc_stage_extract, NULL, bag));
    const qc_polygon_mesh *quads = qc_bag_get(bag, "quads");
    assert_non_null(quads);
    assert_int_equal(quads->n_faces, 54);
    assert_non_null(quads->source_face);
    qc_bag_free(bag);
    qc_ctx_free(ctx);
}

static void fold_overs_are_named(void **state) {
    (void)state;
    qc_ctx *ctx = maps_context();
    maps_rng r = {42};
    maps_list l = maps_plane(6, 4, 4, 0, 0, 0, 0, &r);
    for (int32_t c = 0; c < 3 * l.n_faces; c++)
        if (l.face[c] == 3 * 7 + 3) l.uv[2 * c] += 1.9;
    qc_bag *bag = bag_with(ctx, maps_finish(ctx, &l));
    assert_int_equal(qc_stage_run(ctx, &qc_stage_extract, NULL, bag), QC_ERR_FAILED);
    const char *text = qc_ctx_error(ctx)->text;
    assert_non_null(strstr(text, "map folds over at"));
    assert_non_null(strstr(text, "(first: face "));
    assert_non_null(strstr(text, "qc.untangle"));
    assert_null(qc_bag_get(bag, "quads"));
    qc_bag_free(bag);
    qc_ctx_free(ctx);
}

static void tolerance_is_a_parameter(void **state) {
    (void)state;
    qc_ctx *ctx = maps_context();
    struct {
        double tolerance;
    } params = {0.05};
    qc_corner_map *map = cube(ctx);
    ((double *)(uintptr_t)map->uv)[2 * 40] += 0.06;
    qc_bag *bag = bag_with(ctx, map);
    assert_int_equal(qc_stage_run(ctx, &qc_stage_extract, &params, bag), QC_ERR_FAILED);
    params.tolerance = 0.1;
    maps_ok(ctx, qc_stage_run(ctx, &qc_stage_extract, &params, bag));
    qc_bag_free(bag);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quads_come_out),
        cmocka_unit_test(fold_overs_are_named),
        cmocka_unit_test(tolerance_is_a_parameter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
