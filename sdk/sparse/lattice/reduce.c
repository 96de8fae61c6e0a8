/* Reduction of a lattice basis: the unimodular U for which U^T P U is as near to diagonal as is
 * cheap, so that steps along the new axes are short and hardly interact. First pairs (Lagrange,
 * Gauss: b_i -= q b_j while that is shorter), then Lenstra, Lenstra, Lovasz 1982 on the Cholesky
 * factor, kept triangular by plane rotations, then pairs again, which also shortens early vectors
 * by later ones. Every step leaves a basis, so the reduction ends where its budget does. */
#include "sdk/sparse/lattice/internal.h"
#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

static const double lovasz = 0.9;      /* quotient of neighbouring |b*|^2 which is kept */
static const double half = 0.5 + 1e-6; /* exact halves, frequent by symmetry, stay as they are */
enum { PAIR_ROUNDS = 8 };

static void exchange(int64_t n, double *x, double *y) {
    for (int64_t i = 0; i < n; i++) {
        const double kept = x[i];
        x[i] = y[i];
        y[i] = kept;
    }
}

static void subtract(int64_t n, double q, const double *x, double *y) {
    for (int64_t i = 0; i < n; i++) y[i] -= q * x[i];
}

/* b_k -= q b_j in U and in the coordinates s: U s stays. */
static void transform(qc__lattice_basis *B, int64_t k, int64_t j, double q) {
    subtract(B->n, q, B->U + j * B->n, B->U + k * B->n);
    B->s[j] += q * B->s[k];
    B->work += B->n;
}

static void reduce_pairs(qc__lattice_basis *B) {
    const int64_t n = B->n;
    double *G = B->G;
    bool changed = true;
    for (int round = 0; round < PAIR_ROUNDS && changed && B->work < B->budget; round++) {
        changed = false;
        for (int64_t i = 0; i < n; i++)
            for (int64_t j = 0; j < n; j++) {
                if (j == i || !(fabs(G[j + i * n]) > half * G[j + j * n])) continue;
                const double q = rint(G[j + i * n] / G[j + j * n]);
                subtract(n, q, G + j * n, G + i * n);
                for (int64_t k = 0; k < n; k++) G[i + k * n] -= q * G[j + k * n];
                transform(B, i, j, q);
                changed = true;
            }
        B->work += n * n;
    }
}

/* |R_jk| <= R_jj / 2 */
static void reduce_entry(qc__lattice_basis *B, double *R, int64_t k, int64_t j) {
    const int64_t n = B->n;
    const double mu = R[j + k * n] / R[j + j * n];
    if (!(fabs(mu) > half)) return;
    const double q = rint(mu);
    subtract(j + 1, q, R + j * n, R + k * n);
    transform(B, k, j, q);
}

/* Exchanges b_{k-1} and b_k; a rotation of the rows k-1 and k makes R triangular again. */
static void exchange_vectors(qc__lattice_basis *B, double *R, int64_t k) {
    const int64_t n = B->n;
    exchange(k + 1, R + (k - 1) * n, R + k * n);
    exchange(n, B->U + (k - 1) * n, B->U + k * n);
    exchange(1, B->s + k - 1, B->s + k);
    const double a = R[k - 1 + (k - 1) * n], b = R[k + (k - 1) * n], r = hypot(a, b);
    for (int64_t j = k - 1; j < n; j++) {
        const double x = R[k - 1 + j * n], y = R[k + j * n];
        R[k - 1 + j * n] = (a * x + b * y) / r;
        R[k + j * n] = (a * y - b * x) / r;
    }
    R[k + (k - 1) * n] = 0;
    B->work += 3 * n;
}

static qc_status reduce_triangle(qc_ctx *ctx, qc__lattice_basis *B, double *R) {
    const int64_t n = B->n;
    int64_t reported = B->work;
    for (int64_t k = 1; k < n && B->work < B->budget;) {
        reduce_entry(B, R, k, k - 1);
        const double a = R[k - 1 + (k - 1) * n], b = R[k - 1 + k * n], c = R[k + k * n];
        if (b * b + c * c < lovasz * a * a) {
            exchange_vectors(B, R, k);
            if (k > 1) k--;
        } else {
            for (int64_t j = k - 1; j-- > 0;) reduce_entry(B, R, k, j);
            B->work += k;
            k++;
        }
        if (B->work - reported < QC__LATTICE_REPORT) continue;
        reported = B->work;
        if (!qc__progress(ctx, (double)k / (double)n)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

/* R^T R = G, upper triangle with zeros below. */
static bool factor(int32_t n, const double *G, double *R) {
    memcpy(R, G, (size_t)n * (size_t)n * sizeof *R);
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'U', n, R, n) != 0) return false;
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = j + 1; i < n; i++) R[i + j * n] = 0;
    return true;
}

/* G <- U^T P U, exactly symmetric. */
static void form(const qc__lattice_basis *B, const double *P, double *work) {
    const int n = (int)B->n;
    cblas_dsymm(CblasColMajor, CblasLeft, CblasLower, n, n, 1, P, n, B->U, n, 0, work, n);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, n, n, 1, B->U, n, work, n, 0, B->G, n);
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < j; i++) B->G[i + j * n] = B->G[j + i * n];
}

qc_status qc__lattice_reduce(qc_ctx *ctx, qc__lattice_basis *B, const double *P, double *work) {
    const int64_t n = B->n;
    qc_status status = QC_OK;
    memcpy(B->G, P, (size_t)(n * n) * sizeof *P);
    memset(B->U, 0, (size_t)(n * n) * sizeof *B->U);
    for (int64_t i = 0; i < n; i++) B->U[i + i * n] = 1;
    qc__blas_begin();
    reduce_pairs(B);
    if (factor((int32_t)n, B->G, work)) {
        status = reduce_triangle(ctx, B, work);
        form(B, P, work);
        reduce_pairs(B);
    }
    qc__blas_end();
    return status;
}
