/* Stage qc.check.opensubdiv on cages whose limit surface is known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <cmocka.h>
#include <plugins/opensubdiv/qc_opensubdiv.h>
#include <qc/qc.h>

typedef struct fixture {
    qc_ctx *ctx;
    qc_registry *registry;
} fixture;

static int setup(void **state) {
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    if (qc_ctx_create(NULL, &f->ctx) || qc_registry_create(f->ctx, &f->registry)) return 1;
    if (qc_registry_load(f->registry, QC_OPENSUBDIV) == QC_OK) return 0;
    print_error("%s\n", qc_ctx_error(f->ctx)->text);
    return 1;
}

static int teardown(void **state) {
    fixture *f = *state;
    qc_registry_free(f->registry);
    qc_ctx_free(f->ctx);
    free(f);
    return 0;
}

static qc_polygon_mesh *polygons(qc_ctx *ctx, int32_t n_vertices, const double *x, int32_t n_faces,
                                 const int32_t *vertex, int32_t n_lines, const int32_t *line) {
    qc_polygon_mesh *m = NULL;
    assert_int_equal(
        qc_polygon_mesh_create(ctx, n_vertices, n_faces, 4 * n_faces, 0, n_lines, 0, &m), QC_OK);
    memcpy(m->position, x, 3 * (size_t)n_vertices * sizeof *x);
    memcpy(m->face_vertex, vertex, 4 * (size_t)n_faces * sizeof *vertex);
    if (n_lines > 0) memcpy(m->line, line, 2 * (size_t)n_lines * sizeof *line);
    for (int32_t f = 0; f <= n_faces; f++) m->face_offset[f] = 4 * f;
    return m;
}

static const double cube_position[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                         0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
static const int32_t cube_face[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4,
                                      1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
static const int32_t cube_edge[26] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6,
                                      7, 7, 4, 0, 4, 1, 5, 2, 6, 3, 7, 0, 6};

/* n x m quads: a flat unit square, or a torus of revolution with radii 2 and 1. */
static qc_polygon_mesh *grid(qc_ctx *ctx, int32_t n, int32_t m, bool torus) {
    const int32_t nv = torus ? n : n + 1, mv = torus ? m : m + 1;
    double *x = malloc(3 * (size_t)(nv * mv) * sizeof *x);
    int32_t *face = malloc(4 * (size_t)(n * m) * sizeof *face);
    for (int32_t i = 0; i < nv; i++)
        for (int32_t j = 0; j < mv; j++) {
            const double a = 2 * acos(-1.0) * i / n, b = 2 * acos(-1.0) * j / m;
            double *p = x + 3 * (i * mv + j);
            p[0] = torus ? (2 + cos(b)) * cos(a) : (double)i / n;
            p[1] = torus ? (2 + cos(b)) * sin(a) : (double)j / m;
            p[2] = torus ? sin(b) : 0;
        }
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < m; j++) {
            const int32_t i1 = (i + 1) % nv, j1 = (j + 1) % mv;
            const int32_t quad[4] = {i * mv + j, i1 * mv + j, i1 * mv + j1, i * mv + j1};
            memcpy(face + 4 * (i * m + j), quad, sizeof quad);
        }
    qc_polygon_mesh *result = polygons(ctx, nv * mv, x, n * m, face, 0, NULL);
    free(x);
    free(face);
    return result;
}

/* Quads cut along a diagonal. */
static qc_mesh *triangles(qc_ctx *ctx, const qc_polygon_mesh *q) {
    int32_t *vertex = malloc(6 * (size_t)q->n_faces * sizeof *vertex);
    for (int32_t f = 0; f < q->n_faces; f++) {
        const int32_t *v = q->face_vertex + 4 * f;
        const int32_t two[6] = {v[0], v[1], v[2], v[0], v[2], v[3]};
        memcpy(vertex + 6 * f, two, sizeof two);
    }
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create(ctx, q->n_vertices, q->position, 2 * q->n_faces, vertex, &mesh),
                     QC_OK);
    free(vertex);
    return mesh;
}

/* Runs the stage with settings "name=value", up to a NULL; consumes cage and mesh (may be NULL).
 * The bag has the outputs. */
