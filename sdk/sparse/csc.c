/* Compressed-column patterns: check, permute, transpose. */
#include "sdk/sparse/internal.h"
#include <string.h>

static qc_status check_column(qc_ctx *ctx, qc__pattern A, int32_t j) {
    const int64_t begin = A.colptr[j], end = A.colptr[j + 1];
    for (int64_t p = begin; p < end; p++) {
        const int32_t i = A.row[p];
        if (i < 0 || i > j)
            return qc__fail(ctx, QC_ERR_ARGUMENT, j,
                            "column %d of the matrix has row %d: only the upper triangle is stored",
                            (int)j, (int)i);
        if (p > begin && A.row[p - 1] >= i)
            return qc__fail(ctx, QC_ERR_ARGUMENT, j,
                            "rows of column %d of the matrix are not sorted and unique", (int)j);
    }
    if (end == begin || A.row[end - 1] != j)
        return qc__fail(ctx, QC_ERR_ARGUMENT, j, "column %d of the matrix has no diagonal entry",
                        (int)j);
    return QC_OK;
}

qc_status qc__check_pattern(qc_ctx *ctx, qc__pattern A) {
    if (A.n < 0 || !A.colptr || A.colptr[0] != 0)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "matrix needs n >= 0 and column pointers which start with 0");
    for (int32_t j = 0; j < A.n; j++)
        if (A.colptr[j + 1] < A.colptr[j])
            return qc__fail(ctx, QC_ERR_ARGUMENT, j, "column pointers decrease at column %d",
                            (int)j);
    if (A.colptr[A.n] > 0 && !A.row)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "matrix has entries but no row array");
    for (int32_t j = 0; j < A.n; j++) {
        const qc_status status = check_column(ctx, A, j);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}

/* Counts in ptr[0..n) become starts; ptr[n] the total. */
static void cumulate(int32_t n, int64_t *ptr) {
    int64_t sum = 0;
    for (int32_t j = 0; j <= n; j++) {
        const int64_t count = ptr[j];
        ptr[j] = sum;
        sum += count;
    }
}

/* Filling has moved every start to the next one: move them back. */
static void rewind_starts(int32_t n, int64_t *ptr) {
    memmove(ptr + 1, ptr, (size_t)n * sizeof *ptr);
    ptr[0] = 0;
}

qc_status qc__permute_upper_from(qc_ctx *ctx, qc__pattern A, const int32_t *inverse,
                                 int64_t **colptr, int32_t **row, int64_t **source) {
    const int32_t n = A.n;
    int64_t *ptr = QC__ZERO(ctx, int64_t, n + 1);
    int32_t *out = QC__NEW(ctx, int32_t, A.colptr[n] - n);
    int64_t *from = source ? QC__NEW(ctx, int64_t, A.colptr[n] - n) : NULL;
    if (!ptr || !out || (source && !from)) {
        qc__free(ptr);
        qc__free(out);
        qc__free(from);
        return QC_ERR_NOMEM;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t j = 0; j < n; j++) {
            const int32_t b = inverse[j];
            for (int64_t p = A.colptr[j]; p < A.colptr[j + 1] - 1;
                 p++) { /* the last one is (j, j) */
                const int32_t a = inverse[A.row[p]];
                const int64_t q = ptr[a > b ? a : b]++;
                if (pass == 0) continue;
                out[q] = a < b ? a : b;
                if (from) from[q] = a > b ? p : ~p;
            }
        }
        if (pass == 0) cumulate(n, ptr);
    }
    rewind_starts(n, ptr);
    *colptr = ptr;
    *row = out;
    if (source) *source = from;
    return QC_OK;
}

qc_status qc__permute_upper(qc_ctx *ctx, qc__pattern A, const int32_t *inverse, int64_t **colptr,
                            int32_t **row) {
    return qc__permute_upper_from(ctx, A, inverse, colptr, row, NULL);
}

qc_status qc__transpose_renumbered(qc_ctx *ctx, qc__pattern A, const int32_t *order,
                                   const int32_t *number, int64_t **colptr, int32_t **row) {
    const int32_t n = A.n;
    int64_t *ptr = QC__ZERO(ctx, int64_t, n + 1);
    int32_t *out = QC__NEW(ctx, int32_t, A.colptr[n]);
    if (!ptr || !out) {
        qc__free(ptr);
        qc__free(out);
        return QC_ERR_NOMEM;
    }
    for (int64_t p = 0; p < A.colptr[n]; p++) ptr[number ? number[A.row[p]] : A.row[p]]++;
    cumulate(n, ptr);
    for (int32_t k = 0; k < n; k++) {
        const int32_t j = order ? order[k] : k;
        for (int64_t p = A.colptr[j]; p < A.colptr[j + 1]; p++)
            out[ptr[number ? number[A.row[p]] : A.row[p]]++] = k;
    }
    rewind_starts(n, ptr);
    *colptr = ptr;
    *row = out;
    return QC_OK;
}

qc_status qc__transpose(qc_ctx *ctx, qc__pattern A, int64_t **colptr, int32_t **row) {
    return qc__transpose_renumbered(ctx, A, NULL, NULL, colptr, row);
}
