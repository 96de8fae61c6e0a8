/* Clocks, samples and their medians. */
#include "tests/bench/common/common.h"

#include <stdlib.h>
#include <time.h>

static double read_clock(clockid_t id) {
    struct timespec t;
    clock_gettime(id, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

bench_duration bench_clock(void) {
    return (bench_duration){read_clock(CLOCK_MONOTONIC), read_clock(CLOCK_THREAD_CPUTIME_ID)};
}

void bench_sample(bench_samples *s, bench_duration d) {
    if (s->n == s->capacity) {
        s->capacity = 2 * s->capacity + 8;
        s->value = realloc(s->value, (size_t)s->capacity * sizeof *s->value);
        if (!s->value) bench_die("no memory");
    }
    s->value[s->n++] = d;
}

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(int32_t n, double *x) {
    qsort(x, (size_t)n, sizeof *x, compare_doubles);
    return n ? 0.5 * (x[(n - 1) / 2] + x[n / 2]) : 0;
}

bench_duration bench_median(const bench_samples *s) {
    double *wall = NEW(double, s->n), *cpu = NEW(double, s->n);
    for (int32_t i = 0; i < s->n; i++) {
        wall[i] = s->value[i].wall;
        cpu[i] = s->value[i].cpu;
    }
    const bench_duration d = {median(s->n, wall), median(s->n, cpu)};
    free(wall);
    free(cpu);
    return d;
}