static qc_status run(const fixture *f, qc_polygon_mesh *cage, qc_mesh *mesh, qc_bag **bag, ...) {
    qc_pipeline *pipeline = NULL;
    const char *name;
    va_list settings;
    assert_int_equal(qc_bag_create(f->ctx, bag), QC_OK);
    assert_int_equal(qc_bag_put(*bag, "cage", cage), QC_OK);
    if (mesh) assert_int_equal(qc_bag_put(*bag, "mesh", mesh), QC_OK);
    qc_object_release(cage);
    qc_object_release(mesh);
    assert_int_equal(qc_pipeline_create(f->registry, &pipeline), QC_OK);
    assert_int_equal(qc_pipeline_insert(pipeline, 0, "check", "check.opensubdiv"), QC_OK);
    va_start(settings, bag);
    while ((name = va_arg(settings, const char *)) != NULL)
        assert_int_equal(qc_pipeline_set(pipeline, "check", name, va_arg(settings, const char *)),
                         QC_OK);
    va_end(settings);
    const qc_status status = qc_pipeline_run(pipeline, *bag);
    qc_pipeline_free(pipeline);
    return status;
}

static const qc_subdivision_report *report_of(const qc_bag *bag) {
    return qc_bag_get(bag, "check.report");
}

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static void a_cube_has_eight_vertices_of_valence_three(void **state) {
    const fixture *f = *state;
    qc_bag *bag = NULL;
    qc_polygon_mesh *cube = polygons(f->ctx, 8, cube_position, 6, cube_face, 0, NULL);
    assert_int_equal(run(f, cube, NULL, &bag, "levels", "1", "output", "refined", NULL), QC_OK);
    const qc_subdivision_report *r = report_of(bag);
    assert_int_equal(r->valence[3], 8);
    assert_int_equal(r->n_extraordinary, 8);
    assert_int_equal(r->spacing, 1);
    assert_near(r->mean_spacing, 1, 0);
    assert_int_equal(r->n_crowded, 6);
    assert_int_equal(r->n_samples, 26);
    const qc_polygon_mesh *refined = qc_bag_get(bag, "check.quads");
    assert_int_equal(refined->n_vertices, 26);
    assert_int_equal(refined->n_faces, 24);
    /* Vertex rule, valence 3: (F + 2 E) / 3 with means of face points and edge midpoints. */
    assert_near(refined->position[0], 2.0 / 9, 1e-12);
    qc_bag_free(bag);
}

static void creases_keep_a_cube(void **state) {
    const fixture *f = *state;
    qc_bag *bag = NULL;
    /* The last line is a diagonal: no edge, no crease. */
    qc_polygon_mesh *cube = polygons(f->ctx, 8, cube_position, 6, cube_face, 13, cube_edge);
    qc_mesh *mesh = triangles(f->ctx, cube);
    assert_int_equal(run(f, cube, mesh, &bag, "levels", "2", NULL), QC_OK);
    const qc_subdivision_report *r = report_of(bag);
    assert_int_equal(r->n_creases, 12);
    assert_near(r->vertex_distance, 0, 1e-12);
    assert_near(r->distance, 0, 1e-12);
    assert_near(r->jacobian, 1, 1e-12);
    assert_near(r->normal_deviation, 0, 1e-6); /* no normal on the creases */
    assert_int_equal(r->n_reversed, 0);
    qc_bag_free(bag);
}

static void a_regular_grid_is_its_own_limit(void **state) {
    const fixture *f = *state;
    qc_bag *bag = NULL;
    qc_polygon_mesh *square = grid(f->ctx, 5, 5, false);
    qc_mesh *mesh = triangles(f->ctx, square);
    assert_int_equal(run(f, square, mesh, &bag, NULL), QC_OK);
    const qc_subdivision_report *r = report_of(bag);
    assert_int_equal(r->n_extraordinary, 0);
    assert_int_equal(r->n_boundary_extraordinary, 0);
    assert_int_equal(r->valence[4], 16);
    assert_int_equal(r->spacing, 0);
    assert_near(r->distance, 0, 1e-12);
    assert_near(r->vertex_distance, 0, 1e-12);
    assert_near(r->jacobian, 1, 1e-12);
    assert_near(r->normal_deviation, 0, 1e-6);
    qc_bag_free(bag);
}

/* One vertex raised by 1: the bicubic B-spline there is (4/6)^2. */
static void a_bump_is_a_spline(void **state) {
    const fixture *f = *state;
    qc_bag *bag = NULL;
    qc_polygon_mesh *square = grid(f->ctx, 6, 6, false);
    const int32_t middle = 3 * 7 + 3;
    square->position[3 * middle + 2] = 1;
    assert_int_equal(run(f, square, NULL, &bag, "levels", "3", "output", "limit", NULL), QC_OK);
    assert_near(report_of(bag)->vertex_distance, 5.0 / 9, 1e-12);
    const qc_polygon_mesh *limit = qc_bag_get(bag, "check.quads");
    assert_near(limit->position[3 * middle + 2], 4.0 / 9, 1e-12);
    qc_bag_free(bag);
}

