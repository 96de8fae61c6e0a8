/* The tables of the plugin answer as the built-in ones, also far from the origin and in other
 * units. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include <qc/qc.h>

typedef struct fixture {
    qc_ctx *ctx;
    qc_registry *registry;
    const qc_closest_point *closest;
    const qc_ray_caster *casts;
} fixture;

static int setup(void **state) {
    fixture *f = calloc(1, sizeof *f);
    const qc_interface *closest = NULL, *casts = NULL;
    *state = f;
    if (qc_ctx_create(NULL, &f->ctx) || qc_registry_create(f->ctx, &f->registry)) return 1;
    if (qc_registry_load(f->registry, QC_EMBREE) ||
        qc_registry_find_interface(f->registry, QC_CLOSEST_POINT_ID, "embree", &closest) ||
        qc_registry_find_interface(f->registry, QC_RAY_CASTER_ID, "embree", &casts)) {
        print_error("%s\n", qc_ctx_error(f->ctx)->text);
        return 1;
    }
    f->closest = (const qc_closest_point *)closest;
    f->casts = (const qc_ray_caster *)casts;
    return 0;
}

static int teardown(void **state) {
    fixture *f = *state;
    qc_registry_free(f->registry);
    qc_ctx_free(f->ctx);
    free(f);
    return 0;
}

static double unit(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (1 << 24);
}

/* A surface of genus 3, scaled and moved, as a list with two degenerate triangles. */
typedef struct surface {
    int32_t n, *vertex;
    double *position, size, centre[3];
} surface;

static surface make(qc_ctx *ctx, double scale, double shift) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    qc_mesh *mesh = NULL;
    options.resolution = 3000;
    options.genus = 3;
    assert_int_equal(qc_shape_create(ctx, "genus", &options, &mesh), QC_OK);
    surface s = {.n = mesh->n_faces + 2, .size = scale * mesh->diagonal};
    const size_t n = (size_t)mesh->n_vertices;
    s.vertex = malloc(3 * (size_t)s.n * sizeof *s.vertex);
    s.position = malloc(3 * n * sizeof *s.position);
    const int32_t degenerate[6] = {0, 1, 1, 2, 2, 2};
    memcpy(s.vertex, degenerate, sizeof degenerate);
    memcpy(s.vertex + 6, mesh->face_vertex, 3 * (size_t)mesh->n_faces * sizeof(int32_t));
    for (size_t i = 0; i < 3 * n; i++) {
        s.position[i] = scale * mesh->position[i] + shift;
        s.centre[i % 3] += s.position[i] / (double)n;
    }
    qc_object_release(mesh);
    return s;
}

static void compare_distances(const fixture *f, const surface *s, double reach, uint32_t *seed) {
    const qc_closest_point *tables[2] = {&qc_closest_point_builtin, f->closest};
    qc_closest_tree *tree[2];
    for (int k = 0; k < 2; k++)
        assert_int_equal(
            tables[k]->build(tables[k], f->ctx, s->n, s->position, s->vertex, &tree[k]), QC_OK);
    for (int i = 0; i < 400; i++) {
        double p[3], weight[2][3], d[2];
        for (int k = 0; k < 3; k++) p[k] = s->centre[k] + reach * s->size * (2 * unit(seed) - 1);
        if (i % 4 == 0) memcpy(p, s->position + 3 * s->vertex[3 * i], sizeof p);
        for (int k = 0; k < 2; k++) {
            int32_t triangle = (7 * i) % s->n;
            d[k] = tables[k]->query(tree[k], p, &triangle, weight[k]);
            double at[3] = {0, 0, 0};
            for (int c = 0; c < 9; c++)
                at[c % 3] +=
                    weight[k][c / 3] * s->position[3 * s->vertex[3 * triangle + c / 3] + c % 3];
            const double far = hypot(hypot(at[0] - p[0], at[1] - p[1]), at[2] - p[2]);
            assert_true(fabs(far - d[k]) <= 1e-9 * s->size);
        }
        assert_true(fabs(d[0] - d[1]) <= 1e-9 * s->size);
    }
    for (int k = 0; k < 2; k++) tables[k]->destroy(tree[k]);
}

