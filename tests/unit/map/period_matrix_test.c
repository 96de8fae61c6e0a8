/* The period matrix against the maps it stands for: energy, harmonicity, periods, and orthogonality
 * to the Hodge step (the same energy by two routes). */
#include "tests/unit/map/seamless.h"

static const surface_case CASES[] = {
    {"sphere", 500, 0, 0, SMOOTH},       {"sphere", 300, 0, 0.05, ROUGH},
    {"sphere", 200, 0, 0.05, ANY_TURNS}, {"torus", 500, 0, 0, MERIDIANS},
    {"torus", 400, 0, 0.05, SMOOTH},     {"flat-torus", 400, 0, 0, SMOOTH},
    {"genus", 800, 2, 0, SMOOTH},        {"genus", 600, 2, 0.05, ANY_TURNS},
    {"trinoid", 600, 0, 0, SMOOTH},      {"trinoid", 400, 0, 0.05, ANY_TURNS},
    {"hyperboloid", 400, 0, 0, SMOOTH},  {"costa", 700, 0, 0, SMOOTH},
    {"cube", 400, 0, 0, SMOOTH},         {"knot", 600, 0, 0.2, SMOOTH},
    {"knot", 500, 0, 0.2, ROUGH},
};
enum { N_CASES = (int)(sizeof CASES / sizeof *CASES) };

typedef void check(const setting *s, const qc__seams *seams, const qc__periods *periods);

static void for_all(check *body) {
    qc_ctx *ctx = context(1);
    for (int i = 0; i < N_CASES; i++)
        for (int32_t lattice = 0; lattice < 2; lattice++) {
            setting *s = setting_create(ctx, &CASES[i], 300);
            qc__seams *seams = setting_seams(s, lattice);
            qc__periods *periods = NULL;
            must(ctx, qc__periods_create(ctx, seams, s->stiffness, NULL, &periods));
            if (seams->n_free > 0) body(s, seams, periods);
            qc__periods_free(periods);
            qc__seams_free(seams);
            setting_free(s);
        }
    qc_ctx_free(ctx);
}

static double *matrix_of(const setting *s, const qc__periods *periods) {
    const int64_t n = periods->n_columns;
    double *P = ARRAY(double, n *n);
    must(s->ctx, qc__period_matrix(s->ctx, periods, P));
    return P;
}

static double *random_periods(int32_t n, uint64_t *state) {
    double *d = ARRAY(double, n);
    for (int32_t j = 0; j < n; j++) d[j] = uniform(state);
    return d;
}

/* 1/2 d^T P d. */
static double quadratic(int64_t n, const double *P, const double *d) {
    double sum = 0;
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++) sum += 0.5 * d[i] * P[i + j * n] * d[j];
    return sum;
}

/* Cholesky without pivoting; the smallest pivot in units of the diagonal. */
static double smallest_pivot(int32_t n, double *A) {
    double least = 1;
    for (int32_t k = 0; k < n; k++) {
        const double diagonal = A[k + (int64_t)k * n];
        double pivot = diagonal;
        for (int32_t j = 0; j < k; j++) pivot -= A[k + (int64_t)j * n] * A[k + (int64_t)j * n];
        least = fmin(least, pivot / diagonal);
        if (!(pivot > 0)) return least;
        A[k + (int64_t)k * n] = sqrt(pivot);
        for (int32_t i = k + 1; i < n; i++) {
            double x = A[i + (int64_t)k * n];
            for (int32_t j = 0; j < k; j++) x -= A[i + (int64_t)j * n] * A[k + (int64_t)j * n];
            A[i + (int64_t)k * n] = x / sqrt(pivot);
        }
    }
    return least;
}

static void it_is_symmetric_positive_definite(const setting *s, const qc__seams *seams,
                                              const qc__periods *periods) {
    const int32_t n = seams->n_free;
    double *P = matrix_of(s, periods);
    for (int32_t j = 0; j < n; j++)
        for (int32_t i = 0; i < j; i++) assert_true(P[i + (int64_t)j * n] == P[j + (int64_t)i * n]);
    assert_true(smallest_pivot(n, P) > 1e-10);
    free(P);
}
static void test_definite(void **state) {
    (void)state;
    for_all(it_is_symmetric_positive_definite);
}

/* W^H K f at every vertex which may move. */
static double largest_residual(const setting *s, const qc__seams *seams, const qc_complex *f,
                               double *size) {
    const qc_mesh *mesh = s->mesh;
    complex_t *r = ARRAY(complex_t, mesh->n_vertices);
    double worst = 0;
    *size = 0;
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) {
        const int32_t from = qc_next(c), to = qc_prev(c);
        const complex_t g = 0.5 * s->stiffness[c] * (qc__complex(f[to]) - qc__complex(f[from]));
        r[mesh->face_vertex[to]] += qc__turn(g, -seams->wedge_turn[seams->corner_wedge[to]]);
        r[mesh->face_vertex[from]] -= qc__turn(g, -seams->wedge_turn[seams->corner_wedge[from]]);
        *size = fmax(*size, cabs(g));
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (seams->vertex_cone[v] < 0) worst = fmax(worst, cabs(r[v]));
    free(r);
    return worst;
}

