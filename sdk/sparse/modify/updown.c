/* Modifications of a factor: rank 1, rank k, and the flip of a matching as a case of rank 2. */
#include "sdk/sparse/modify/modify.h"

enum { MOST_ROWS = 3 }; /* of a flip */

static qc_status modify(qc_ctx *ctx, qc_factor *F, const qc__change *change) {
    qc_status status = qc__modify_open(ctx, F);
    if (status != QC_OK) return status;
    qc__journal_begin(F);
    status = qc__sweep(ctx, F, change);
    if (status == QC_OK) F->modify->journal.undoable = true;
    return status;
}

static qc_status many(qc_ctx *ctx, qc_factor *F, int32_t components, const qc__change *change) {
    const qc_status status = qc__factor_check(ctx, F, components, true);
    if (status != QC_OK) return status;
    const int32_t k = change->vectors;
    if (k < 0 || (k > 0 && (!change->sigma || !change->start)))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "update needs vectors with signs");
    for (int32_t q = 0; q < k; q++) {
        const bool empty = change->start[q] == change->start[q + 1];
        if ((change->sigma[q] != 1 && change->sigma[q] != -1) || change->start[0] < 0 ||
            change->start[q] > change->start[q + 1] || (!empty && (!change->row || !change->w)))
            return qc__fail(ctx, QC_ERR_ARGUMENT, q,
                            "update needs sigma = 1 or -1 and a vector (number %d)", (int)q);
    }
    return modify(ctx, F, change);
}

qc_status qc_updown_many(qc_ctx *ctx, qc_factor *F, int32_t k, const int *sigma,
                         const int32_t *start, const int32_t *row, const qc_complex *w) {
    const qc__change change = {k, sigma, start, row, (const double *)w, true};
    return many(ctx, F, 2, &change);
}

qc_status qc_updown_many_real(qc_ctx *ctx, qc_factor *F, int32_t k, const int *sigma,
                              const int32_t *start, const int32_t *row, const double *w) {
    const qc__change change = {k, sigma, start, row, w, true};
    return many(ctx, F, 1, &change);
}

qc_status qc_updown(qc_ctx *ctx, qc_factor *F, int sigma, int32_t nw, const int32_t *row,
                    const qc_complex *w) {
    const int32_t start[2] = {0, nw};
    return qc_updown_many(ctx, F, 1, &sigma, start, row, w);
}

qc_status qc_updown_real(qc_ctx *ctx, qc_factor *F, int sigma, int32_t nw, const int32_t *row,
                         const double *w) {
    const int32_t start[2] = {0, nw};
    return qc_updown_many_real(ctx, F, 1, &sigma, start, row, w);
}

/* D has the eigenvalues +-c, c^2 = |dl|^2 + |dm|^2, with the vectors (+-c, conj(dl), conj(dm)) /
 * (c sqrt 2): D x = lambda x reads dl y + dm z = lambda x, conj(dl) x = lambda y and so on. Hence
 * D = w+ w+^H - w- w-^H with w+- = (+-c, conj(dl), conj(dm)) / sqrt(2 c). */
qc_status qc_flip(qc_ctx *ctx, qc_factor *F, int32_t k, int32_t l, qc_complex dl, int32_t m,
                  qc_complex dm) {
    const qc_status status = qc__factor_check(ctx, F, 2, true);
    if (status != QC_OK) return status;
    if (k == l || k == m)
        return qc__fail(ctx, QC_ERR_ARGUMENT, k, "flip couples row %d with itself", (int)k);
    int32_t rows[2 * MOST_ROWS], nw = 3;
    if (l == m) {
        dl = (qc_complex){dl.re + dm.re, dl.im + dm.im};
        nw = 2;
    }
    const double size = hypot(dl.re, dl.im), c = nw == 2 ? size : hypot(size, hypot(dm.re, dm.im));
    if (c == 0) return modify(ctx, F, &(qc__change){0});
    const int sigma[2] = {1, -1};
    const int32_t start[3] = {0, nw, 2 * nw};
    const double scale = 1 / sqrt(2 * c);
    double w[4 * MOST_ROWS];
    for (int32_t q = 0; q < 2; q++) {
        const double vector[2 * MOST_ROWS] = {
            sigma[q] * c * scale, 0, dl.re * scale, -dl.im * scale, dm.re * scale, -dm.im * scale};
        const int32_t row[MOST_ROWS] = {k, l, m};
        for (int32_t i = 0; i < nw; i++) rows[q * nw + i] = row[i];
        for (int32_t i = 0; i < 2 * nw; i++) w[2 * q * nw + i] = vector[i];
    }
    return modify(ctx, F, &(qc__change){2, sigma, start, rows, w, false});
}