static void compare_rays(const fixture *f, const surface *s, double reach, uint32_t *seed) {
    const qc_ray_caster *tables[2] = {&qc_ray_caster_builtin, f->casts};
    qc_ray_scene *scene[2];
    int hits = 0;
    for (int k = 0; k < 2; k++)
        assert_int_equal(
            tables[k]->build(tables[k], f->ctx, s->n, s->position, s->vertex, &scene[k]), QC_OK);
    for (int i = 0; i < 800; i++) {
        double o[3], d[3], weight[2][3] = {{0}}, t[2];
        int32_t triangle[2];
        for (int k = 0; k < 3; k++) {
            o[k] = s->centre[k] + reach * s->size * (2 * unit(seed) - 1);
            d[k] = s->centre[k] - o[k] + 0.4 * s->size * (2 * unit(seed) - 1);
        }
        if (i % 4 == 0) /* exactly at a vertex, where several triangles are equally near */
            for (int k = 0; k < 3; k++) d[k] = s->position[3 * s->vertex[3 * i] + k] - o[k];
        if (i % 7 == 0) d[i % 3] = 0;
        for (int k = 0; k < 2; k++)
            t[k] = tables[k]->query(scene[k], o, d, &triangle[k], weight[k]);
        assert_int_equal(triangle[0], triangle[1]);
        assert_true(triangle[0] < 0 ? isinf(t[0]) && isinf(t[1]) : fabs(t[0] - t[1]) <= 1e-9);
        for (int k = 0; k < 3 && triangle[0] >= 0; k++)
            assert_true(fabs(weight[0][k] - weight[1][k]) <= 1e-9);
        hits += triangle[0] >= 0;
    }
    assert_in_range(hits, 100, 799);
    for (int k = 0; k < 2; k++) tables[k]->destroy(scene[k]);
}

static void both_give_the_same_answers(void **state) {
    const fixture *f = *state;
    uint32_t seed = 11;
    const double scale[] = {1, 1e6, 1e-6, 1}, shift[] = {0, 0, 0, 1000};
    for (int i = 0; i < 4; i++) {
        surface s = make(f->ctx, scale[i], shift[i]);
        for (double reach = 0.5; reach < 1000; reach *= 30) {
            compare_distances(f, &s, reach, &seed);
            compare_rays(f, &s, reach, &seed);
        }
        free(s.vertex);
        free(s.position);
    }
}

static void one_triangle_and_one_point(void **state) {
    const fixture *f = *state;
    const double x[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const int32_t whole[3] = {0, 1, 2}, point[3] = {1, 1, 1};
    const double p[3] = {3, 0, 0}, up[3] = {0, 0, 2}, o[3] = {0.25, 0.25, -1};
    double weight[3];
    int32_t triangle = 0;
    qc_closest_tree *tree = NULL;
    assert_int_equal(f->closest->build(f->closest, f->ctx, 1, x, point, &tree), QC_OK);
    assert_true(fabs(f->closest->query(tree, p, &triangle, weight) - 2) < 1e-12);
    f->closest->destroy(tree);
    qc_ray_scene *scene = NULL;
    assert_int_equal(f->casts->build(f->casts, f->ctx, 1, x, whole, &scene), QC_OK);
    assert_true(fabs(f->casts->query(scene, o, up, &triangle, weight) - 0.5) < 1e-12);
    assert_int_equal(triangle, 0);
    assert_true(isinf(f->casts->query(scene, p, up, &triangle, weight)));
    assert_int_equal(triangle, -1);
    assert_true(isinf(f->casts->query(scene, o, x, &triangle, weight)));
    f->casts->destroy(scene);
    f->casts->destroy(NULL);
    f->closest->destroy(NULL);
}

static bool never(void *user, const char *stage, double fraction) {
    (void)user, (void)stage, (void)fraction;
    return false;
}

static void building_can_be_cancelled(void **state) {
    const fixture *f = *state;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.progress = never;
    qc_ctx *ctx = NULL;
    qc_closest_tree *tree = NULL;
    const double x[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const int32_t vertex[3] = {0, 1, 2};
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    assert_int_equal(f->closest->build(f->closest, ctx, 1, x, vertex, &tree), QC_ERR_CANCELLED);
    assert_null(tree);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_give_the_same_answers),
        cmocka_unit_test(one_triangle_and_one_point),
        cmocka_unit_test(building_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
