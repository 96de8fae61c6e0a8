/* Limited-memory BFGS (Nocedal 1980: two-loop recursion) with an Armijo line search. Curvature
 * pairs with s.y <= 0 are skipped, so every direction is a descent direction. */
#include "sdk/map/untangle/lbfgs.h"
#include <math.h>
#include <string.h>

enum { MEMORY = 12, BACKTRACKS = 40 };

typedef struct history {
    double *s[MEMORY], *y[MEMORY], rho[MEMORY];
    int32_t n, next;
} history;

static double dot(int64_t n, const double *a, const double *b) {
    double sum = 0;
    for (int64_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

static void axpy(int64_t n, double alpha, const double *x, double *y) {
    for (int64_t i = 0; i < n; i++) y[i] += alpha * x[i];
}

/* p := -H gradient. */
static qc_status direction(qc_ctx *ctx, const qc__lbfgs_problem *problem, const history *h,
                           const double *gradient, double *p) {
    const int64_t n = problem->n;
    double alpha[MEMORY];
    for (int64_t i = 0; i < n; i++) p[i] = -gradient[i];
    for (int32_t j = 0; j < h->n; j++) {
        const int32_t i = (h->next - 1 - j + 2 * MEMORY) % MEMORY;
        alpha[i] = h->rho[i] * dot(n, h->s[i], p);
        axpy(n, -alpha[i], h->y[i], p);
    }
    if (problem->precondition) {
        const qc_status status = problem->precondition(ctx, problem->user, p);
        if (status != QC_OK) return status;
    }
    for (int32_t j = h->n - 1; j >= 0; j--) {
        const int32_t i = (h->next - 1 - j + 2 * MEMORY) % MEMORY;
        const double beta = h->rho[i] * dot(n, h->y[i], p);
        axpy(n, alpha[i] - beta, h->s[i], p);
    }
    return QC_OK;
}

static void remember(history *h, int64_t n, const double *x, const double *x_new, const double *g,
                     const double *g_new) {
    double *s = h->s[h->next], *y = h->y[h->next];
    for (int64_t i = 0; i < n; i++) {
        s[i] = x_new[i] - x[i];
        y[i] = g_new[i] - g[i];
    }
    const double sy = dot(n, s, y);
    if (!(sy > 1e-14 * sqrt(dot(n, s, s) * dot(n, y, y)))) return;
    h->rho[h->next] = 1.0 / sy;
    h->next = (h->next + 1) % MEMORY;
    if (h->n < MEMORY) h->n++;
}

qc_status qc__lbfgs(qc_ctx *ctx, const qc__lbfgs_problem *problem, int32_t max_iterations,
                    double relative, double *x, double *energy, int32_t *iterations) {
    const int64_t n = problem->n;
    double *block = QC__NEW(ctx, double, (2 * MEMORY + 4) * n);
    if (!block) return QC_ERR_NOMEM;
    history h = {.n = 0, .next = 0};
    for (int32_t i = 0; i < MEMORY; i++) {
        h.s[i] = block + 2 * i * n;
        h.y[i] = block + (2 * i + 1) * n;
    }
    double *g = block + 2 * MEMORY * n, *g_new = g + n, *p = g + 2 * n, *x_new = g + 3 * n;
    qc_status status = QC_OK;
    double e = problem->evaluate(problem->user, x, g);
    int32_t step = 0;
    for (; step < max_iterations && status == QC_OK; step++) {
        if (!qc__progress(ctx, (double)step / max_iterations)) {
            status = QC_ERR_CANCELLED;
            break;
        }
        status = direction(ctx, problem, &h, g, p);
        if (status == QC_OK) status = qc__poll(ctx);
        if (status != QC_OK) break;
        const double slope = dot(n, g, p);
        if (!(slope < 0)) break;
        double t = problem->limit ? fmin(1.0, problem->limit(problem->user, x, p)) : 1.0;
        double e_new = INFINITY;
        int32_t tries = 0;
        for (; tries < BACKTRACKS && status == QC_OK; tries++, t *= 0.5) {
            for (int64_t i = 0; i < n; i++) x_new[i] = x[i] + t * p[i];
            e_new = problem->evaluate(problem->user, x_new, g_new);
            if (e_new <= e + 1e-4 * t * slope) break;
            status = qc__poll(ctx);
        }
        if (tries == BACKTRACKS || status != QC_OK) break;
        remember(&h, n, x, x_new, g, g_new);
        memcpy(x, x_new, sizeof *x * (size_t)n);
        double *swap = g;
        g = g_new;
        g_new = swap;
        const bool stalled = e - e_new <= relative * fabs(e);
        e = e_new;
        if (stalled) break;
    }
    qc__free(block);
    if (status == QC_OK && energy) *energy = e;
    if (status == QC_OK && iterations) *iterations = step;
    return status;
}
