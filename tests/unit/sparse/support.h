/* Random sparse matrices and dense references for the tests of this folder. */
#ifndef QC_TEST_SPARSE_SUPPORT_H
#define QC_TEST_SPARSE_SUPPORT_H

#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "sdk/sparse/internal.h"

typedef double _Complex cplx;

static uint64_t seed_state = 1;
static inline double uniform(void) { /* in [-1, 1) */
    seed_state = seed_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(int64_t)seed_state / 9223372036854775808.0;
}
static inline int32_t pick(int32_t n) {
    return (int32_t)((uniform() + 1) * 0.5 * n);
}

/* A growing matrix and its two views. */
typedef struct test_matrix {
    int32_t n;
    int64_t *colptr;
    int32_t *row;
    qc_complex *val;
    double *real;
} test_matrix;

static inline qc_hermitian hermitian(const test_matrix *M) {
    return (qc_hermitian){M->n, M->colptr, M->row, M->val};
}
static inline qc_symmetric symmetric(const test_matrix *M) {
    return (qc_symmetric){M->n, M->colptr, M->row, M->real};
}

/* Edges (a, b) with weight 1 become w (e^{i phase} and its conjugate); the diagonal dominates by
 * `shift`, so the matrix is a Laplacian with phases plus shift. */
static inline test_matrix from_edges(int32_t n, int64_t ne, const int32_t (*edge)[2],
                                     double shift) {
    bool *dense = calloc((size_t)n * (size_t)n + 1, sizeof *dense);
    int64_t nnz = n;
    for (int64_t e = 0; e < ne; e++) {
        const int32_t a = edge[e][0], b = edge[e][1];
        const int64_t at = (int64_t)(a < b ? b : a) * n + (a < b ? a : b);
        if (a != b && !dense[at]) {
            dense[at] = true;
            nnz++;
        }
    }
    test_matrix M = {n, malloc(((size_t)n + 1) * 8), malloc((size_t)nnz * 4 + 4),
                     malloc((size_t)nnz * 16 + 16), malloc((size_t)nnz * 8 + 8)};
    double *diagonal = calloc((size_t)n + 1, sizeof *diagonal);
    int64_t q = 0;
    for (int pass = 0; pass < 2; pass++) {
        q = 0;
        for (int32_t j = 0; j < n; j++) {
            M.colptr[j] = q;
            for (int32_t i = 0; i < j; i++) {
                if (!dense[(int64_t)j * n + i]) continue;
                if (pass == 0) {
                    const double weight = 1.5 + uniform(), phase = 4 * uniform();
                    M.row[q] = i;
                    M.val[q] = (qc_complex){-weight * cos(phase), -weight * sin(phase)};
                    M.real[q] = -weight;
                    diagonal[i] += weight;
                    diagonal[j] += weight;
                }
                q++;
            }
            M.row[q] = j;
            M.val[q] = (qc_complex){diagonal[j] + shift, 77}; /* the 77 has to be ignored */
            M.real[q++] = diagonal[j] + shift;
        }
    }
    M.colptr[n] = q;
    free(dense);
    free(diagonal);
    return M;
}

static inline void free_matrix(test_matrix *M) {
    free(M->colptr);
    free(M->row);
    free(M->val);
    free(M->real);
}

enum { GRID, RANDOM, ARROW, DIAGONAL, BLOCKS, PATH, DENSE, SHAPES };

/* About n rows of one of the shapes. */
static inline test_matrix make_matrix(int shape, int32_t n, double shift) {
    int32_t(*edge)[2] = malloc(((size_t)n * (size_t)n + 4 * (size_t)n + 1) * sizeof *edge);
    int64_t ne = 0;
    const int32_t side = (int32_t)sqrt((double)n);
    if (shape == GRID) n = side * side;
    for (int32_t i = 0; i < n; i++) {
        switch (shape) {
        case GRID:
            if (i % side) edge[ne][0] = i, edge[ne++][1] = i - 1;
            if (i >= side) edge[ne][0] = i, edge[ne++][1] = i - side;
            break;
        case RANDOM:
            for (int k = 0; k < 2; k++) edge[ne][0] = i, edge[ne++][1] = pick(n);
            break;
        case ARROW:
            edge[ne][0] = i, edge[ne++][1] = n / 2;
            break;
        case BLOCKS:
            if (i % 7) edge[ne][0] = i, edge[ne++][1] = i - 1 - pick(i % 7);
            break;
        case PATH:
            if (i) edge[ne][0] = i, edge[ne++][1] = i - 1;
            break;
        case DENSE:
            for (int32_t j = 0; j < i; j++) edge[ne][0] = i, edge[ne++][1] = j;
            break;
        default:
            break;
        }
    }
    test_matrix M = from_edges(n, ne, (const int32_t(*)[2])edge, shift);
    free(edge);
    return M;
}

/* Full matrix, column-major. */
static inline cplx *dense_of(const test_matrix *M, bool real) {
    const int64_t n = M->n;
    cplx *A = calloc((size_t)(n * n) + 1, sizeof *A);
    for (int32_t j = 0; j < n; j++)
        for (int64_t p = M->colptr[j]; p < M->colptr[j + 1]; p++) {
            const int32_t i = M->row[p];
            const cplx a = real ? M->real[p] : M->val[p].re + I * M->val[p].im;
            A[i + j * n] = i == j ? creal(a) : a;
            A[j + i * n] = i == j ? creal(a) : conj(a);
        }
    return A;
}

