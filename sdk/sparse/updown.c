/* A <- A + sum sigma_q w_q w_q^H for one or two vectors with the same pattern, on the path from
 * their first row to the root. One column step of A + a w w^H with p = w_j (Gill, Golub, Murray,
 * Saunders 1974, method C1, in Hermitian form): d' = d + a |p|^2,  b = a conj(p) / d',  w_i <- w_i
 * - p l_i,  l_i <- l_i + b w_i,  a <- a d / d'. Both vectors of a flip are swept together, the
 * second seeing the column left by the first. Old columns go to a journal, from which a failed call
 * restores the factor bit for bit. Compiled twice, see scalar.h. */
#include "sdk/sparse/scalar.h"
#include <math.h>
#include <string.h>

enum { MOST_ROWS = 3 }; /* of a flip */

typedef struct sweep {
    qc_factor *F;
    int vectors;
    double a[2];
    double negligible; /* entries of v below this are taken as zero */
    double *v[2];      /* the vectors on the rows of the present supernode, then of its parent */
    double *next[2];
} sweep;

/* w_i -= p l_i, l_i += b w_i for n rows */
static void column_step(int64_t n, const double *p, const double *b, double *restrict l,
                        double *restrict v) {
    if (NC == 1) {
        for (int64_t i = 0; i < n; i++) {
            v[i] -= p[0] * l[i];
            l[i] += b[0] * v[i];
        }
        return;
    }
    const double pr = p[0], pi = p[NC - 1], br = b[0], bi = b[NC - 1];
    for (int64_t i = 0; i < n; i++) {
        const double lr = l[2 * i], li = l[2 * i + 1];
        const double vr = v[2 * i] - (pr * lr - pi * li), vi = v[2 * i + 1] - (pr * li + pi * lr);
        v[2 * i] = vr;
        v[2 * i + 1] = vi;
        l[2 * i] = lr + (br * vr - bi * vi);
        l[2 * i + 1] = li + (br * vi + bi * vr);
    }
}

/* Both vectors in one pass: the entry of L stays in registers. */
static void column_step2(int64_t n, double p[2][2], double b[2][2], double *restrict l,
                         double *restrict v, double *restrict u) {
    const double pr = p[0][0], pi = p[0][1], br = b[0][0], bi = b[0][1];
    const double qr = p[1][0], qi = p[1][1], cr = b[1][0], ci = b[1][1];
    for (int64_t i = 0; i < n; i++) {
        double lr = l[2 * i], li = l[2 * i + 1];
        const double vr = v[2 * i] - (pr * lr - pi * li), vi = v[2 * i + 1] - (pr * li + pi * lr);
        lr += br * vr - bi * vi;
        li += br * vi + bi * vr;
        const double ur = u[2 * i] - (qr * lr - qi * li), ui = u[2 * i + 1] - (qr * li + qi * lr);
        v[2 * i] = vr;
        v[2 * i + 1] = vi;
        u[2 * i] = ur;
        u[2 * i + 1] = ui;
        l[2 * i] = lr + (cr * ur - ci * ui);
        l[2 * i + 1] = li + (cr * ui + ci * ur);
    }
}

/* One column; x: its entries from the diagonal on (n of them below). False: the pivot fails. */
static bool update_column(sweep *W, int32_t column, double floor, double *x, int64_t k, int64_t n) {
    double p[2][2] = {{0, 0}, {0, 0}}, b[2][2] = {{0, 0}, {0, 0}};
    bool any = false;
    for (int q = 0; q < W->vectors; q++)
        for (int c = 0; c < NC; c++) any |= (p[q][c] = W->v[q][NC * k + c]) != 0;
    if (!any) return true; /* both steps would be the identity */
    qc__journal_record(W->F, column, x, NC * (n + 1));
    double d = W->F->D[column];
    for (int q = 0; q < W->vectors; q++) {
        const double a = W->a[q];
        const double changed = d + a * (p[q][0] * p[q][0] + p[q][1] * p[q][1]);
        if (!(changed > floor) || !isfinite(changed)) return false;
        b[q][0] = a * p[q][0] / changed;
        b[q][1] = -a * p[q][1] / changed;
        W->a[q] = a * (d / changed);
        d = changed;
    }
    W->F->D[column] = d;
    double *l = x + NC, *v = W->v[0] + NC * (k + 1), *u = W->v[1] + NC * (k + 1);
    if (NC == 2 && W->vectors == 2) {
        column_step2(n, p, b, l, v, u);
    } else {
        column_step(n, p[0], b[0], l, v);
        if (W->vectors == 2) column_step(n, p[1], b[1], l, u);
    }
    return true;
}

