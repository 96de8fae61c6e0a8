/* Unfolding of seamless maps: maps folded on purpose, in their vertices and in their translations
 * and levels, become injective and stay seamless; good maps are not touched; bytes do not depend on
 * threads; cancelling and failing allocations leave the map as it was. */
#include "sdk/map/periods/align.h"
#include "sdk/map/periods/frame_form.h"
#include "sdk/map/periods/unfold.h"
#include "tests/unit/map/hard_features.h"
#include "tests/unit/mesh/failing_allocator.h"

static const surface_case SURFACES[] = {
    {"sphere", 300, 0, 0, SMOOTH},
    {"genus", 600, 2, 0, SMOOTH},
    {"torus", 300, 0, 0, MERIDIANS},
    {"trinoid", 300, 0, 0, SMOOTH},
};
static const aligned_case ALIGNED[] = {
    {"plate", NULL, 9, false, false, 4, 4, 2, 1},
    {"ring", NULL, 12, true, false, 8, 8, 8, 1},
    {"cube", "cube", 600, false, false, 8, 12, -1, 1},
    {"hyperboloid", "hyperboloid", 600, false, true, 0, 2, 2, 1},
    {"torus", "torus", 600, false, true, 0, 1, 3, 1},
};
enum { N_SURFACES = 4, N_ALIGNED = 5, N_CASES = N_SURFACES + N_ALIGNED };

typedef struct fixture {
    setting *s;
    qc__seams *seams;
    qc__periods *periods;
    qc__features features;
    double *P, *y;
    qc_complex *f, *z;
} fixture;

static void open_fixture(fixture *k, qc_ctx *ctx, int i) {
    setting *s = i < N_SURFACES ? setting_create(ctx, &SURFACES[i], 300)
                                : aligned_setting(ctx, &ALIGNED[i - N_SURFACES], 300);
    const int64_t n_corners = 3 * (int64_t)s->mesh->n_faces;
    k->s = s;
    k->seams = setting_seams(s, QC_LATTICE_QUADS);
    k->features = (qc__features){&s->cover, s->map->face_turn, s->matching->axis};
    const int64_t n = k->seams->n_free;
    must(ctx, qc__periods_create(ctx, k->seams, s->stiffness, NULL, &k->periods));
    k->P = ARRAY(double, n *n);
    k->y = ARRAY(double, n);
    k->f = ARRAY(qc_complex, n_corners);
    k->z = ARRAY(qc_complex, n_corners);
    must(ctx, qc__period_matrix(ctx, k->periods, k->P));
    must(ctx, qc__frame_form(ctx, s->matching, s->sizing, k->z));
    for (int64_t c = 0; c < n_corners; c++)
        k->z[c] = qc_quarter_turn(k->z[c], s->map->face_turn[c / 3]);
    memcpy(k->f, s->map->f, sizeof *k->f * (size_t)n_corners);
    must(ctx, qc__seams_read(ctx, k->seams, k->f, k->y));
    must(ctx, qc__align(ctx, k->periods, k->P, k->z, k->f, k->y));
}
static void close_fixture(fixture *k) {
    qc__periods_free(k->periods);
    qc__seams_free(k->seams);
    free(k->P);
    free(k->y);
    free(k->f);
    free(k->z);
    setting_free(k->s);
}

static int32_t folded_faces(const fixture *k) {
    int32_t n = 0;
    for (int32_t t = 0; t < k->s->mesh->n_faces; t++) {
        const complex_t a = qc__complex(k->f[3 * t + 1]) - qc__complex(k->f[3 * t]);
        const complex_t b = qc__complex(k->f[3 * t + 2]) - qc__complex(k->f[3 * t]);
        n += cimag(conj(a) * b) <= 0;
    }
    return n;
}

