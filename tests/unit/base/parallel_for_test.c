/* Fixed chunks: every index once, the same bits for any number of threads, nested loops serial. */
#include "tests/unit/base/base_test.h"
#include <math.h>
#include <stdatomic.h>

enum { N = 10007, CHUNK = 64, CHUNKS = (N + CHUNK - 1) / CHUNK };

typedef struct job {
    qc_ctx *ctx;
    double sum[CHUNKS]; /* one partial sum per chunk */
    atomic_int seen[N];
    atomic_int bad;
} job;

static void body(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    job *j = arg;
    if (worker >= qc_ctx_threads(j->ctx) || begin % CHUNK != 0 || end - begin > CHUNK)
        atomic_fetch_add(&j->bad, 1);
    double sum = 0;
    for (int64_t i = begin; i < end; i++) {
        sum += sin((double)i) * 1e-3;
        atomic_fetch_add(&j->seen[i], 1);
    }
    j->sum[begin / CHUNK] = sum;
}

static double run(uint32_t threads, int64_t n) {
    counter c;
    qc_ctx *ctx = counting_context(&c, threads);
    job *j = calloc(1, sizeof *j);
    j->ctx = ctx;
    for (int round = 1; round <= 20; round++) {
        qc__parallel_for(ctx, n, CHUNK, body, j);
        for (int64_t i = 0; i < N; i++)
            assert_int_equal(atomic_load(&j->seen[i]), i < n ? round : 0);
    }
    assert_int_equal(atomic_load(&j->bad), 0);
    double sum = 0;
    for (int i = 0; i < CHUNKS; i++) sum += j->sum[i];
    free(j);
    free_counting_context(ctx, &c);
    return sum;
}

static void thread_count_never_changes_a_bit(void **state) {
    (void)state;
    const int64_t sizes[] = {0, 1, CHUNK, CHUNK + 1, N};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        const double one = run(1, sizes[k]);
        assert_true(run(2, sizes[k]) == one && run(4, sizes[k]) == one && run(16, sizes[k]) == one);
    }
}

typedef struct nest {
    qc_ctx *ctx;
    atomic_int inner[100];
} nest;

static void inner_body(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    (void)worker;
    atomic_fetch_add((atomic_int *)arg, (int)(end - begin));
}

static void outer_body(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    nest *n = arg;
    (void)worker;
    for (int64_t i = begin; i < end; i++) qc__parallel_for(n->ctx, 50, 7, inner_body, &n->inner[i]);
}

static void nested_loops_do_all_their_work(void **state) {
    (void)state;
    for (uint32_t threads = 1; threads <= 4; threads += 3) {
        counter c;
        nest n = {.ctx = counting_context(&c, threads)};
        qc__parallel_for(n.ctx, 100, 3, outer_body, &n);
        for (int i = 0; i < 100; i++) assert_int_equal(atomic_load(&n.inner[i]), 50);
        free_counting_context(n.ctx, &c);
    }
}

static void without_memory_for_threads_the_loop_runs_serially(void **state) {
    (void)state;
    for (int64_t allowed = 0; allowed < 4; allowed++) {
        counter c;
        qc_ctx *ctx = counting_context(&c, 4);
        job *j = calloc(1, sizeof *j);
        j->ctx = ctx;
        c.allowed = allowed;
        qc__parallel_for(ctx, N, CHUNK, body, j);
        for (int64_t i = 0; i < N; i++) assert_int_equal(atomic_load(&j->seen[i]), 1);
        assert_int_equal(qc_ctx_error(ctx)->status, QC_OK);
        free(j);
        free_counting_context(ctx, &c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thread_count_never_changes_a_bit),
        cmocka_unit_test(nested_loops_do_all_their_work),
        cmocka_unit_test(without_memory_for_threads_the_loop_runs_serially),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