static void a_reversed_surface_is_seen(void **state) {
    const fixture *f = *state;
    qc_bag *bag = NULL;
    qc_polygon_mesh *cage = grid(f->ctx, 4, 4, false), *other = grid(f->ctx, 4, 4, false);
    for (int32_t i = 0; i < 16; i++) {
        int32_t *v = other->face_vertex + 4 * i, second = v[1];
        v[1] = v[3];
        v[3] = second;
    }
    qc_mesh *mesh = triangles(f->ctx, other);
    qc_object_release(other);
    assert_int_equal(run(f, cage, mesh, &bag, NULL), QC_OK);
    assert_near(report_of(bag)->jacobian, -1, 1e-12);
    assert_int_equal(report_of(bag)->n_reversed, report_of(bag)->n_samples);
    qc_bag_free(bag);
}

static void the_fit_brings_the_limit_surface_to_the_input(void **state) {
    const fixture *f = *state;
    qc_bag *bag = NULL;
    qc_polygon_mesh *fine = grid(f->ctx, 240, 120, true);
    qc_mesh *mesh = triangles(f->ctx, fine);
    qc_object_release(fine);
    assert_int_equal(run(f, grid(f->ctx, 16, 8, true), mesh, &bag, "fit", "true", NULL), QC_OK);
    const qc_subdivision_report *r = report_of(bag);
    assert_int_equal(r->valence[4], 128);
    assert_int_equal(r->rounds, 10);
    print_message("fit: distance %.3g -> %.3g, mean %.3g -> %.3g, vertices %.3g -> %.3g\n",
                  r->distance_before, r->distance, r->mean_distance_before, r->mean_distance,
                  r->vertex_distance_before, r->vertex_distance);
    assert_true(r->vertex_distance_before > 0.1);
    assert_true(r->vertex_distance < 0.02 * r->vertex_distance_before);
    assert_true(r->distance < 0.01 * r->distance_before);
    assert_true(r->mean_distance < 0.01 * r->mean_distance_before);
    assert_true(r->jacobian > 0.95);
    qc_bag_free(bag);
}

static void cages_which_are_no_surface_are_named(void **state) {
    const fixture *f = *state;
    qc_bag *bag = NULL;
    int32_t face[24];
    memcpy(face, cube_face, sizeof face);
    memcpy(face + 20, cube_face, 4 * sizeof *face); /* the bottom twice, an open side */
    qc_polygon_mesh *bad = polygons(f->ctx, 8, cube_position, 6, face, 0, NULL);
    assert_int_equal(run(f, bad, NULL, &bag, NULL), QC_ERR_INPUT);
    const qc_error *error = qc_ctx_error(f->ctx);
    assert_non_null(strstr(error->text, "not a manifold cage"));
    assert_true(error->where >= 0);
    assert_string_equal(error->stage, "check");
    assert_null(qc_bag_get(bag, "check.quads"));
    qc_bag_free(bag);

    bad = polygons(f->ctx, 8, cube_position, 0, face, 0, NULL);
    assert_int_equal(run(f, bad, NULL, &bag, NULL), QC_ERR_INPUT);
    qc_bag_free(bag);

    bad = polygons(f->ctx, 8, cube_position, 6, cube_face, 0, NULL);
    assert_int_equal(run(f, bad, NULL, &bag, "fit", "true", NULL), QC_ERR_ARGUMENT);
    qc_bag_free(bag);
}

/* std::bad_alloc inside OpenSubdiv is an error of the stage. */
static void running_out_of_memory_is_an_error(void **state) {
    const fixture *f = *state;
    qc_bag *bag = NULL;
    struct rlimit before, tight;
#ifdef __SANITIZE_ADDRESS__
    skip(); /* needs more address space than there is */
#endif
    qc_polygon_mesh *square = grid(f->ctx, 100, 100, false);
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    tight = before;
    tight.rlim_cur = 1 << 28;
    assert_int_equal(setrlimit(RLIMIT_AS, &tight), 0);
    const qc_status status = run(f, square, NULL, &bag, "levels", "6", NULL);
    assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
    assert_int_equal(status, QC_ERR_NOMEM);
    assert_non_null(strstr(qc_ctx_error(f->ctx)->text, "out of memory"));
    assert_null(qc_bag_get(bag, "check.quads"));
    qc_bag_free(bag);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_has_eight_vertices_of_valence_three),
        cmocka_unit_test(creases_keep_a_cube),
        cmocka_unit_test(a_regular_grid_is_its_own_limit),
        cmocka_unit_test(a_bump_is_a_spline),
        cmocka_unit_test(a_reversed_surface_is_seen),
        cmocka_unit_test(the_fit_brings_the_limit_surface_to_the_input),
        cmocka_unit_test(cages_which_are_no_surface_are_named),
        cmocka_unit_test(running_out_of_memory_is_an_error),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