/* Image angle about an interior vertex in quarter turns. */
static double quarter_turns(const fixture *k, int32_t v) {
    const qc_mesh *mesh = k->s->mesh;
    const int32_t start = mesh->vertex_corner[v];
    double angle = 0;
    int32_t c = start;
    do {
        const complex_t p = qc__complex(k->f[c]);
        angle += carg((qc__complex(k->f[qc_prev(c)]) - p) / (qc__complex(k->f[qc_next(c)]) - p));
        c = qc_corner_ccw(mesh, c);
    } while (c != start);
    return angle / 1.57079632679489662;
}

/* Adds noise of the size of `far` units to F and y. */
static void fold(fixture *k, double far, uint64_t seed) {
    const qc__seams *s = k->seams;
    double *symbol = ARRAY(double, qc__seams_symbols(s));
    complex_t *wedge = ARRAY(complex_t, s->n_wedges), *F = ARRAY(complex_t, s->mesh->n_vertices);
    qc__periods_split(s, k->f, wedge, F);
    for (int32_t v = 0; v < s->mesh->n_vertices; v++)
        F[v] += (qc__seams_is_given(s, v, 0) ? 0 : far * uniform(&seed)) +
                (qc__seams_is_given(s, v, 1) ? 0 : far * uniform(&seed)) * I;
    for (int32_t j = 0; j < s->n_free; j++) k->y[j] += far * uniform(&seed);
    qc__seams_symbol_values(s, k->y, symbol);
    qc__seams_wedge_values(s, symbol, wedge);
    qc__periods_corners(s, wedge, F, k->f);
    free(symbol);
    free(wedge);
    free(F);
}

static qc_status unfold(qc_ctx *ctx, fixture *k, qc__unfolding *result) {
    return qc__unfold(ctx, k->periods, k->P, &k->features, k->z, k->f, k->y, result);
}

static void assert_injective(const fixture *k) {
    const qc_mesh *mesh = k->s->mesh;
    assert_int_equal(folded_faces(k), 0);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (!qc_vertex_on_boundary(mesh, v))
            assert_true(fabs(quarter_turns(k, v) - (4 - k->s->matching->index4[v])) < 1e-6);
    for (int32_t h = 0; h < 3 * mesh->n_faces; h++) {
        if (!qc__is_feature(&k->features, h)) continue;
        const complex_t way = qc__complex(k->f[qc_prev(h)]) - qc__complex(k->f[qc_next(h)]);
        const complex_t along = qc__turn(way, -qc__feature_direction(&k->features, h));
        assert_true(creal(along) > 0 && fabs(cimag(along)) < 1e-9);
    }
    complex_t *symbol = symbol_values(k->seams, k->y);
    assert_true(seam_deviation(k->s, k->seams, symbol, k->f) < 1e-9);
    free(symbol);
}

static void test_folded_maps(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++)
        for (uint64_t seed = 1; seed < 4; seed++) {
            fixture k = {0};
            qc__unfolding result = {0};
            open_fixture(&k, ctx, i);
            fold(&k, 0.8 * (double)seed, seed);
            const int32_t before = folded_faces(&k);
            assert_true(before > 0);
            must(ctx, unfold(ctx, &k, &result));
            assert_int_equal(result.folded_before, before);
            if (result.folded + result.wrong > 0)
                fail_msg("case %d seed %d: %d folded, %d wrong after %d evaluations", i, (int)seed,
                         (int)result.folded, (int)result.wrong, (int)result.evaluations);
            assert_injective(&k);
            close_fixture(&k);
        }
    qc_ctx_free(ctx);
}

static void on_all_cases(void (*property)(qc_ctx *ctx, fixture *k)) {
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++) {
        fixture k = {0};
        open_fixture(&k, ctx, i);
        property(ctx, &k);
        close_fixture(&k);
    }
    qc_ctx_free(ctx);
}

static void stays(qc_ctx *ctx, fixture *k) {
    qc__unfolding result = {0};
    const size_t size = sizeof *k->f * 3 * (size_t)k->s->mesh->n_faces;
    assert_injective(k);
    qc_complex *f = ARRAY(qc_complex, 3 * (int64_t)k->s->mesh->n_faces);
    memcpy(f, k->f, size);
    must(ctx, unfold(ctx, k, &result));
    assert_int_equal(result.evaluations, 0);
    assert_memory_equal(f, k->f, size);
    free(f);
}

