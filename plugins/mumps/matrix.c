/* From compressed columns of an upper triangle to the coordinates MUMPS wants, and the order. */
#include <stdlib.h>
#include "solver.h"

qc_status qm_check_pattern(qc_ctx *ctx, const qc_hermitian *A) {
    if (A->n < 0 || !A->colptr || A->colptr[0] != 0 || (A->n > 0 && !A->row))
        return qc_ctx_fail(ctx, QC_ERR_ARGUMENT, -1, "solver mumps: the matrix has no pattern");
    for (int32_t j = 0; j < A->n; j++) {
        const int64_t begin = A->colptr[j], end = A->colptr[j + 1];
        bool good = begin < end && A->row[end - 1] == j && A->row[begin] >= 0;
        for (int64_t p = begin + 1; p < end && good; p++) good = A->row[p - 1] < A->row[p];
        if (!good)
            return qc_ctx_fail(ctx, QC_ERR_ARGUMENT, j,
                               "solver mumps: a column needs ascending rows of the upper triangle, "
                               "the diagonal last");
    }
    return QC_OK;
}

/* The upper triangle in its own order, then the entries off the diagonal again, transposed. */
void qm_write_pattern(const qc_hermitian *A, MUMPS_INT *irn, MUMPS_INT *jcn) {
    int64_t q = A->colptr[A->n];
    for (int32_t j = 0; j < A->n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            irn[p] = A->row[p] + 1;
            jcn[p] = j + 1;
            if (A->row[p] == j) continue;
            irn[q] = j + 1;
            jcn[q++] = A->row[p] + 1;
        }
}

void qm_write_values(const qc_hermitian *A, mumps_double_complex *a) {
    int64_t q = A->colptr[A->n];
    for (int32_t j = 0; j < A->n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const bool diagonal = A->row[p] == j;
            a[p].r = A->val[p].re;
            a[p].i = diagonal ? 0 : A->val[p].im;
            if (diagonal) continue;
            a[q].r = A->val[p].re;
            a[q++].i = -A->val[p].im;
        }
}

bool qm_same_pattern(const qc_solver_state *s, const qc_hermitian *A) {
    if (A->n != s->n || A->colptr[A->n] != s->nnz) return false;
    for (int32_t j = 0; j < A->n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (s->irn[p] != A->row[p] + 1 || s->jcn[p] != j + 1) return false;
    return true;
}

/* Nested dissection of the SDK: PERM_IN(i) = position of row i. MUMPS's own (PORD) leaves no
 * less fill and takes several times as long. */
qc_status qm_order(qc_ctx *ctx, const qc_hermitian *A, MUMPS_INT *position) {
    qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
    qc_symbolic *symbolic = NULL;
    options.ordering = QC_ORDER_DISSECTION;
    const qc_status status = qc_analyze(ctx, A, &options, &symbolic);
    if (status != QC_OK) return status;
    int32_t *row = malloc((size_t)A->n * sizeof *row);
    if (row) qc_symbolic_get_permutation(symbolic, row);
    for (int32_t k = 0; row && k < A->n; k++) position[row[k]] = k + 1;
    free(row);
    qc_symbolic_free(symbolic);
    return row ? QC_OK : qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
}
