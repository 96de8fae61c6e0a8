/* Rounding by quantization: integer-seamless maps on surfaces of genus 0 to 5, with as many quads
 * as asked for where rounding alone would make more; the same bytes on any number of threads. */
#include "tests/unit/map/hard_features.h"

static const surface_case CASES[] = {
    {"sphere", 600, 0, 0, SMOOTH},    {"cube", 600, 0, 0, SMOOTH},
    {"ellipsoid", 600, 0, 0, SMOOTH}, {"torus", 600, 0, 0.05, SMOOTH},
    {"torus", 600, 0, 0, MERIDIANS},  {"knot", 800, 0, 0, SMOOTH},
    {"genus", 900, 2, 0, SMOOTH},     {"genus", 900, 3, 0, SMOOTH},
    {"genus", 1200, 4, 0, SMOOTH},    {"genus", 1500, 5, 0, SMOOTH},
};
enum { N_CASES = (int)(sizeof CASES / sizeof *CASES) };

static qc_corner_map *quantized(const setting *s) {
    qc_round_options options = QC_ROUND_OPTIONS_INIT;
    qc_corner_map *map = NULL;
    options.quantize = QC_QUANTIZE_ALWAYS;
    must(s->ctx, qc_map_round(s->ctx, s->map, &options, &map));
    return map;
}

static void periods_are_integers(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++)
        for (double quads = 60; quads < 3000; quads *= 6) {
            setting *s = setting_create(ctx, &CASES[i], quads);
            qc_corner_map *map = quantized(s);
            qc_grid_map *grid = NULL;
            must(ctx, qc_grid_map_create(ctx, map, 1e-9, &grid));
            const double made = map_area(map);
            assert_true(fabs(made - rint(made)) < 1e-8 * made);
            assert_true(fabs(made / quads - 1) < (quads > 1000 ? 0.1 : 0.5));
            qc_object_release(grid);
            qc_object_release(map);
            setting_free(s);
        }
    qc_ctx_free(ctx);
}

static void threads_do_not_matter(void **state) {
    (void)state;
    const surface_case c = {"genus", 900, 2, 0, SMOOTH};
    double *first = NULL;
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        qc_ctx *ctx = context(threads);
        setting *s = setting_create(ctx, &c, 200);
        qc_corner_map *map = quantized(s);
        const size_t bytes = sizeof(double) * 6 * (size_t)map->mesh->n_faces;
        if (!first) {
            first = malloc(bytes);
            memcpy(first, map->uv, bytes);
        }
        assert_memory_equal(first, map->uv, bytes);
        qc_object_release(map);
        setting_free(s);
        qc_ctx_free(ctx);
    }
    free(first);
}

/* Levels of features are integers, on a box, a plate and a torus. */
static void features_stay_on_isolines(void **state) {
    (void)state;
    static const aligned_case cases[] = {
        {"box", "cube", 600, false, false, 8, 12, 0, 1},
        {"plate", NULL, 12, true, false, 8, 8, 0, 1},
        {"circle", "torus", 800, false, true, 0, 1, 0, 1},
    };
    qc_ctx *ctx = context(1);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (double quads = 30; quads < 2000; quads *= 7) {
            setting *s = aligned_setting(ctx, &cases[i], quads);
            qc_corner_map *map = quantized(s);
            qc_grid_map *grid = NULL;
            must(ctx, qc_grid_map_create(ctx, map, 1e-9, &grid));
            assert_non_null(grid->axis);
            qc_object_release(grid);
            qc_object_release(map);
            setting_free(s);
        }
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(periods_are_integers),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(features_stay_on_isolines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