static void test_good_maps_stay(void **state) {
    (void)state;
    on_all_cases(stays);
}

static void keeps_periods(qc_ctx *ctx, fixture *k) {
    qc__unfolding result = {0};
    double *y = ARRAY(double, k->seams->n_free);
    memcpy(y, k->y, sizeof *y * (size_t)k->seams->n_free);
    fold(k, 0.5, 2);
    for (int32_t j = 0; j < k->seams->n_free; j++) k->y[j] = y[j];
    fold(k, 0, 0);
    free(k->P);
    k->P = NULL;
    must(ctx, unfold(ctx, k, &result));
    assert_int_equal(result.folded + result.wrong, 0);
    assert_injective(k);
    assert_memory_equal(y, k->y, sizeof *y * (size_t)k->seams->n_free);
    free(y);
}

/* Without a period matrix the periods stay. */
static void test_fixed_periods(void **state) {
    (void)state;
    on_all_cases(keeps_periods);
}

static void test_threads(void **state) {
    (void)state;
    qc_complex *first = NULL;
    for (uint32_t threads = 1; threads <= 4; threads += 3) {
        qc_ctx *ctx = context(threads);
        fixture k = {0};
        qc__unfolding result = {0};
        open_fixture(&k, ctx, 6);
        fold(&k, 1, 5);
        must(ctx, unfold(ctx, &k, &result));
        const size_t size = sizeof *k.f * 3 * (size_t)k.s->mesh->n_faces;
        if (!first) {
            first = ARRAY(qc_complex, 3 * (int64_t)k.s->mesh->n_faces);
            memcpy(first, k.f, size);
        } else {
            assert_memory_equal(first, k.f, size);
        }
        close_fixture(&k);
        qc_ctx_free(ctx);
    }
    free(first);
}

/* Unfolds a copy; a failure leaves it as it was. */
static qc_status unfold_copy(qc_ctx *ctx, const void *data) {
    fixture k = *(const fixture *)data;
    const size_t size = sizeof *k.f * 3 * (size_t)k.s->mesh->n_faces;
    const size_t y_size = sizeof *k.y * (size_t)k.seams->n_free;
    qc__unfolding result = {0};
    k.f = ARRAY(qc_complex, 3 * (int64_t)k.s->mesh->n_faces);
    k.y = ARRAY(double, k.seams->n_free);
    memcpy(k.f, ((const fixture *)data)->f, size);
    memcpy(k.y, ((const fixture *)data)->y, y_size);
    const qc_status status = unfold(ctx, &k, &result);
    if (status != QC_OK) {
        assert_memory_equal(k.f, ((const fixture *)data)->f, size);
        assert_memory_equal(k.y, ((const fixture *)data)->y, y_size);
    } else {
        assert_injective(&k);
    }
    free(k.f);
    free(k.y);
    return status;
}

static bool refuse(void *user, const char *stage, double fraction) {
    int *left = user;
    (void)stage;
    (void)fraction;
    return --*left > 0;
}

static void test_failures(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    fixture k = {0};
    open_fixture(&k, ctx, N_SURFACES);
    fold(&k, 1.6, 2);
    fail_every_allocation(unfold_copy, &k);
    for (int calls = 1; calls < 4; calls++) {
        int left = calls;
        qc_ctx *stopped = NULL;
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = 1;
        options.progress = refuse;
        options.user = &left;
        assert_int_equal(qc_ctx_create(&options, &stopped), QC_OK);
        assert_int_equal(unfold_copy(stopped, &k), QC_ERR_CANCELLED);
        qc_ctx_free(stopped);
    }
    close_fixture(&k);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_folded_maps),   cmocka_unit_test(test_good_maps_stay),
        cmocka_unit_test(test_fixed_periods), cmocka_unit_test(test_threads),
        cmocka_unit_test(test_failures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
