/* Out of memory at any allocation, and cancellation: the status says so, outputs are untouched,
 * nothing leaks. */
#include "unit/dec/forms.h"

typedef struct limits {
    int64_t allocations, fail_at, live;
    int64_t progress, cancel_at;
} limits;

static void *limited_resize(void *user, void *p, size_t old_size, size_t new_size) {
    limits *l = user;
    (void)old_size;
    if (new_size == 0) {
        l->live -= p != NULL;
        free(p);
        return NULL;
    }
    if (l->fail_at >= 0 && l->allocations++ >= l->fail_at) return NULL;
    l->live += p == NULL;
    return realloc(p, new_size);
}

static bool limited_progress(void *user, const char *stage, double fraction) {
    limits *l = user;
    (void)stage, (void)fraction;
    return l->cancel_at < 0 || l->progress++ < l->cancel_at;
}

enum { CALLS = 5 };

/* One call of the module; *touched tells whether an output changed. */
static qc_status call(qc_ctx *ctx, int which, const qc_cover *cover, const double *cot,
                      const qc_complex *z, bool *touched) {
    const qc_mesh *m = cover->mesh;
    qc_complex *out = NEW_ARRAY(qc_complex, 3 * m->n_faces), *v = NEW_ARRAY(qc_complex, m->n_edges);
    qc_complex *basis = NULL;
    int32_t count = -1, *below = NULL;
    qc_mesh *q = NULL;
    qc_stiffness *s = NULL;
    double energy = -1;
    qc_status status = QC_OK;
    if (which == 0) status = qc_hodge_remove_curl(ctx, cover, cot, NULL, z, out, v, &energy);
    if (which == 1)
        status = qc_hodge_decompose(ctx, cover, QC_HODGE_NONCONFORMING, z, out, NULL, NULL);
    if (which == 2) status = qc_hodge_harmonic_basis(ctx, m, &count, &basis);
    if (which == 3) status = qc_cover_mesh(ctx, cover, &q, &below);
    if (which == 4) status = qc_stiffness_vertices(ctx, cover, cot, NULL, &s);
    *touched = largest(3 * m->n_faces, out) > 0 || largest(m->n_edges, v) > 0 || energy != -1 ||
               count != -1 || basis || q || below || s;
    qc_cover_free_array(basis);
    qc_cover_free_array(below);
    qc_object_release(q);
    qc_stiffness_free(s);
    free(out), free(v);
    return status;
}

static void sweep(bool memory) {
    limits l = {0, -1, 0, 0, -1};
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.threads = 1;
    options.resize = limited_resize;
    options.progress = limited_progress;
    options.user = &l;
    qc_ctx *ctx = NULL;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    qc_mesh *m = build_surface(ctx, &SURFACES[1], 1);
    int8_t *matching = random_matching(m, DENSE);
    const qc_cover cover = {m, matching};
    double *cot = cotangents(ctx, m);
    qc_complex *z = random_form(m);
    for (int which = 0; which < CALLS; which++) {
        bool touched = false;
        qc_status status = QC_ERR_FAILED;
        for (int64_t n = 0; status != QC_OK; n++) {
            assert_true(n < 1000);
            const int64_t live = l.live;
            l.allocations = l.progress = 0;
            l.fail_at = memory ? n : -1;
            l.cancel_at = memory ? -1 : n;
            status = call(ctx, which, &cover, cot, z, &touched);
            l.fail_at = l.cancel_at = -1;
            assert_int_equal(l.live, live);
            if (status == QC_OK) break;
            assert_int_equal(status, memory ? QC_ERR_NOMEM : QC_ERR_CANCELLED);
            assert_int_equal(qc_ctx_error(ctx)->status, status);
            assert_false(touched);
        }
        assert_true(touched);
    }
    free(matching), free(cot), free(z);
    qc_object_release(m);
    qc_ctx_free(ctx);
    assert_int_equal(l.live, 0);
}

static void test_memory(void **state) {
    (void)state, sweep(true);
}
static void test_cancel(void **state) {
    (void)state, sweep(false);
}

/* A face without area whose corners coincide has no stiffness: the vertex or edge is named. */
static void test_singular(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    qc_mesh *m = build_surface(ctx, &SURFACES[0], 1);
    int8_t *matching = random_matching(m, DENSE);
    const qc_cover cover = {m, matching};
    double *cot = NEW_ARRAY(double, 3 * m->n_faces), energy = -1;
    qc_complex *z = random_form(m);
    assert_int_equal(qc_hodge_remove_curl(ctx, &cover, cot, NULL, z, z, NULL, &energy),
                     QC_ERR_NOT_POSDEF);
    assert_in_range(qc_ctx_error(ctx)->where, 0, m->n_edges - 1);
    assert_true(strstr(qc_ctx_error(ctx)->text, "edge") != NULL && energy == -1);
    free(matching), free(cot), free(z);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_memory), cmocka_unit_test(test_cancel),
                                       cmocka_unit_test(test_singular)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
