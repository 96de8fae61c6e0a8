/* Symbolic analysis: order, elimination tree, supernodes, row structure, where each entry of A
 * goes, and the schedule of the factorisation. */
#include "sdk/sparse/internal.h"
#include <string.h>

void qc_symbolic_free(qc_symbolic *S) {
    if (!S || atomic_fetch_sub_explicit(&S->references, 1, memory_order_acq_rel) > 1) return;
    void *arrays[] = {S->perm,    S->inverse, S->super, S->super_of, S->parent, S->child,
                      S->sibling, S->rowptr,  S->rows,  S->relative, S->panel,  S->a_colptr,
                      S->a_row,   S->entry,   S->from,  S->to};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) qc__free(arrays[i]);
    qc__plan_free(&S->plan);
    qc__free(S->solve.node);
    qc__free(S->solve.target);
    qc__free(S);
}

qc_symbolic *qc__symbolic_retain(const qc_symbolic *S) {
    qc_symbolic *self = (qc_symbolic *)(uintptr_t)S; /* the count is the one mutable member */
    atomic_fetch_add_explicit(&self->references, 1, memory_order_relaxed);
    return self;
}

static bool allocate(qc_ctx *ctx, qc_symbolic *S) {
    const int64_t n = S->n;
    return (S->perm = QC__NEW(ctx, int32_t, n)) && (S->inverse = QC__NEW(ctx, int32_t, n)) &&
           (S->super = QC__NEW(ctx, int32_t, n + 1)) && (S->super_of = QC__NEW(ctx, int32_t, n)) &&
           (S->parent = QC__NEW(ctx, int32_t, n)) && (S->child = QC__NEW(ctx, int32_t, n)) &&
           (S->sibling = QC__NEW(ctx, int32_t, n)) && (S->rowptr = QC__NEW(ctx, int64_t, n + 1)) &&
           (S->panel = QC__NEW(ctx, int64_t, n + 1));
}

/* perm <- perm composed with a postorder of its elimination tree; parent in the new numbering. */
static void apply_postorder(qc_symbolic *S, const int32_t *post, int32_t *parent, int32_t *work) {
    const int32_t n = S->n;
    int32_t *place = work, *copy = work + n;
    for (int32_t k = 0; k < n; k++) place[post[k]] = k;
    for (int32_t k = 0; k < n; k++) copy[k] = S->perm[post[k]];
    memcpy(S->perm, copy, (size_t)n * sizeof *copy);
    for (int32_t k = 0; k < n; k++) copy[k] = parent[post[k]];
    for (int32_t k = 0; k < n; k++) parent[k] = copy[k] == -1 ? -1 : place[copy[k]];
    for (int32_t k = 0; k < n; k++) S->inverse[S->perm[k]] = k;
}

/* work: parent n, count n, 5 n free */
static qc_status eliminate(qc_ctx *ctx, qc__pattern A, qc_symbolic *S, int32_t *work) {
    const int32_t n = S->n;
    int32_t *parent = work, *count = work + n, *free_work = work + 2 * (int64_t)n;
    int64_t *colptr = NULL, *lower_ptr = NULL;
    int32_t *row = NULL, *lower_row = NULL;
    qc_status status = qc__permute_upper(ctx, A, S->inverse, &colptr, &row);
    if (status != QC_OK) return status;
    qc__etree((qc__pattern){n, colptr, row}, parent, free_work);
    qc__postorder(n, parent, free_work, free_work + n);
    apply_postorder(S, free_work, parent, free_work + n);
    qc__free(colptr);
    qc__free(row);
    colptr = NULL;
    row = NULL;
    status = qc__permute_upper(ctx, A, S->inverse, &colptr, &row);
    if (status == QC_OK)
        status = qc__transpose(ctx, (qc__pattern){n, colptr, row}, &lower_ptr, &lower_row);
    if (status == QC_OK) {
        qc__column_counts((qc__pattern){n, lower_ptr, lower_row}, parent, count, free_work);
        for (int32_t j = 0; j < n; j++) {
            const double c = count[j] - 1;
            S->nnz_l += count[j];
            S->flops += c * (c + 1) + c;
        }
        status = qc__supernodes(ctx, S, parent, count);
    }
    qc__free(colptr);
    qc__free(row);
    qc__free(lower_ptr);
    qc__free(lower_row);
    return status;
}

/* Row i of L visits the supernodes on the paths from its entries in A to the supernode of i; taking
 * the rows in order leaves every list sorted. */
