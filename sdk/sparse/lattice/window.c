/* The best change of a few entries of z, the others fixed: for a window W the integers y which
 * minimise
 *     1/2 y^T A y + g^T y = 1/2 |R y - u|^2 - 1/2 |u|^2,    A = P_WW = R^T R,    R^T u = -g_W
 * are found by exact enumeration (Schnorr and Euchner 1994; Agrell, Eriksson, Vardy, Zeger 2002):
 * entries are fixed from the last to the first, each at its best value, then its next best, until
 * the partial sum reaches the best so far, which is at the start that of y = 0. Pivots are chosen
 * smallest first (Wuebben et al. 2001), so that the entries fixed early have few candidates. */
#include "sdk/sparse/lattice/internal.h"
#include <math.h>

enum { W = QC__LATTICE_WINDOW, NODES = 20000 };

typedef struct window {
    int32_t n;
    int32_t place[W]; /* in the window, by place in the elimination */
    double R[W][W];   /* R[i][k], i < k, and the diagonal */
    double u[W];
    double rest[W + 1][W]; /* rest[k]: u less the columns k, ... at their present values */
    double centre[W], y[W], step[W], sum[W + 1];
    double best, y_best[W];
    bool found;
} window;

/* Cholesky with the smallest remaining pivot next; A: lower part destroyed. */
static void decompose(window *Q, double A[W][W]) {
    for (int32_t k = 0; k < Q->n; k++) {
        int32_t least = k;
        for (int32_t i = k + 1; i < Q->n; i++)
            if (A[Q->place[i]][Q->place[i]] < A[Q->place[least]][Q->place[least]]) least = i;
        const int32_t p = Q->place[least];
        Q->place[least] = Q->place[k];
        Q->place[k] = p;
        const double r = sqrt(A[p][p]);
        for (int32_t i = k + 1; i < Q->n; i++) A[Q->place[i]][p] /= r;
        A[p][p] = r;
        for (int32_t i = k + 1; i < Q->n; i++) {
            double *row = A[Q->place[i]];
            for (int32_t j = k + 1; j < Q->n; j++) row[Q->place[j]] -= row[p] * A[Q->place[j]][p];
        }
    }
    for (int32_t k = 0; k < Q->n; k++)
        for (int32_t i = 0; i <= k; i++) Q->R[i][k] = A[Q->place[k]][Q->place[i]];
}

/* Entry k at the integer nearest to its centre; the next ones lie on alternating sides. */
static void enter(window *Q, int32_t k) {
    Q->centre[k] = Q->rest[k + 1][k] / Q->R[k][k];
    Q->y[k] = floor(Q->centre[k] + 0.5);
    Q->step[k] = Q->centre[k] > Q->y[k] ? 1 : -1;
}

static int64_t enumerate(window *Q) {
    int64_t nodes = 0;
    int32_t k = Q->n - 1;
    Q->sum[Q->n] = 0;
    for (int32_t i = 0; i < Q->n; i++) Q->rest[Q->n][i] = Q->u[i];
    for (enter(Q, k); nodes < NODES; nodes++) {
        const double d = (Q->y[k] - Q->centre[k]) * Q->R[k][k], sum = Q->sum[k + 1] + 0.5 * d * d;
        if (sum < Q->best && k > 0) {
            Q->sum[k] = sum;
            for (int32_t i = 0; i < k; i++)
                Q->rest[k][i] = Q->rest[k + 1][i] - Q->R[i][k] * Q->y[k];
            enter(Q, --k);
            continue;
        }
        if (sum < Q->best) {
            Q->best = sum;
            Q->found = true;
            for (int32_t i = 0; i < Q->n; i++) Q->y_best[Q->place[i]] = Q->y[i];
        } else if (++k == Q->n) {
            break;
        }
        Q->y[k] += Q->step[k];
        Q->step[k] += Q->step[k] > 0 ? 1 : -1;
        Q->step[k] = -Q->step[k];
    }
    return nodes;
}

double qc__lattice_window(const qc__lattice *L, const int32_t *index, int32_t width, double gain,
                          double *change, int64_t *work) {
    const int64_t n = L->n;
    double A[W][W], start = 0;
    window Q = {.n = width};
    for (int32_t i = 0; i < width; i++) {
        Q.place[i] = i;
        for (int32_t j = 0; j < width; j++) A[i][j] = L->P[index[i] + index[j] * n];
    }
    decompose(&Q, A);
    for (int32_t k = 0; k < width; k++) {
        double sum = -L->g[index[Q.place[k]]];
        for (int32_t i = 0; i < k; i++) sum -= Q.R[i][k] * Q.u[i];
        Q.u[k] = sum / Q.R[k][k];
        start += 0.5 * Q.u[k] * Q.u[k];
    }
    Q.best = start - gain;
    *work += enumerate(&Q) * width / 2 + width * width * width / 3;
    if (!Q.found) return 0;
    for (int32_t i = 0; i < width; i++) change[i] = Q.y_best[i];
    return Q.best - start;
}
