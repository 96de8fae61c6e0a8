/* Boundaries which do not follow isolines: whole quads only, every hole and component kept, or an
 * error. */
#include "unit/map/maps.h"

/* Keeps the faces whose flag is set and the vertices they use. */
static void keep_faces(maps_list *l, const bool *keep) {
    int32_t kept = 0;
    for (int32_t t = 0; t < l->n_faces; t++) {
        if (!keep[t]) continue;
        memmove(l->face + 3 * kept, l->face + 3 * t, 3 * sizeof *l->face);
        memmove(l->uv + 6 * kept, l->uv + 6 * t, 6 * sizeof *l->uv);
        kept++;
    }
    l->n_faces = kept;
    int32_t *number = calloc((size_t)l->n_vertices, sizeof *number), used = 0;
    for (int32_t c = 0; c < 3 * kept; c++) number[l->face[c]] = 1;
    for (int32_t v = 0; v < l->n_vertices; v++) {
        if (!number[v]) continue;
        memmove(l->position + 3 * used, l->position + 3 * v, 3 * sizeof *l->position);
        number[v] = used++;
    }
    for (int32_t c = 0; c < 3 * kept; c++) l->face[c] = number[l->face[c]];
    l->n_vertices = used;
    free(number);
}

/* A plane of n x n cells, k x k squares in each, with rectangles of squares (x0, y0, x1, y1)
 * removed. */
static maps_list plane_with_holes(int n, int k, double angle, int n_holes, const int (*hole)[4],
                                  maps_rng *r) {
    maps_list l = maps_plane(n * k, n, n, 0, angle, 0.1 * (angle != 0), 0, r);
    bool *keep = calloc((size_t)l.n_faces, sizeof *keep);
    for (int32_t t = 0; t < l.n_faces; t++) {
        const int x = t / 2 % (n * k), y = t / 2 / (n * k);
        keep[t] = true;
        for (int i = 0; i < n_holes; i++)
            keep[t] &= x < hole[i][0] || y < hole[i][1] || x >= hole[i][2] || y >= hole[i][3];
    }
    keep_faces(&l, keep);
    free(keep);
    maps_gauge(&l, r);
    return l;
}

/* Cells which rectangular holes leave: pieces of half a cell or more without a hole inside; one
 * less where a hole would close. No two holes meet one cell. */
static int32_t cells_left(int n, int k, int n_holes, const int (*hole)[4]) {
    int32_t count = n * n;
    for (int i = 0; i < n_holes; i++) {
        bool closed = true;
        for (int x = hole[i][0] / k * k; x < hole[i][2]; x += k)
            for (int y = hole[i][1] / k * k; y < hole[i][3]; y += k) {
                const int x0 = hole[i][0] > x ? hole[i][0] - x : 0;
                const int y0 = hole[i][1] > y ? hole[i][1] - y : 0;
                const int x1 = hole[i][2] < x + k ? hole[i][2] - x : k;
                const int y1 = hole[i][3] < y + k ? hole[i][3] - y : k;
                int area = k * k - (x1 - x0) * (y1 - y0);
                if (x0 > 0 && x1 < k && y0 > 0 && y1 < k) area = 0; /* no disk */
                if (x1 - x0 == k) area = k * (y0 > k - y1 ? y0 : k - y1);
                if (y1 - y0 == k) area = k * (x0 > k - x1 ? x0 : k - x1);
                if (x1 - x0 == k && y1 - y0 == k) area = 0;
                closed &= 2 * area >= k * k;
                count -= 2 * area < k * k;
            }
        count -= closed;
    }
    return count;
}

static qc_status extract(qc_ctx *ctx, maps_list *l, int32_t faces, int32_t loops) {
    qc_corner_map *map = maps_finish(ctx, l);
    qc_grid_map *grid = NULL;
    qc_polygon_mesh *q = NULL;
    assert_int_equal(map->mesh->n_boundary_loops, loops);
    maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &grid));
    const qc_status status = qc_map_extract(ctx, grid, &q);
    if (status == QC_OK) {
        qc_polygon_topology t;
        maps_ok(ctx, qc_polygon_mesh_topology(ctx, q, &t));
        if (faces >= 0) assert_int_equal(q->n_faces, faces);
        assert_int_equal(t.boundary_loops, loops);
        assert_int_equal(t.euler, 2 - loops);
        assert_int_equal(t.components, 1);
        assert_int_equal(t.non_manifold_vertices + t.non_manifold_edges, 0);
    } else {
        assert_int_equal(status, QC_ERR_FAILED);
        assert_null(q);
    }
    qc_object_release(q);
    qc_object_release(grid);
    qc_object_release(map);
    return status;
}

