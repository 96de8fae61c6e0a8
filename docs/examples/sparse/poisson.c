/* The sparse module alone: Poisson's equation on a square, then on the same square with a slit
 * which is cut, and closed again, by down- and updates of the factor. Needs <qc/sparse.h> only.
 *
 * -Laplace u = f on the unit square, u = 0 on its border, by the five-point stencil with n x n
 * inner points. The matrix is a network of springs: each pair of neighbours adds w w^T / h^2 with
 * w = (.., 1, .., -1, ..), so that cutting one spring is a downdate of rank 1.
 *
 *     poisson [N] */
#include <math.h>
#include <qc/sparse.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

typedef struct system {
    qc_symmetric A; /* upper triangle by columns, rows sorted */
    int64_t *colptr;
    int32_t *row;
    double *val, *b, *u; /* right-hand side and solution */
    int32_t n;
    double h2;
} system_t;

static bool allocate(system_t *s, int32_t n) {
    const size_t N = (size_t)n * (size_t)n;
    s->n = n;
    s->h2 = 1.0 / ((n + 1.0) * (n + 1.0));
    s->colptr = malloc((N + 1) * sizeof *s->colptr);
    s->row = malloc(3 * N * sizeof *s->row);
    s->val = malloc(3 * N * sizeof *s->val);
    s->b = malloc(N * sizeof *s->b);
    s->u = malloc(N * sizeof *s->u);
    return s->colptr && s->row && s->val && s->b && s->u;
}

/* Point (i, j) is row i + n j; f = 2 pi^2 sin(pi x) sin(pi y), so that u = sin(pi x) sin(pi y). */
static double exact(const system_t *s, int32_t i, int32_t j) {
    return sin(pi * (i + 1) / (s->n + 1)) * sin(pi * (j + 1) / (s->n + 1));
}
static void assemble(system_t *s) {
    int64_t nz = 0;
    for (int32_t j = 0; j < s->n; j++)
        for (int32_t i = 0; i < s->n; i++) {
            const int32_t k = i + s->n * j;
            s->colptr[k] = nz;
            if (j > 0) s->row[nz] = k - s->n, s->val[nz++] = -1 / s->h2;
            if (i > 0) s->row[nz] = k - 1, s->val[nz++] = -1 / s->h2;
            s->row[nz] = k, s->val[nz++] = 4 / s->h2;
            s->b[k] = 2 * pi * pi * exact(s, i, j);
            s->colptr[k + 1] = nz;
        }
    s->A = (qc_symmetric){s->n * s->n, s->colptr, s->row, s->val};
}

static qc_status solve(qc_ctx *ctx, const system_t *s, const qc_factor *F) {
    for (int32_t k = 0; k < s->A.n; k++) s->u[k] = s->b[k];
    return qc_solve_real(ctx, F, 1, s->u); /* in place */
}
static double error(const system_t *s) {
    double e = 0;
    for (int32_t k = 0; k < s->A.n; k++) e = fmax(e, fabs(s->u[k] - exact(s, k % s->n, k / s->n)));
    return e;
}

/* Whether the spring from (i - 1, j) to (i, j) crosses the slit. */
static bool crosses(const system_t *s, int32_t i, int32_t j) {
    return i == s->n / 4 && j < s->n / 2;
}

/* Cuts (sigma -1) or closes (+1) all springs across the slit in one sweep over the factor. Each w
 * has two entries, at neighbours, whose coupling is in the pattern. */
static qc_status slit(qc_ctx *ctx, const system_t *s, qc_factor *F, int sigma) {
    const size_t count = (size_t)s->n / 2;
    int *sign = malloc(count * sizeof *sign);
    int32_t *start = malloc((count + 1) * sizeof *start), *row = malloc(2 * count * sizeof *row);
    double *w = malloc(2 * count * sizeof *w);
    qc_status status = QC_OK;
    if (!sign || !start || !row || !w) status = qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
    for (int32_t j = 0; j <= s->n / 2 && status == QC_OK; j++) {
        start[j] = 2 * j;
        if (j == s->n / 2) break;
        sign[j] = sigma;
        row[2 * j] = s->n / 4 - 1 + s->n * j;
        row[2 * j + 1] = row[2 * j] + 1;
        w[2 * j] = 1 / sqrt(s->h2);
        w[2 * j + 1] = -w[2 * j];
    }
    if (status == QC_OK) status = qc_updown_many_real(ctx, F, s->n / 2, sign, start, row, w);
    free(w);
    free(row);
    free(start);
    free(sign);
    return status;
}

/* The largest force which the springs leave on a point, computed from the network itself. */
static double residual(const system_t *s, bool cut) {
    double largest = 0;
    for (int32_t k = 0; k < s->A.n; k++) {
        const int32_t n = s->n, i = k % n, j = k / n;
        const double *u = s->u;
        double force = 4 * u[k] - s->h2 * s->b[k];
        if (j > 0) force -= u[k - n];
        if (j + 1 < n) force -= u[k + n];
        if (i > 0) force -= cut && crosses(s, i, j) ? u[k] : u[k - 1];
        if (i + 1 < n) force -= cut && crosses(s, i + 1, j) ? u[k] : u[k + 1];
        largest = fmax(largest, fabs(force));
    }
    return largest;
}

static qc_status experiment(qc_ctx *ctx, system_t *s) {
    qc_symbolic *S = NULL;
    qc_factor *F = NULL;
    double closed = 0, open = 0;
    const int32_t beside = s->n / 4 + s->n * (s->n / 4);                /* a point at the slit */
    qc_status status = qc_analyze_real(ctx, &s->A, NULL, &S);           /* once per pattern */
    if (status == QC_OK) status = qc_factorize_real(ctx, S, &s->A, &F); /* once per values  */
    if (status == QC_OK) status = solve(ctx, s, F);
    if (status == QC_OK) {
        closed = s->u[beside];
        printf("%d unknowns: error %.3e, residual %.1e\n", s->A.n, error(s), residual(s, false));
        status = slit(ctx, s, F, -1);
    }
    if (status == QC_OK) status = solve(ctx, s, F);
    if (status == QC_OK) {
        open = s->u[beside];
        printf("cut: residual %.1e, moved by %.3e\n", residual(s, true), fabs(open - closed));
        status = slit(ctx, s, F, +1);
    }
    if (status == QC_OK) status = solve(ctx, s, F);
    if (status == QC_OK)
        printf("closed: residual %.1e, moved by %.1e\n", residual(s, false),
               fabs(s->u[beside] - closed));
    qc_factor_free(F);
    qc_symbolic_free(S);
    return status;
}

int main(int argc, char **argv) {
    const int32_t n = argc > 1 ? (int32_t)atoi(argv[1]) : 100;
    if (n < 4 || n > 2000) return fprintf(stderr, "usage: poisson [N], N from 4 to 2000\n"), 2;
    qc_ctx *ctx = NULL;
    system_t s = {0};
    if (qc_ctx_create(NULL, &ctx) != QC_OK) return 1;
    qc_status status = QC_OK;
    if (allocate(&s, n))
        assemble(&s);
    else
        status = qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
    if (status == QC_OK) status = experiment(ctx, &s);
    if (status != QC_OK) fprintf(stderr, "poisson: %s\n", qc_ctx_error(ctx)->text);
    free(s.colptr);
    free(s.row);
    free(s.val);
    free(s.b);
    free(s.u);
    qc_ctx_free(ctx);
    return status == QC_OK ? 0 : 1;
}