/* P^T L D L^H P, the caller's numbering. */
static inline cplx *reconstruct(const qc_factor *F) {
    const qc_symbolic *S = F->S;
    const int64_t n = S->n, nc = F->components;
    cplx *L = calloc((size_t)(n * n) + 1, sizeof *L), *A = calloc((size_t)(n * n) + 1, sizeof *A);
    for (int32_t s = 0; s < S->nsuper; s++) {
        const int64_t r = S->rowptr[s + 1] - S->rowptr[s], w = S->super[s + 1] - S->super[s];
        for (int64_t k = 0; k < w; k++)
            for (int64_t i = k; i < r; i++) {
                const double *x = F->values + nc * (S->panel[s] + i + k * r);
                L[S->rows[S->rowptr[s] + i] + (S->super[s] + k) * n] =
                    x[0] + (nc == 2 ? I * x[1] : 0);
            }
    }
    for (int64_t k = 0; k < n; k++)
        for (int64_t j = k; j < n; j++) {
            const cplx factor = F->D[k] * conj(L[j + k * n]);
            if (factor == 0) continue;
            for (int64_t i = k; i < n; i++) A[S->perm[i] + S->perm[j] * n] += L[i + k * n] * factor;
        }
    free(L);
    return A;
}

static inline double max_difference(int64_t count, const cplx *a, const cplx *b) {
    double max = 0;
    for (int64_t i = 0; i < count; i++) max = fmax(max, cabs(a[i] - b[i]));
    return max;
}
static inline double max_abs(int64_t count, const cplx *a) {
    double max = 0;
    for (int64_t i = 0; i < count; i++) max = fmax(max, cabs(a[i]));
    return max;
}

/* NULL when the processor lacks the instructions. */
static inline qc_ctx *new_ctx_with(uint32_t threads, const char *instructions) {
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx = NULL;
    options.threads = threads;
    options.instructions = instructions;
    const qc_status status = qc_ctx_create(&options, &ctx);
    if (status == QC_ERR_UNSUPPORTED) return NULL;
    assert_int_equal(status, QC_OK);
    return ctx;
}
static inline qc_ctx *new_ctx(uint32_t threads) {
    return new_ctx_with(threads, NULL);
}

static const char *const instruction_sets[] = {"portable", "avx2", "avx512"};

/* A += sigma w w^H, w with nw entries; the real part of w for the real matrix. */
static inline void add_square(test_matrix *M, int sigma, int nw, const int32_t *row,
                              const qc_complex *w) {
    for (int a = 0; a < nw; a++)
        for (int b = 0; b < nw; b++) {
            if (row[a] > row[b]) continue;
            int64_t p = M->colptr[row[b]];
            while (M->row[p] != row[a]) p++;
            const cplx x = (w[a].re + I * w[a].im) * (w[b].re - I * w[b].im);
            M->val[p].re += sigma * creal(x);
            if (a != b) M->val[p].im += sigma * cimag(x);
            M->real[p] += sigma * w[a].re * w[b].re;
        }
}

/* The rows of one off-diagonal entry; false: there is none, row[0] only. */
static inline bool random_clique(const test_matrix *M, int32_t row[2]) {
    const int32_t j = pick(M->n);
    const int64_t begin = M->colptr[j], count = M->colptr[j + 1] - begin;
    row[0] = j;
    row[1] = count > 1 ? M->row[begin + pick((int32_t)count - 1)] : j;
    return row[0] != row[1];
}

static inline qc_factor *factor_of(qc_ctx *ctx, const test_matrix *M,
                                   const qc_analyze_options *options) {
    const qc_hermitian A = hermitian(M);
    qc_symbolic *S = NULL;
    qc_factor *F = NULL;
    assert_int_equal(qc_analyze(ctx, &A, options, &S), QC_OK);
    assert_int_equal(qc_factorize(ctx, S, &A, &F), QC_OK);
    qc_symbolic_free(S);
    return F;
}

static inline qc_factor *real_factor_of(qc_ctx *ctx, const test_matrix *M,
                                        const qc_analyze_options *options) {
    const qc_symmetric A = symmetric(M);
    qc_symbolic *S = NULL;
    qc_factor *F = NULL;
    assert_int_equal(qc_analyze_real(ctx, &A, options, &S), QC_OK);
    assert_int_equal(qc_factorize_real(ctx, S, &A, &F), QC_OK);
    qc_symbolic_free(S);
    return F;
}

/* Every bit of what a factor holds except undefined places (above the diagonal). */
static inline uint64_t fingerprint(const qc_factor *F) {
    const qc_symbolic *S = F->S;
    const int64_t nc = F->components;
    uint64_t hash = 1469598103934665603u, bits;
    for (int32_t s = 0; s < S->nsuper; s++) {
        const int64_t r = S->rowptr[s + 1] - S->rowptr[s], w = S->super[s + 1] - S->super[s];
        for (int64_t k = 0; k < w; k++)
            for (int64_t i = nc * k; i < nc * r; i++) {
                memcpy(&bits, F->values + nc * (S->panel[s] + k * r) + i, 8);
                hash = (hash ^ bits) * 1099511628211u;
            }
    }
    for (int32_t k = 0; k < S->n; k++) {
        memcpy(&bits, F->D + k, 8);
        hash = (hash ^ bits) * 1099511628211u;
        memcpy(&bits, F->diagonal + k, 8);
        hash = (hash ^ bits) * 1099511628211u;
    }
    return hash;
}

#endif