static void hole_inside_a_cell_stays(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {21};
    const int holes[][4] = {{9, 13, 10, 14}, {21, 22, 23, 23}, {33, 5, 34, 7}};
    for (int n_holes = 0; n_holes <= 3; n_holes++) {
        maps_list l = plane_with_holes(10, 4, 0, n_holes, holes, &r);
        maps_ok(ctx, extract(ctx, &l, 100 - n_holes, 1 + n_holes));
    }
}

static void holes_match_the_reference(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {22};
    for (int trial = 0; trial < 40; trial++) {
        int hole[4][4];
        for (int i = 0; i < 4; i++) { /* one in each quarter, at least two cells apart */
            const int x = 24 * (i % 2), y = 24 * (i / 2);
            hole[i][0] = x + 5 + (int)(maps_random(&r) % 8);
            hole[i][1] = y + 5 + (int)(maps_random(&r) % 8);
            hole[i][2] = hole[i][0] + 1 + (int)(maps_random(&r) % 6);
            hole[i][3] = hole[i][1] + 1 + (int)(maps_random(&r) % 6);
        }
        maps_list l = plane_with_holes(12, 4, 0, 4, (const int(*)[4])hole, &r);
        maps_ok(ctx, extract(ctx, &l, cells_left(12, 4, 4, (const int(*)[4])hole), 5));
    }
}

static void turned_planes_keep_their_holes(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {23};
    const int holes[][4] = {{10, 10, 13, 15}, {32, 12, 33, 13}, {12, 30, 20, 38}, {34, 34, 35, 36}};
    for (int trial = 0; trial < 40; trial++) {
        maps_list l = plane_with_holes(16, 3, 0.1 + 3 * maps_uniform(&r), 4, holes, &r);
        maps_ok(ctx, extract(ctx, &l, -1, 5));
    }
}

static void close_holes_stay_apart(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {24};
    /* a notch which leaves more than half of a cell and a hole in the next one */
    const int outer[][4] = {{0, 17, 3, 19}, {5, 17, 6, 18}};
    maps_list l = plane_with_holes(10, 4, 0, 2, outer, &r);
    maps_ok(ctx, extract(ctx, &l, 99, 2));
    for (int trial = 0; trial < 60; trial++) { /* strips of 1.5 cells and more between holes */
        const int holes[][4] = {{10, 10, 20, 22}, {26, 12, 38, 20}, {26, 26, 40, 40}};
        l = plane_with_holes(12, 4, 3 * maps_uniform(&r), 3, holes, &r);
        maps_ok(ctx, extract(ctx, &l, -1, 4));
    }
}

static void merging_holes_are_refused(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {24};
    const int holes[][4] = {{17, 17, 19, 19}, {21, 17, 23, 19}};
    maps_list l = plane_with_holes(10, 4, 0, 2, holes, &r);
    assert_int_equal(extract(ctx, &l, -1, 3), QC_ERR_FAILED);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "the boundary loops through vertex"));
    /* of three holes the two which merge are named: the first one is far away */
    const int three[][4] = {{5, 5, 6, 6}, {17, 29, 18, 30}, {21, 29, 22, 30}};
    l = plane_with_holes(10, 4, 0, 3, three, &r);
    const int32_t n = 41 * 29 + 17; /* vertices before the second hole, none was dropped yet */
    assert_int_equal(extract(ctx, &l, -1, 4), QC_ERR_FAILED);
    assert_in_range(qc_ctx_error(ctx)->where, n - 41, n + 41);
    /* a hole next to the outer boundary */
    const int outer[][4] = {{0, 16, 4, 20}, {5, 17, 6, 18}};
    l = plane_with_holes(10, 4, 0, 2, outer, &r);
    assert_int_equal(extract(ctx, &l, -1, 2), QC_ERR_FAILED);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "the boundary loops through vertex"));
}

/* A handle whose tube is cut by a slot one cell wide; 1/12 of a cell is left. No loops merge, but a
 * handle is lost. */
static void lost_handles_are_refused(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {28};
    const double a[2] = {6, 0}, b[2] = {0, 9};
    maps_list l = maps_torus(72, a, b, 0, &r); /* 12 x 8 squares a cell */
    bool *keep = calloc((size_t)l.n_faces, sizeof *keep);
    for (int32_t t = 0; t < l.n_faces; t++) /* all but one square of the ring */
        keep[t] = t / 2 / 72 < 8 || t / 2 / 72 >= 16 || t / 2 % 72 == 71;
    keep_faces(&l, keep);
    free(keep);
    assert_int_equal(extract(ctx, &l, -1, 1), QC_ERR_FAILED);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "a neck or handle is narrower than a quad"));
}

