/* Assembly in linear time: couplings are bucketed by row, then the rows are dealt out to the
 * columns in order, which leaves each column sorted and equal entries adjacent. */
#include "sdk/dec/assemble.h"

typedef struct assembly {
    int32_t n_faces;
    const double *cotangent;
    const int32_t *entity, *unknown;
    const int8_t *turn;
    double scale;
    int32_t n;
    int64_t *start;  /* n + 1: couplings of row i with later columns  */
    int32_t *column; /* by row */
    qc_complex *value;
    double *diagonal; /* n */
} assembly;

/* The coupling across corner k of face t: local values i, j. False when one of them is fixed. */
static bool coupling(const assembly *a, int32_t t, int k, int32_t *row, int32_t *col,
                     qc_complex *value) {
    const int32_t i = 3 * t + (k + 1) % 3, j = 3 * t + (k + 2) % 3;
    *row = a->unknown[a->entity[i]];
    *col = a->unknown[a->entity[j]];
    if (*row < 0 || *col < 0) return false;
    int32_t turn = a->turn ? a->turn[j] - a->turn[i] : 0;
    if (*row > *col) {
        const int32_t swap = *row;
        *row = *col;
        *col = swap;
        turn = -turn;
    }
    const qc_complex c = {-a->scale * a->cotangent[3 * t + k], 0};
    *value = qc_quarter_turn(c, turn);
    return true;
}

static void add_diagonal(assembly *a) {
    for (int32_t i = 0; i < a->n; i++) a->diagonal[i] = 0;
    for (int32_t h = 0; h < 3 * a->n_faces; h++) {
        const int32_t i = a->unknown[a->entity[h]];
        if (i >= 0)
            a->diagonal[i] += a->scale * (a->cotangent[qc_next(h)] + a->cotangent[qc_prev(h)]);
    }
}

/* start[i + 1] = end of row i after the fill, as start[i] is moved along. */
static qc_status bucket_rows(qc_ctx *ctx, assembly *a) {
    int32_t row, col;
    qc_complex value;
    const int32_t n_faces = a->n_faces;
    for (int32_t i = 0; i <= a->n; i++) a->start[i] = 0;
    for (int32_t t = 0; t < n_faces; t++)
        for (int k = 0; k < 3; k++)
            if (coupling(a, t, k, &row, &col, &value)) a->start[row + 1]++;
    for (int32_t i = 0; i < a->n; i++) a->start[i + 1] += a->start[i];
    a->column = QC__NEW(ctx, int32_t, a->start[a->n]);
    a->value = QC__NEW(ctx, qc_complex, a->start[a->n]);
    if (!a->column || !a->value) return QC_ERR_NOMEM;
    for (int32_t t = 0; t < n_faces; t++)
        for (int k = 0; k < 3; k++) {
            if (!coupling(a, t, k, &row, &col, &value)) continue;
            const int64_t place = a->start[row]++;
            a->column[place] = col;
            a->value[place] = value;
        }
    for (int32_t i = a->n; i > 0; i--) a->start[i] = a->start[i - 1];
    a->start[0] = 0;
    return QC_OK;
}

/* colptr: size of every column, equal entries counted once; last: n, workspace. */
static void count_columns(const assembly *a, int32_t *last, int64_t *colptr) {
    for (int32_t j = 0; j < a->n; j++) last[j] = -1;
    for (int32_t j = 0; j < a->n; j++) colptr[j + 1] = 1;
    colptr[0] = 0;
    for (int32_t i = 0; i < a->n; i++)
        for (int64_t p = a->start[i]; p < a->start[i + 1]; p++) {
            const int32_t j = a->column[p];
            if (last[j] == i) continue;
            last[j] = i;
            colptr[j + 1]++;
        }
    for (int32_t j = 0; j < a->n; j++) colptr[j + 1] += colptr[j];
}

/* next: n, workspace. */
static void fill_columns(const assembly *a, int64_t *next, const int64_t *colptr, int32_t *row,
                         qc_complex *val) {
    for (int32_t j = 0; j < a->n; j++) next[j] = colptr[j];
    for (int32_t i = 0; i < a->n; i++)
        for (int64_t p = a->start[i]; p < a->start[i + 1]; p++) {
            const int32_t j = a->column[p];
            if (next[j] > colptr[j] && row[next[j] - 1] == i) {
                val[next[j] - 1] = qc__add(val[next[j] - 1], a->value[p]);
            } else {
                row[next[j]] = i;
                val[next[j]++] = a->value[p];
            }
        }
    for (int32_t j = 0; j < a->n; j++) {
        row[next[j]] = j;
        val[next[j]] = (qc_complex){a->diagonal[j], 0};
    }
}

static qc_status make_columns(qc_ctx *ctx, const assembly *a, qc_hermitian *out) {
    int64_t *next = QC__NEW(ctx, int64_t, a->n), *colptr = QC__NEW(ctx, int64_t, a->n + 1);
    int32_t *last = QC__NEW(ctx, int32_t, a->n), *row = NULL;
    qc_complex *val = NULL;
    if (next && colptr && last) {
        count_columns(a, last, colptr);
        row = QC__NEW(ctx, int32_t, colptr[a->n]);
        val = QC__NEW(ctx, qc_complex, colptr[a->n]);
    }
    const bool done = row && val;
    if (done) fill_columns(a, next, colptr, row, val);
    qc__free(next);
    qc__free(last);
    out->n = a->n;
    out->colptr = colptr;
    out->row = row;
    out->val = val;
    return done ? QC_OK : QC_ERR_NOMEM;
}

qc_status qc__assemble(qc_ctx *ctx, int32_t n_faces, const double *cotangent, double scale,
                       const int32_t *entity, const int8_t *turn, int32_t n, qc_stiffness *out) {
    assembly a = {n_faces, cotangent, entity, out->unknown, turn, scale, n, NULL, NULL, NULL, NULL};
    a.start = QC__NEW(ctx, int64_t, (size_t)n + 1);
    a.diagonal = QC__NEW(ctx, double, n);
    qc_status status = a.start && a.diagonal ? bucket_rows(ctx, &a) : QC_ERR_NOMEM;
    if (status == QC_OK && !qc__progress(ctx, 0.5)) status = QC_ERR_CANCELLED;
    if (status == QC_OK) {
        add_diagonal(&a);
        status = qc__poll(ctx);
    }
    if (status == QC_OK) status = make_columns(ctx, &a, &out->A);
    qc__free(a.start);
    qc__free(a.column);
    qc__free(a.value);
    qc__free(a.diagonal);
    return status;
}