static void maps_have_their_periods_and_energy(const setting *s, const qc__seams *seams,
                                               const qc__periods *periods) {
    uint64_t state = 3;
    double *P = matrix_of(s, periods);
    for (int round = 0; round < 3; round++) {
        double *d = random_periods(seams->n_free, &state);
        complex_t *symbol = symbol_values(seams, d);
        qc_complex *f = harmonic_map(s->ctx, periods, d);
        double size = 1, flux = 0;
        for (int32_t j = 0; j < seams->n_segments + seams->n_cones; j++)
            size = fmax(size, cabs(symbol[j]));
        assert_true(seam_deviation(s, seams, symbol, f) <= 1e-11 * size);
        const double energy = energy_of(s, s->stiffness, f, NULL),
                     wanted = quadratic(seams->n_free, P, d);
        assert_true(energy > 0 && fabs(energy - wanted) <= 1e-10 * energy);
        assert_true(largest_residual(s, seams, f, &flux) <= 1e-9 * flux);
        free(f);
        free(symbol);
        free(d);
    }
    free(P);
}
static void test_maps(void **state) {
    (void)state;
    for_all(maps_have_their_periods_and_energy);
}

/* 1/2 |d(f + h) - Z|^2 = E_D + 1/2 d^T P d for the map f of the Hodge step: its periods are
 * optimal; with weights in the weighted norm. */
static int32_t stiffened;
static void periods_of_the_hodge_step_are_stationary(const setting *s, const qc__seams *seams,
                                                     const qc__periods *periods) {
    const int64_t n_corners = 3 * (int64_t)s->mesh->n_faces;
    uint64_t state = 9;
    double *P = matrix_of(s, periods);
    qc_complex *z = combed_form(s), *f = ARRAY(qc_complex, n_corners);
    const double plain = energy_of(s, s->cotangent, f, z);
    assert_true(fabs(plain - s->map->field_energy) <= 1e-11 * plain);
    const double plain_curl = energy_of(s, s->cotangent, s->map->f, z);
    assert_true(fabs(plain_curl - s->map->curl_energy) <= 1e-11 * plain);
    const double field = energy_of(s, s->stiffness, f, z);
    const double curl = energy_of(s, s->stiffness, s->map->f, z);
    if (s->map->weight) stiffened++;
    for (int round = 0; round < 3; round++) {
        double *d = random_periods(seams->n_free, &state);
        qc_complex *h = harmonic_map(s->ctx, periods, d);
        for (int64_t c = 0; c < n_corners; c++)
            f[c] = qc__pair(qc__complex(s->map->f[c]) + qc__complex(h[c]));
        free(h);
        const double together = energy_of(s, s->stiffness, f, z),
                     apart = quadratic(seams->n_free, P, d);
        assert_true(fabs(together - curl - apart) <= 1e-10 * (field + apart));
        free(d);
    }
    free(f);
    free(z);
    free(P);
}
static void test_two_routes(void **state) {
    (void)state;
    for_all(periods_of_the_hodge_step_are_stationary);
    assert_true(stiffened > 0 && stiffened < 2 * N_CASES);
}

/* Blocks of right-hand sides and threads change nothing. */
static void test_threads(void **state) {
    (void)state;
    double *P[3] = {NULL, NULL, NULL};
    int32_t n = 0;
    for (uint32_t threads = 1; threads <= 3; threads++) {
        qc_ctx *ctx = context(threads);
        setting *s = setting_create(ctx, &CASES[1], 300);
        qc__seams *seams = setting_seams(s, QC_LATTICE_QUADS);
        qc__periods *periods = NULL;
        must(ctx, qc__periods_create(ctx, seams, s->stiffness, NULL, &periods));
        n = seams->n_free;
        P[threads - 1] = matrix_of(s, periods);
        qc__periods_free(periods);
        qc__seams_free(seams);
        setting_free(s);
        qc_ctx_free(ctx);
    }
    assert_true(n > 32); /* more than one block */
    for (int i = 1; i < 3; i++)
        assert_memory_equal(P[0], P[i], sizeof(double) * (size_t)n * (size_t)n);
    for (int i = 0; i < 3; i++) free(P[i]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_definite),
        cmocka_unit_test(test_maps),
        cmocka_unit_test(test_two_routes),
        cmocka_unit_test(test_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