static void narrow_necks(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {25};
    /* two slots from the sides, one cell wide, leave a neck of 1/12 of a cell */
    const int half[][4] = {{0, 24, 24, 36}, {25, 24, 60, 36}};
    maps_list l = plane_with_holes(5, 12, 0, 2, half, &r);
    assert_int_equal(extract(ctx, &l, -1, 1), QC_ERR_FAILED);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "neck narrower than a quad"));
    /* a neck of a quarter of a cell holds a quad; slots of a quarter of a cell cost none */
    const int quarter[][4] = {{0, 24, 24, 36}, {27, 24, 60, 36}};
    l = plane_with_holes(5, 12, 0, 2, quarter, &r);
    maps_ok(ctx, extract(ctx, &l, 21, 1));
    const int corner[][4] = {{0, 8, 6, 9}, {7, 0, 8, 9}};
    l = plane_with_holes(10, 4, 0, 2, corner, &r);
    maps_ok(ctx, extract(ctx, &l, 100, 1));
}

static void pinched_vertices(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {26};
    /* a slot of one cell from the side */
    const int notch[][4] = {{0, 16, 20, 20}};
    maps_list l = plane_with_holes(10, 4, 0, 1, notch, &r);
    maps_ok(ctx, extract(ctx, &l, 95, 1));
    /* both slots end near one lattice point: the quads beyond it hang on a bridge */
    const int almost[][4] = {{0, 16, 19, 19}, {21, 21, 23, 40}};
    l = plane_with_holes(10, 4, 0, 2, almost, &r);
    maps_ok(ctx, extract(ctx, &l, -1, 1));
}

static void too_small_pieces_are_refused(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {27};
    maps_list l = maps_plane(4, 0.3, 0.3, 0, 0, 0.1, 0.1, &r);
    assert_int_equal(extract(ctx, &l, -1, 1), QC_ERR_FAILED);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "smaller than a quad"));
    l = maps_plane(4, 0.8, 0.8, 0, 0, 0.1, 0.1, &r);
    maps_ok(ctx, extract(ctx, &l, 1, 1));
}

/* Strips of 1.2 to 1.8 cells in any direction, and closed ones around a square. */
static void narrow_strips_stay_whole(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {29};
    for (int trial = 0; trial < 120; trial++) {
        const double width = 1.2 + 0.6 * trial / 119;
        maps_list l = maps_plane(30, 12, width, 0.2, 3 * maps_uniform(&r), maps_uniform(&r),
                                 maps_uniform(&r), &r);
        maps_ok(ctx, extract(ctx, &l, -1, 1));
    }
    for (int trial = 0; trial < 40; trial++) {
        const int w = 12 + trial % 7, ring[][4] = {{w, w, 60 - w, 60 - w}};
        maps_list l = plane_with_holes(6, 10, 3 * maps_uniform(&r), 1, ring, &r);
        maps_ok(ctx, extract(ctx, &l, -1, 2));
    }
}

/* A square turned by 30 degrees: as many quads as its area, and its boundary is near theirs. */
static void boundary_is_followed(void **state) {
    qc_ctx *ctx = *state;
    maps_rng r = {30};
    for (int trial = 0; trial < 10; trial++) {
        maps_list l = maps_plane(24, 20, 20, 0.2, 0.5235987755982988 + 0.1 * trial,
                                 maps_uniform(&r), maps_uniform(&r), &r);
        qc_corner_map *map = maps_finish(ctx, &l);
        const qc_mesh *mesh = qc_object_retain(map->mesh);
        qc_polygon_mesh *q = maps_extract(ctx, map);
        assert_in_range(q->n_faces, 390, 410);
        qc_report *report = NULL;
        maps_ok(ctx, qc_report_create(ctx, &report));
        maps_ok(ctx, qc_report_measure(ctx, mesh, NULL, NULL, NULL, q, NULL, report));

        assert_true(report->quads.hausdorff < 0.75);
        assert_true(report->quads.min_scaled_jacobian > -0.01);
        qc_object_release(report);
        qc_object_release(q);
        qc_object_release(mesh);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hole_inside_a_cell_stays),
        cmocka_unit_test(holes_match_the_reference),
        cmocka_unit_test(turned_planes_keep_their_holes),
        cmocka_unit_test(close_holes_stay_apart),
        cmocka_unit_test(merging_holes_are_refused),
        cmocka_unit_test(lost_handles_are_refused),
        cmocka_unit_test(narrow_necks),
        cmocka_unit_test(pinched_vertices),
        cmocka_unit_test(too_small_pieces_are_refused),
        cmocka_unit_test(narrow_strips_stay_whole),
        cmocka_unit_test(boundary_is_followed),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
