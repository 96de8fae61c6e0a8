/* Greedy rounding as in mixed-integer quadrangulation (Bommes, Zimmer, Kobbelt 2009): fix the
 * variable which costs least, let the others relax, repeat. With Q = (P on the free variables)^{-1}
 * and their relaxed values x, fixing x_i to an integer z_i costs (z_i - x_i)^2 / (2 Q_ii), moves
 * x_j by Q_ji / Q_ii (z_i - x_i), and Q <- Q - q_i q_i^T / Q_ii, which is Cholesky elimination of
 * P^{-1} in the order of the choices. The rank-1 changes are collected in V and applied to Q in
 * blocks. */
#include "sdk/sparse/lattice/internal.h"
#include <cblas.h>
#include <math.h>
#include <string.h>

enum { BLOCK = 32 };

typedef struct greedy {
    int64_t n;
    double *Q;        /* n x n lower triangle, without the changes in V */
    double *V;        /* n x BLOCK */
    double *diagonal; /* present Q_ii */
    double *x;        /* relaxed values */
    bool *fixed;
    int64_t columns; /* in V */
} greedy;

static int64_t cheapest(const greedy *G) {
    int64_t best = -1;
    double best_cost = INFINITY;
    for (int64_t i = 0; i < G->n; i++) {
        if (G->fixed[i]) continue;
        const double d = qc__lattice_nearest(G->x[i]) - G->x[i], cost = d * d / G->diagonal[i];
        if (best < 0 || cost < best_cost - qc__lattice_tie / G->diagonal[i]) {
            best_cost = cost;
            best = i;
        }
    }
    return best;
}

/* v <- column i of the present Q, divided by sqrt(Q_ii) */
static void next_column(greedy *G, int64_t i, double *v) {
    const int64_t n = G->n;
    for (int64_t j = 0; j < i; j++) v[j] = G->Q[i + j * n];
    for (int64_t j = i; j < n; j++) v[j] = G->Q[j + i * n];
    for (int64_t c = 0; c < G->columns; c++) {
        const double *u = G->V + c * n, factor = u[i];
        for (int64_t j = 0; j < n; j++) v[j] -= factor * u[j];
    }
    const double scale = 1 / sqrt(G->diagonal[i]);
    for (int64_t j = 0; j < n; j++) v[j] = G->fixed[j] ? 0 : v[j] * scale;
}

static void fix(greedy *G, const double *P, int64_t i) {
    const int64_t n = G->n;
    double *v = G->V + G->columns * n;
    next_column(G, i, v);
    const double z = qc__lattice_nearest(G->x[i]), step = (z - G->x[i]) / sqrt(G->diagonal[i]);
    G->fixed[i] = true;
    for (int64_t j = 0; j < n; j++) {
        if (G->fixed[j]) continue;
        G->x[j] += v[j] * step;
        /* Q_jj >= 1 / P_jj holds exactly: keep it through rounding */
        G->diagonal[j] = fmax(G->diagonal[j] - v[j] * v[j], 1 / P[j + j * n]);
    }
    G->x[i] = z;
    if (++G->columns == BLOCK) {
        cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, (int)n, BLOCK, -1, G->V, (int)n, 1,
                    G->Q, (int)n);
        G->columns = 0;
    }
}

qc_status qc__lattice_greedy(qc_ctx *ctx, qc__lattice *L, double *inverse) {
    const int64_t n = L->n;
    double *work = QC__NEW(ctx, double, n *(BLOCK + 1));
    bool *fixed = QC__ZERO(ctx, bool, n);
    qc_status status = QC_ERR_NOMEM;
    if (work && fixed) {
        greedy G = {n, inverse, work, work + n * BLOCK, L->z, fixed, 0};
        memcpy(G.x, L->t, (size_t)n * sizeof *G.x);
        for (int64_t i = 0; i < n; i++) G.diagonal[i] = inverse[i + i * n];
        status = QC_OK;
        qc__blas_begin();
        for (int64_t k = 0; k < n && status == QC_OK; k++) {
            fix(&G, L->P, cheapest(&G));
            if ((k & 15) == 15 && !qc__progress(ctx, (double)k / (double)n))
                status = QC_ERR_CANCELLED;
        }
        qc__blas_end();
    }
    qc__free(work);
    qc__free(fixed);
    return status;
}