/* Hands the vectors on to the rows of the parent. Entries far below rounding become zero: their
 * columns are left alone, and no arithmetic on subnormal numbers slows the sweep down. Returns
 * false when nothing is left. */
static bool pass_up(sweep *W, int32_t s) {
    const qc_symbolic *S = W->F->S;
    const int32_t parent = S->parent[s], w = S->super[s + 1] - S->super[s];
    const int32_t *local = S->relative + S->rowptr[s];
    const int64_t r = S->rowptr[s + 1] - S->rowptr[s];
    const int64_t rp = S->rowptr[parent + 1] - S->rowptr[parent];
    bool any = false;
    for (int q = 0; q < W->vectors; q++) {
        double *from = W->v[q], *to = W->next[q];
        memset(to, 0, (size_t)(NC * rp) * sizeof *to);
        for (int64_t i = w; i < r; i++)
            for (int c = 0; c < NC; c++) {
                const double x = from[NC * i + c];
                if (fabs(x) <= W->negligible) continue;
                to[NC * (int64_t)local[i] + c] = x;
                any = true;
            }
        W->v[q] = to;
        W->next[q] = from;
    }
    return any;
}

/* Returns the permuted column which failed, or -1. */
static int32_t sweep_path(sweep *W, int32_t s, int32_t first_column, const double *diagonal_change,
                          const int32_t *row, int32_t nw) {
    qc_factor *F = W->F;
    const qc_symbolic *S = F->S;
    for (; s != -1; s = S->parent[s]) {
        const int64_t first = S->super[s], w = S->super[s + 1] - first;
        const int64_t r = S->rowptr[s + 1] - S->rowptr[s];
        for (int64_t k = first_column > first ? first_column - first : 0; k < w; k++) {
            const int32_t column = (int32_t)(first + k);
            double diagonal = F->diagonal[column];
            for (int32_t i = 0; diagonal_change && i < nw; i++)
                if (S->inverse[row[i]] == column) diagonal += diagonal_change[i];
            double *x = F->values + NC * (S->panel[s] + k * r + k);
            if (!update_column(W, column, qc__pivot_floor(S->n, diagonal), x, k, r - k - 1))
                return column;
        }
        if (S->parent[s] != -1 && !pass_up(W, s)) break;
    }
    return -1;
}

/* Local row of a permuted row in a supernode, or -1. */
static int64_t find_row(const qc_symbolic *S, int32_t s, int32_t row) {
    int64_t lo = S->rowptr[s], hi = S->rowptr[s + 1];
    while (hi - lo > 1) {
        const int64_t middle = lo + (hi - lo) / 2;
        if (S->rows[middle] <= row)
            lo = middle;
        else
            hi = middle;
    }
    return S->rows[lo] == row ? lo - S->rowptr[s] : -1;
}

/* Lowest permuted row, after checking that all rows fit the column of L which belongs to it. */
static qc_status first_row(qc_ctx *ctx, const qc_symbolic *S, int32_t nw, const int32_t *row,
                           int32_t *out) {
    int32_t lowest = S->n;
    for (int32_t i = 0; i < nw; i++) {
        if (row[i] < 0 || row[i] >= S->n)
            return qc__fail(ctx, QC_ERR_ARGUMENT, row[i], "update has row %d of %d", (int)row[i],
                            (int)S->n);
        if (S->inverse[row[i]] < lowest) lowest = S->inverse[row[i]];
    }
    for (int32_t i = 0; i < nw; i++)
        if (find_row(S, S->super_of[lowest], S->inverse[row[i]]) < 0)
            return qc__fail(ctx, QC_ERR_ARGUMENT, row[i],
                            "rows %d and %d of an update are not connected in the matrix",
                            (int)S->perm[lowest], (int)row[i]);
    *out = lowest;
    return QC_OK;
}

