/* Corner maps: creation, polygon meshes with one vt a corner and back. */
#include "unit/map/maps.h"

static void round_trip_keeps_everything(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {1};
    const uint8_t voxel[1] = {1};
    maps_list l = maps_voxels(1, voxel, 3, 2, 0.2, &r);
    qc_corner_map *map = maps_finish(ctx, &l), *back = NULL;
    qc_polygon_mesh *polygons = NULL;
    maps_ok(ctx, qc_corner_map_to_polygons(ctx, map, &polygons));
    maps_ok(ctx, qc_corner_map_from_polygons(ctx, polygons, &back));
    const qc_mesh *m = map->mesh;
    assert_int_equal(back->mesh->n_vertices, m->n_vertices);
    assert_memory_equal(back->uv, map->uv, 6 * sizeof(double) * (size_t)m->n_faces);
    assert_memory_equal(back->mesh->face_vertex, m->face_vertex,
                        3 * sizeof(int32_t) * (size_t)m->n_faces);
    assert_memory_equal(back->mesh->position, m->position,
                        3 * sizeof(double) * (size_t)m->n_vertices);
    /* six charts with (3+1)^2 points each; equal values at a cube corner may be shared */
    assert_in_range(polygons->n_uvs, 6 * 16 - 12 * 4, 6 * 16);
    qc_object_release(polygons);
    qc_object_release(map);
    qc_object_release(back);
}

static void unused_vertices_are_dropped(void **state) {
    qc_ctx *ctx = *state;
    qc_polygon_mesh *p = NULL;
    qc_corner_map *map = NULL;
    maps_ok(ctx, qc_polygon_mesh_create(ctx, 5, 1, 3, 3, 0, 0, &p));
    for (int k = 0; k < 3; k++) {
        p->face_vertex[k] = k + 1;
        p->corner_uv[k] = k;
        p->position[3 * (k + 1)] = k;
        p->position[3 * (k + 1) + 1] = k == 2;
        p->uv[2 * k] = k;
    }
    p->face_offset[1] = 3;
    maps_ok(ctx, qc_corner_map_from_polygons(ctx, p, &map));
    assert_int_equal(map->mesh->n_vertices, 3);
    assert_int_equal(map->mesh->source_vertex[0], 1);
    qc_object_release(map);
    p->corner_uv[1] = -1;
    assert_int_equal(qc_corner_map_from_polygons(ctx, p, &map), QC_ERR_INPUT);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "face 0 has no texture coordinate"));
    qc_object_release(p);
}

static void unusable_values_are_refused(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {1};
    maps_list l = maps_plane(2, 2, 2, 0, 0, 0, 0, &r);
    qc_mesh *mesh = NULL;
    qc_corner_map *map = NULL;
    maps_ok(ctx, qc_mesh_create(ctx, l.n_vertices, l.position, l.n_faces, l.face, &mesh));
    assert_int_equal(qc_corner_map_create(ctx, NULL, l.uv, 0, NULL, &map), QC_ERR_ARGUMENT);
    assert_int_equal(qc_corner_map_create(ctx, mesh, l.uv, -1, NULL, &map), QC_ERR_ARGUMENT);
    l.uv[6 * 3 + 2] = NAN;
    assert_int_equal(qc_corner_map_create(ctx, mesh, l.uv, 0, NULL, &map), QC_ERR_ARGUMENT);
    assert_int_equal(qc_ctx_error(ctx)->where, 3);
    assert_null(map);
    qc_object_release(mesh);
    maps_list_free(&l);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip_keeps_everything),
        cmocka_unit_test(unused_vertices_are_dropped),
        cmocka_unit_test(unusable_values_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