static qc_status fill_rows(qc_ctx *ctx, qc__pattern A, qc_symbolic *S, int32_t *mark) {
    const int32_t n = S->n, ns = S->nsuper;
    int64_t *colptr = NULL, *next = QC__NEW(ctx, int64_t, ns);
    int32_t *row = NULL;
    S->rows = QC__NEW(ctx, int32_t, S->rowptr[ns]);
    qc_status status = QC_ERR_NOMEM;
    if (next && S->rows) status = qc__permute_upper(ctx, A, S->inverse, &colptr, &row);
    if (status == QC_OK) {
        for (int32_t s = 0; s < ns; s++) {
            next[s] = S->rowptr[s];
            mark[s] = -1;
            for (int32_t k = S->super[s]; k < S->super[s + 1]; k++) S->rows[next[s]++] = k;
        }
        for (int32_t i = 0; i < n; i++) {
            mark[S->super_of[i]] = i;
            for (int64_t p = colptr[i]; p < colptr[i + 1]; p++)
                for (int32_t s = S->super_of[row[p]]; mark[s] != i; s = S->parent[s]) {
                    S->rows[next[s]++] = i;
                    mark[s] = i;
                }
        }
    }
    qc__free(colptr);
    qc__free(row);
    qc__free(next);
    return status;
}

/* Local row in the parent's list of each row below the diagonal block: both lists ascend. */
static qc_status fill_relative(qc_ctx *ctx, qc_symbolic *S) {
    S->relative = QC__NEW(ctx, int32_t, S->rowptr[S->nsuper]);
    if (!S->relative) return QC_ERR_NOMEM;
    for (int32_t s = 0; s < S->nsuper; s++) {
        const int32_t w = S->super[s + 1] - S->super[s], p = S->parent[s];
        const int32_t *up = p == -1 ? NULL : S->rows + S->rowptr[p];
        int32_t local = 0;
        for (int64_t q = S->rowptr[s]; q < S->rowptr[s + 1]; q++) {
            S->relative[q] = -1;
            if (q < S->rowptr[s] + w) continue;
            while (up[local] != S->rows[q]) local++;
            S->relative[q] = local;
        }
    }
    return QC_OK;
}

static int64_t local_row(const qc_symbolic *S, int32_t s, int32_t row) {
    int64_t lo = S->rowptr[s], hi = S->rowptr[s + 1];
    const int32_t w = S->super[s + 1] - S->super[s];
    if (row < S->super[s + 1]) return row - S->super[s];
    lo += w;
    while (hi - lo > 1) {
        const int64_t middle = lo + (hi - lo) / 2;
        if (S->rows[middle] <= row)
            lo = middle;
        else
            hi = middle;
    }
    return lo - S->rowptr[s];
}

/* The entries of A sorted by supernode, with their place in its panel. */
static qc_status map_entries(qc_ctx *ctx, qc__pattern A, qc_symbolic *S) {
    const int32_t n = S->n, ns = S->nsuper;
    const int64_t nnz = A.colptr[n];
    for (int32_t s = 0; s < ns; s++)
        if (nnz > UINT32_MAX || S->panel[s + 1] - S->panel[s] > INT32_MAX)
            return qc__fail(ctx, QC_ERR_UNSUPPORTED, -1,
                            "matrix is too large: more than 2^32 entries, or 2^31 in one front");
    S->a_colptr = QC__NEW(ctx, int64_t, n + 1);
    S->a_row = QC__NEW(ctx, int32_t, nnz);
    S->entry = QC__ZERO(ctx, int64_t, ns + 1);
    S->from = QC__ZERO(ctx, uint32_t, nnz + QC__AHEAD);
    S->to = QC__NEW(ctx, int32_t, nnz);
    if (!S->a_colptr || !S->a_row || !S->entry || !S->from || !S->to) return QC_ERR_NOMEM;
    memcpy(S->a_colptr, A.colptr, ((size_t)n + 1) * sizeof *A.colptr);
    if (nnz > 0) memcpy(S->a_row, A.row, (size_t)nnz * sizeof *A.row);
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t j = 0; j < n; j++)
            for (int64_t p = A.colptr[j]; p < A.colptr[j + 1]; p++) {
                const int32_t a = S->inverse[A.row[p]], b = S->inverse[j];
                const int32_t row = a > b ? a : b, column = a > b ? b : a, s = S->super_of[column];
                if (pass == 0) {
                    S->entry[s]++;
                    continue;
                }
                const int64_t q = S->entry[s]++, r = S->rowptr[s + 1] - S->rowptr[s];
                const int32_t offset = (int32_t)((column - S->super[s]) * r + local_row(S, s, row));
                S->from[q] = (uint32_t)p;
                S->to[q] = a > b ? offset : ~offset; /* A(a,b) lies above the diagonal: conjugate */
            }
        for (int64_t s = 0, sum = 0; pass == 0 && s <= ns; s++) {
            const int64_t count = S->entry[s];
            S->entry[s] = sum;
            sum += count;
        }
    }
    memmove(S->entry + 1, S->entry, (size_t)ns * sizeof *S->entry);
    S->entry[0] = 0;
    return QC_OK;
}

