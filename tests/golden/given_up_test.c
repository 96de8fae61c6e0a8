/* Features which leave no room for quads are given up and named; all others are chains of quad
 * edges.
 */
#include "kept.h"

/* A disk of rings of triangles with strokes along spokes: the ends are points of the numbers given.
 */
enum { SPOKES = 72, RINGS = 10 };
static int32_t on_spoke(int32_t spoke, int32_t ring) {
    return ring == 0 ? 0 : 1 + (ring - 1) * SPOKES + spoke % SPOKES;
}

static qc_polygon_mesh *disk(qc_ctx *ctx, int n_strokes, const int32_t (*stroke)[2]) {
    const int32_t n_faces = SPOKES * (2 * RINGS - 1);
    int32_t n_lines = 0, f = 0, l = 0;
    qc_polygon_mesh *soup = NULL;
    for (int i = 0; i < n_strokes; i++) n_lines += stroke[i][1];
    assert_int_equal(
        qc_polygon_mesh_create(ctx, 1 + SPOKES * RINGS, n_faces, 3 * n_faces, 0, n_lines, 0, &soup),
        QC_OK);
    for (int32_t r = 1; r <= RINGS; r++)
        for (int32_t s = 0; s < SPOKES; s++) {
            const double angle = 2 * 3.14159265358979323846 * s / SPOKES;
            const int32_t v = on_spoke(s, r), w = on_spoke(s + 1, r);
            const int32_t a = on_spoke(s, r - 1), b = on_spoke(s + 1, r - 1);
            soup->position[3 * v] = r * cos(angle);
            soup->position[3 * v + 1] = r * sin(angle);
            memcpy(soup->face_vertex + 3 * f++, (int32_t[]){a, v, w}, 3 * sizeof v);
            if (r > 1) memcpy(soup->face_vertex + 3 * f++, (int32_t[]){a, w, b}, 3 * sizeof v);
        }
    for (f = 0; f <= n_faces; f++) soup->face_offset[f] = 3 * f;
    for (int i = 0; i < n_strokes; i++)
        for (int32_t r = 0; r < stroke[i][1]; r++) {
            soup->line[l++] = on_spoke(stroke[i][0], r);
            soup->line[l++] = on_spoke(stroke[i][0], r + 1);
        }
    return soup;
}

/* Of two strokes which meet in 5 degrees the shorter one is named, the others are kept. */
static void strokes_without_room_are_named(void **state) {
    (void)state;
    static const int32_t stroke[][2] = {{0, 7}, {1, 5}, {18, 7}};
    qc_ctx *ctx = begin(0);
    qc_polygon_mesh *soup = disk(ctx, 3, stroke);
    char text[64];
    remesh(ctx, "disk", soup, 1000);
    check_features("disk");
    golden_equal("disk", "edges of features", run_seen.last->n_feature_edges, SPOKES + 7 + 7);
    golden_equal("disk", "warnings", run_seen.n_warnings, 1);
    snprintf(text, sizeof text, "feature from vertex 0 to vertex %d, of length 5, dropped",
             (int)on_spoke(1, 5));
    assert_non_null(strstr(run_seen.warning[0], text));
    assert_non_null(strstr(run_seen.warning[0], "at vertex 0 it meets another one in 5 degrees"));
    end(ctx, soup);
}

/* Whether a warning names a chain by its ends, in numbers of the input, and its angle. */
static int is_named(const qc_mesh *mesh, const qc_feature_chain *chain) {
    const int32_t *source = mesh->source_vertex;
    const int32_t from = source ? source[chain->end[0]] : chain->end[0];
    const int32_t to = source ? source[chain->end[1]] : chain->end[1];
    for (int i = 0; i < run_seen.n_warnings; i++) {
        int a, b;
        double length, angle;
        if (sscanf(run_seen.warning[i],
                   "crease from vertex %d to vertex %d, %lf quads long, %lf degrees, is no edge",
                   &a, &b, &length, &angle) == 4 &&
            a == from && b == to && length > 0 &&
            fabs(angle - chain->angle * 57.29577951308232) < 0.6)
            return 1;
    }
    return 0;
}

/* Where quads are refused features go one by one: those which are gone are named, all others kept.
 */
static void features_given_up_are_named(void **state) {
    (void)state;
    qc_ctx *ctx = begin(4);
    qc_polygon_mesh *soup = shape(ctx, "cube", 1000);
    remesh(ctx, "cube", soup, 300);
    const qc_features *first = run_seen.first, *last = run_seen.last;
    const size_t n_edges = (size_t)first->mesh->n_edges;
    int32_t n = 0, gone = 0, *of = malloc(n_edges * sizeof *of);
    qc_feature_chain *chain = malloc(n_edges * sizeof *chain);
    check_features("cube");
    assert_int_equal(qc_features_chains(ctx, first->mesh, first->edge, of, &n), QC_OK);
    assert_int_equal(qc_features_measure_chains(ctx, first->mesh, first->edge, chain), QC_OK);
    golden_equal("cube", "features", n, 12);
    for (int32_t i = 0; i < n; i++) {
        int32_t left = 0;
        for (size_t e = 0; e < n_edges; e++) left += of[e] == i && last->edge[e];
        assert_true(left == 0 || left == chain[i].n_edges);
        golden_equal("cube", "features which are gone and named", is_named(first->mesh, &chain[i]),
                     left == 0);
        gone += left == 0;
    }
    assert_in_range(gone, 1, 3);
    free(chain);
    free(of);
    end(ctx, soup);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strokes_without_room_are_named),
        cmocka_unit_test(features_given_up_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
