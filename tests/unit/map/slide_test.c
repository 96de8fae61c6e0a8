/* Untangling with features: vertices slide along their isolines, corners and cones stay. */
#include "unit/map/aligned.h"

static qc_corner_map *surface(qc_ctx *ctx, int which, maps_rng *r) {
    static const uint8_t shape[27] = {1, 1, 1, 1, 0, 1, 1, 1, 1};
    maps_list l;
    switch (which) {
    case 0:
        l = maps_plane(8, 8, 8, 0.2, 0, 0, 0, r);
        return maps_finish_aligned(ctx, &l, 8, r);
    case 1:
        l = maps_cylinder(10, 9, 7, 0.2, r);
        return maps_finish_aligned(ctx, &l, 7, r);
    case 2:
        l = maps_voxels(3, shape, 5, 3, 0.2, r);
        return maps_finish_aligned(ctx, &l, 3, r);
    default:
        l = maps_fan(which, which % 2, 5, 4, 0.2, r);
        return maps_finish_aligned(ctx, &l, 4, r);
    }
}
enum { N_SURFACES = 9 };

/* Transitions, features and everything pinned are as before. */
static void assert_same_frame(qc_ctx *ctx, const qc_grid_map *a, const qc_grid_map *b) {
    const qc_mesh *mesh = a->mesh;
    qc__reduced_map *m = NULL, *n = NULL;
    double *uv[2];
    assert_int_equal(a->bits, b->bits);
    assert_memory_equal(a->rotation, b->rotation, (size_t)mesh->n_edges);
    assert_memory_equal(a->axis, b->axis, (size_t)mesh->n_edges);
    assert_memory_equal(a->translation, b->translation,
                        2 * sizeof(int32_t) * (size_t)mesh->n_edges);
    for (int i = 0; i < 2; i++) {
        uv[i] = malloc(6 * sizeof(double) * (size_t)mesh->n_faces);
        for (int32_t k = 0; k < 6 * mesh->n_faces; k++)
            uv[i][k] = ldexp((i ? b : a)->uv[k], -a->bits);
    }
    maps_ok(ctx, qc__reduced_map_create(ctx, a, uv[0], true, &m));
    maps_ok(ctx, qc__reduced_map_create(ctx, b, uv[1], true, &n));
    int fixed = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        assert_int_equal(m->fixed[v], n->fixed[v]);
        fixed += m->fixed[v] != 0;
        if (m->fixed[v] & 1) assert_true(m->value[v].re == n->value[v].re);
        if (m->fixed[v] & 2) assert_true(m->value[v].im == n->value[v].im);
    }
    assert_true(fixed > 0);
    qc__reduced_map_free(m);
    qc__reduced_map_free(n);
    free(uv[0]);
    free(uv[1]);
}

static void thrown_maps_are_untangled_along_features(void **state) {
    qc_ctx *ctx = *state;
    for (int which = 0; which < N_SURFACES; which++)
        for (uint64_t seed = 1; seed <= 4; seed++) {
            maps_rng r = {seed};
            qc_corner_map *map = surface(ctx, which, &r), *out = NULL;
            qc_corner_map *bad = maps_thrown(ctx, map, 2.0, &r);
            qc_grid_map *start = NULL, *before = NULL, *after = NULL;
            qc_polygon_mesh *q = NULL;
            maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &start));
            maps_ok(ctx, qc_grid_map_create(ctx, bad, 0, &before));
            assert_true(before->n_flipped > map->mesh->n_faces / 5);
            maps_ok(ctx, qc_map_untangle(ctx, bad, NULL, &out));
            maps_ok(ctx, qc_grid_map_create(ctx, out, 0, &after));
            if (after->n_flipped + after->n_degenerate > 0)
                fail_msg("surface %d, seed %d: %d of %d flips left", which, (int)seed,
                         (int)after->n_flipped, (int)before->n_flipped);
            assert_same_frame(ctx, start, after);
            maps_ok(ctx, qc_map_extract(ctx, after, &q));
            assert_true(q->n_lines > 0);
            qc_object_release(q);
            qc_object_release(after);
            qc_object_release(before);
            qc_object_release(start);
            qc_object_release(out);
            qc_object_release(bad);
            qc_object_release(map);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thrown_maps_are_untangled_along_features),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