/* w: vectors x nw. change_diagonal: add sigma |w|^2 to the diagonal of A (a flip leaves it). */
static qc_status update(qc_ctx *ctx, qc_factor *F, int vectors, const double *sigma, int32_t nw,
                        const int32_t *row, const double *w, const double *diagonal_change) {
    const qc_symbolic *S = F->S;
    int32_t lowest = 0;
    if (nw == 0) return QC_OK;
    qc_status status = first_row(ctx, S, nw, row, &lowest);
    if (status != QC_OK) return status;
    const int32_t s = S->super_of[lowest];
    const int64_t front = NC * (int64_t)S->plan.largest_front;
    status = qc__journal_open(ctx, F, s);
    if (status != QC_OK) return status;
    double *work = QC__NEW(ctx, double, 2 * vectors * front);
    if (!work) return QC_ERR_NOMEM;
    sweep W = {F, vectors, {0, 0}, 0, {work, work}, {work, work}};
    for (int64_t i = 0; i < NC * (int64_t)vectors * nw; i++)
        W.negligible = fmax(W.negligible, 1e-80 * fabs(w[i]));
    for (int q = 0; q < vectors; q++) {
        W.a[q] = sigma[q];
        W.v[q] = work + 2 * q * front;
        W.next[q] = W.v[q] + front;
        memset(W.v[q], 0, (size_t)(NC * (S->rowptr[s + 1] - S->rowptr[s])) * sizeof *work);
        for (int32_t i = 0; i < nw; i++)
            for (int c = 0; c < NC; c++)
                W.v[q][NC * find_row(S, s, S->inverse[row[i]]) + c] +=
                    w[NC * ((int64_t)q * nw + i) + c];
    }
    const int32_t bad = sweep_path(&W, s, lowest, diagonal_change, row, nw);
    if (bad >= 0) {
        qc__journal_roll_back(F);
        status = qc__fail(ctx, QC_ERR_NOT_POSDEF, S->perm[bad],
                          "update would make the matrix indefinite at row %d; the factor is as "
                          "before",
                          (int)S->perm[bad]);
    }
    for (int32_t i = 0; bad < 0 && diagonal_change && i < nw; i++)
        F->diagonal[S->inverse[row[i]]] += diagonal_change[i];
    qc__free(work);
    return status;
}

qc_status NAME(qc_updown)(qc_ctx *ctx, qc_factor *F, int sigma, int32_t nw, const int32_t *row,
                          const scalar *w) {
    qc_status status = qc__factor_check(ctx, F, NC, true);
    if (status != QC_OK) return status;
    if ((sigma != 1 && sigma != -1) || nw < 0 || (nw > 0 && (!row || !w)))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "update needs sigma = 1 or -1 and a vector");
    const double sign = sigma;
    const double *x = (const double *)w;
    double *change = QC__NEW(ctx, double, nw);
    if (!change) return QC_ERR_NOMEM;
    for (int64_t i = 0; i < nw; i++) {
        change[i] = sign * x[NC * i] * x[NC * i];
        if (NC == 2) change[i] += sign * x[NC * i + NC - 1] * x[NC * i + NC - 1];
    }
    status = update(ctx, F, 1, &sign, nw, row, x, change);
    qc__free(change);
    return status;
}

#ifndef QC__REAL
/* D has the eigenvalues +-c, c^2 = |dl|^2 + |dm|^2, with the vectors (+-c, conj(dl), conj(dm)) /
 * (c sqrt 2): D x = lambda x reads dl y + dm z = lambda x, conj(dl) x = lambda y and so on. Hence
 * D = w+ w+^H - w- w-^H with w+- = (+-c, conj(dl), conj(dm)) / sqrt(2 c). */
qc_status qc_flip(qc_ctx *ctx, qc_factor *F, int32_t k, int32_t l, qc_complex dl, int32_t m,
                  qc_complex dm) {
    const qc_status status = qc__factor_check(ctx, F, NC, true);
    if (status != QC_OK) return status;
    if (k == l || k == m)
        return qc__fail(ctx, QC_ERR_ARGUMENT, k, "flip couples row %d with itself", (int)k);
    int32_t rows[MOST_ROWS] = {k, l, m}, nw = 3;
    if (l == m) {
        dl = (qc_complex){dl.re + dm.re, dl.im + dm.im};
        dm = (qc_complex){0, 0};
        nw = 2;
    }
    const double c = hypot(hypot(dl.re, dl.im), hypot(dm.re, dm.im));
    if (c == 0) return QC_OK;
    const double sigma[2] = {1, -1}, scale = 1 / sqrt(2 * c);
    double w[4 * MOST_ROWS];
    for (int q = 0; q < 2; q++) {
        double *x = w + 2 * (int64_t)q * nw;
        x[0] = sigma[q] * c * scale;
        x[1] = 0;
        x[2] = dl.re * scale;
        x[3] = -dl.im * scale;
        if (nw == 2) continue;
        x[4] = dm.re * scale;
        x[5] = -dm.im * scale;
    }
    return update(ctx, F, 2, sigma, nw, rows, w, NULL);
}
#endif