static qc_status analyze(qc_ctx *ctx, qc__pattern A, const qc_analyze_options *options,
                         qc_symbolic *S) {
    int32_t *work = QC__NEW(ctx, int32_t, 7 * (int64_t)S->n);
    if (!work) return QC_ERR_NOMEM;
    qc_status status = allocate(ctx, S) ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK && !qc__progress(ctx, 0.0)) status = QC_ERR_CANCELLED;
    if (status == QC_OK) status = qc__order(ctx, A, options, S->perm);
    if (status == QC_OK && !qc__progress(ctx, 0.6)) status = QC_ERR_CANCELLED;
    if (status == QC_OK) {
        for (int32_t k = 0; k < S->n; k++) S->inverse[S->perm[k]] = k;
        status = eliminate(ctx, A, S, work);
    }
    if (status == QC_OK && !qc__progress(ctx, 0.8)) status = QC_ERR_CANCELLED;
    if (status == QC_OK) status = fill_rows(ctx, A, S, work);
    if (status == QC_OK) status = fill_relative(ctx, S);
    if (status == QC_OK) status = map_entries(ctx, A, S);
    if (status == QC_OK) status = qc__plan_create(ctx, S);
    if (status == QC_OK) status = qc__solve_plan_create(ctx, S);
    if (status == QC_OK && !qc__progress(ctx, 1.0)) status = QC_ERR_CANCELLED;
    qc__free(work);
    return status;
}

static qc_status create(qc_ctx *ctx, qc__pattern A, const qc_analyze_options *options,
                        qc_symbolic **out) {
    qc_status status = qc__check_pattern(ctx, A);
    if (status != QC_OK) return status;
    qc_symbolic *S = QC__ZERO(ctx, qc_symbolic, 1);
    if (!S) return QC_ERR_NOMEM;
    atomic_init(&S->references, 1);
    S->n = A.n;
    status = analyze(ctx, A, options, S);
    if (status == QC_OK)
        *out = S;
    else
        qc_symbolic_free(S);
    return status;
}

qc_status qc_analyze(qc_ctx *ctx, const qc_hermitian *A, const qc_analyze_options *options,
                     qc_symbolic **out) {
    return create(ctx, (qc__pattern){A->n, A->colptr, A->row}, options, out);
}

qc_status qc_analyze_real(qc_ctx *ctx, const qc_symmetric *A, const qc_analyze_options *options,
                          qc_symbolic **out) {
    return create(ctx, (qc__pattern){A->n, A->colptr, A->row}, options, out);
}

void qc_symbolic_get_permutation(const qc_symbolic *S, int32_t *permutation) {
    if (S->n > 0) memcpy(permutation, S->perm, (size_t)S->n * sizeof *permutation);
}

void qc_symbolic_get_info(const qc_symbolic *S, qc_symbolic_info *info) {
    qc_symbolic_info all = {sizeof all, S->n, S->nsuper, S->plan.largest_front, S->nnz_l, 0,
                            S->flops,   0,    0};
    for (int32_t s = 0; s < S->nsuper; s++) {
        const int64_t w = S->super[s + 1] - S->super[s], r = S->rowptr[s + 1] - S->rowptr[s];
        all.stored += w * r - w * (w - 1) / 2;
    }
    const int64_t panels = S->panel[S->nsuper], vectors = 16 * (int64_t)S->n;
    all.bytes_real = 8 * panels + vectors;
    all.bytes_complex = 16 * panels + vectors;
    const uint32_t size = info->struct_size < sizeof all ? info->struct_size : (uint32_t)sizeof all;
    memcpy((char *)info + sizeof size, (const char *)&all + sizeof size,
           size > sizeof size ? size - sizeof size : 0);
}
