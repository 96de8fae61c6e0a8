/* What the machine can do at most: multiply-adds in registers, zgemm of the sizes of fronts, and
 * x <- a x + b streaming through the second-level cache and through memory. The best of several
 * short runs each. */
#include "bench.h"

#include <cblas.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define X86 1
#endif

const int32_t bench_zgemm_size[3] = {8, 32, 128};

enum { CHAINS = 12, RUNS = 7 }; /* independent accumulators hide the latency of an FMA */

typedef struct isa {
    int32_t width;            /* doubles of a vector                       */
    double (*fma)(int64_t n); /* n times CHAINS vector operations          */
    void (*stream)(int64_t n, double *x);
} isa;

static double fma_portable(int64_t n) {
    double a[CHAINS] = {0}, sum = 0;
    for (int64_t i = 0; i < n; i++)
        for (int c = 0; c < CHAINS; c++) a[c] = a[c] * 0.999 + 0.001;
    for (int c = 0; c < CHAINS; c++) sum += a[c];
    return sum;
}
static void stream_portable(int64_t n, double *x) {
    for (int64_t i = 0; i < n; i++) x[i] = x[i] * 0.999 + 0.001;
}
static const isa portable = {1, fma_portable, stream_portable};

#ifdef X86
__attribute__((target("avx2,fma"))) static double fma_avx2(int64_t n) {
    const __m256d f = _mm256_set1_pd(0.999), g = _mm256_set1_pd(0.001);
    __m256d a[CHAINS], sum = _mm256_setzero_pd();
    for (int c = 0; c < CHAINS; c++) a[c] = g;
    for (int64_t i = 0; i < n; i++)
        for (int c = 0; c < CHAINS; c++) a[c] = _mm256_fmadd_pd(a[c], f, g);
    for (int c = 0; c < CHAINS; c++) sum = _mm256_add_pd(sum, a[c]);
    return _mm256_cvtsd_f64(sum);
}
__attribute__((target("avx2,fma"))) static void stream_avx2(int64_t n, double *x) {
    const __m256d f = _mm256_set1_pd(0.999), g = _mm256_set1_pd(0.001);
    for (int64_t i = 0; i + 4 <= n; i += 4)
        _mm256_storeu_pd(x + i, _mm256_fmadd_pd(_mm256_loadu_pd(x + i), f, g));
}
static const isa avx2 = {4, fma_avx2, stream_avx2};

__attribute__((target("avx512f"))) static double fma_avx512(int64_t n) {
    const __m512d f = _mm512_set1_pd(0.999), g = _mm512_set1_pd(0.001);
    __m512d a[CHAINS], sum = _mm512_setzero_pd();
    for (int c = 0; c < CHAINS; c++) a[c] = g;
    for (int64_t i = 0; i < n; i++)
        for (int c = 0; c < CHAINS; c++) a[c] = _mm512_fmadd_pd(a[c], f, g);
    for (int c = 0; c < CHAINS; c++) sum = _mm512_add_pd(sum, a[c]);
    return _mm512_reduce_add_pd(sum);
}
__attribute__((target("avx512f"))) static void stream_avx512(int64_t n, double *x) {
    const __m512d f = _mm512_set1_pd(0.999), g = _mm512_set1_pd(0.001);
    for (int64_t i = 0; i + 8 <= n; i += 8)
        _mm512_storeu_pd(x + i, _mm512_fmadd_pd(_mm512_loadu_pd(x + i), f, g));
}
static const isa avx512 = {8, fma_avx512, stream_avx512};
#endif

static const isa *widest(void) {
#ifdef X86
    if (__builtin_cpu_supports("avx512f")) return &avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return &avx2;
#endif
    return &portable;
}

static double fma_peak(const isa *k) {
    const int64_t n = 400000;
    double best = 0;
    for (int run = 0; run < RUNS; run++) {
        const bench_duration begin = bench_clock();
        if (!(k->fma(n) > 0))
            bench_die("the multiply-adds came out wrong"); /* a use of the result */
        const double t = bench_clock().cpu - begin.cpu;
        best = fmax(best, 2.0 * CHAINS * k->width * (double)n / t);
    }
    return best;
}

static double zgemm_peak(int32_t n) {
    const int64_t repeats = 1 + 20000000 / (8LL * n * n * n);
    const double one[2] = {1, 0}, zero[2] = {0, 0};
    qc_complex *a = NEW(qc_complex, 3 * n * n);
    double best = 0;
    bench_random_vector(3 * n * n, a);
    for (int run = 0; run < RUNS; run++) {
        const bench_duration begin = bench_clock();
        for (int64_t i = 0; i < repeats; i++)
            cblas_zgemm(CblasColMajor, CblasNoTrans, CblasConjTrans, n, n, n, one, a, n, a + n * n,
                        n, zero, a + 2 * n * n, n);
        const double t = bench_clock().cpu - begin.cpu;
        best = fmax(best, 8.0 * n * n * n * (double)repeats / t);
    }
    free(a);
    return best;
}

typedef struct stream_job {
    const isa *isa;
    int64_t n;
    int32_t repeats;
    double *x;
} stream_job;

static void *stream_main(void *arg) {
    const stream_job *job = arg;
    for (int32_t i = 0; i < job->repeats; i++) job->isa->stream(job->n, job->x);
    return NULL;
}

/* Bytes read plus written per second, each thread in its own block of n doubles. */
static double stream_rate(const isa *k, int64_t n, int threads) {
    stream_job job[2];
    double best = 0;
    for (int t = 0; t < threads; t++) {
        job[t] = (stream_job){k, n, (int32_t)(1 + 4000000 / n), NEW(double, n)};
        k->stream(n, job[t].x);
    }
    for (int run = 0; run < RUNS; run++) {
        pthread_t other;
        const bench_duration begin = bench_clock();
        const bool two = threads == 2 && pthread_create(&other, NULL, stream_main, &job[1]) == 0;
        stream_main(&job[0]);
        if (two) pthread_join(other, NULL);
        const double t = bench_clock().wall - begin.wall;
        best = fmax(best, (two ? 2 : 1) * 16.0 * (double)n * job[0].repeats / t);
    }
    for (int t = 0; t < threads; t++) free(job[t].x);
    return best;
}

bench_limits bench_measure_limits(void) {
    const isa *k = widest();
    const int64_t large = 16000000; /* doubles, beyond the last cache */
    bench_limits l = {0};
    l.l2_size = (double)sysconf(_SC_LEVEL2_CACHE_SIZE);
    l.l3_size = (double)sysconf(_SC_LEVEL3_CACHE_SIZE);
    l.fma = fma_peak(k);
#ifdef X86
    if (k == &avx512) l.fma_avx2 = fma_peak(&avx2);
#endif
    for (int i = 0; i < 3; i++) l.zgemm[i] = zgemm_peak(bench_zgemm_size[i]);
    if (l.l2_size > 0) l.l2 = stream_rate(k, (int64_t)l.l2_size / 16, 1);
    if (l.l3_size > 0) l.l3 = stream_rate(k, (int64_t)l.l3_size / 16, 1);
    l.memory = stream_rate(k, large, 1);
    l.memory2 = stream_rate(k, large, 2);
    return l;
}
