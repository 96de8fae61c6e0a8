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

/* The strictly upper triangle of P A P^T in the numbering which qc__order gave (`first`), with the
 * places its entries have in A. Later numberings only move descendants before ancestors: an upper
 * triangle stays one, hence it is made once. */
typedef struct permuted {
    int64_t *colptr, *source;
    int32_t *row;
    int32_t *perm; /* of the first numbering */
} permuted;

static void free_permuted(permuted *U) {
    qc__free(U->colptr);
    qc__free(U->source);
    qc__free(U->row);
    qc__free(U->perm);
}

static qc_status permute(qc_ctx *ctx, qc__pattern A, qc_symbolic *S, permuted *U) {
    U->perm = QC__NEW(ctx, int32_t, S->n);
    if (!U->perm) return QC_ERR_NOMEM;
    for (int32_t k = 0; k < S->n; k++) S->inverse[U->perm[k] = S->perm[k]] = k;
    return qc__permute_upper_from(ctx, A, S->inverse, &U->colptr, &U->row, &U->source);
}

/* perm <- perm composed with a postorder of its elimination tree; parent in the new numbering;
 * place[post[k]] = k. */
static void apply_postorder(qc_symbolic *S, const int32_t *post, int32_t *place, int32_t *parent,
                            int32_t *copy) {
    const int32_t n = S->n;
    for (int32_t k = 0; k < n; k++) place[post[k]] = k;
    for (int32_t k = 0; k < n; k++) copy[k] = S->perm[post[k]];
    memcpy(S->perm, copy, (size_t)n * sizeof *copy);
    for (int32_t k = 0; k < n; k++) copy[k] = parent[post[k]];
    for (int32_t k = 0; k < n; k++) parent[k] = copy[k] == -1 ? -1 : place[copy[k]];
}

/* work: 7 n */
static qc_status eliminate(qc_ctx *ctx, const permuted *U, qc_symbolic *S, int32_t *work) {
    const int32_t n = S->n;
    int32_t *parent = work, *count = parent + n, *post = count + n, *place = post + n,
            *free_work = place + n;
    const qc__pattern upper = {n, U->colptr, U->row};
    int64_t *lower_ptr = NULL;
    int32_t *lower_row = NULL;
    qc__etree(upper, parent, free_work);
    qc__postorder(n, parent, post, free_work);
    apply_postorder(S, post, place, parent, free_work);
    const qc_status status =
        qc__transpose_renumbered(ctx, upper, post, place, &lower_ptr, &lower_row);
    if (status != QC_OK) return status;
    qc__column_counts((qc__pattern){n, lower_ptr, lower_row}, parent, count, post);
    qc__free(lower_ptr);
    qc__free(lower_row);
    for (int32_t j = 0; j < n; j++) {
        const double c = count[j] - 1;
        S->nnz_l += count[j];
        S->flops += c * (c + 1) + c;
    }
    return qc__supernodes(ctx, S, parent, count);
}

/* from and to are narrow, since they are as large as A. */
static qc_status check_size(qc_ctx *ctx, const qc_symbolic *S, int64_t nnz) {
    bool fits = nnz <= UINT32_MAX;
    for (int32_t s = 0; s < S->nsuper; s++) fits &= S->panel[s + 1] - S->panel[s] <= INT32_MAX;
    return fits ? QC_OK
                : qc__fail(ctx, QC_ERR_UNSUPPORTED, -1,
                           "matrix is too large: more than 2^32 entries, or 2^31 in one front");
}

static bool allocate_rows(qc_ctx *ctx, qc__pattern A, qc_symbolic *S) {
    const int64_t n = S->n, nnz = A.colptr[n];
    S->a_colptr = QC__NEW(ctx, int64_t, n + 1);
    S->a_row = QC__NEW(ctx, int32_t, nnz);
    S->entry = QC__ZERO(ctx, int64_t, (int64_t)S->nsuper + 1);
    S->from = QC__ZERO(ctx, uint32_t, nnz + QC__AHEAD);
    S->to = QC__NEW(ctx, int32_t, nnz);
    S->rows = QC__NEW(ctx, int32_t, S->rowptr[S->nsuper]);
    if (!S->a_colptr || !S->a_row || !S->entry || !S->from || !S->to || !S->rows) return false;
    memcpy(S->a_colptr, A.colptr, ((size_t)n + 1) * sizeof *A.colptr);
    if (nnz > 0) memcpy(S->a_row, A.row, (size_t)nnz * sizeof *A.row);
    return true;
}

/* entry[s] = first entry of supernode s; super_of: supernode of a column in the first numbering. */
static void count_entries(const permuted *U, qc_symbolic *S, const int32_t *super_of) {
    const int64_t nnz = U->colptr[S->n];
    for (int64_t p = 0; p < nnz; p++) S->entry[super_of[U->row[p]]]++;
    for (int32_t s = 0; s < S->nsuper; s++) S->entry[s] += S->super[s + 1] - S->super[s];
    for (int64_t s = 0, sum = 0; s <= S->nsuper; s++) {
        const int64_t count = S->entry[s];
        S->entry[s] = sum;
        sum += count;
    }
}

static void put_entry(qc_symbolic *S, int32_t s, int32_t column, int64_t local, int64_t source) {
    const int64_t q = S->entry[s]++, r = S->rowptr[s + 1] - S->rowptr[s];
    const int32_t offset = (int32_t)((column - S->super[s]) * r + local);
    S->from[q] = (uint32_t)(source >= 0 ? source : ~source);
    S->to[q] = source >= 0 ? offset : ~offset;
}

/* Row i of L visits the supernodes on the paths from its entries in A to the supernode of i. Taking
 * the rows in order leaves every list sorted and tells at once where in its panel an entry of A
 * goes: to the row which was appended last. work: 4 n */
static qc_status fill_rows(qc_ctx *ctx, qc__pattern A, const permuted *U, qc_symbolic *S,
                           int32_t *work) {
    const int32_t n = S->n, ns = S->nsuper;
    int32_t *mark = work, *first = mark + n, *last = first + n, *super_of = last + n;
    const qc_status status = check_size(ctx, S, A.colptr[n]);
    if (status != QC_OK) return status;
    int64_t *next = QC__NEW(ctx, int64_t, ns);
    if (!next || !allocate_rows(ctx, A, S)) {
        qc__free(next);
        return QC_ERR_NOMEM;
    }
    for (int32_t k = 0; k < n; k++) { /* first[last[k]] = k */
        first[last[k] = S->inverse[U->perm[k]]] = k;
        super_of[k] = S->super_of[last[k]];
    }
    count_entries(U, S, super_of);
    for (int32_t s = 0; s < ns; s++) {
        next[s] = S->rowptr[s];
        mark[s] = -1;
        for (int32_t k = S->super[s]; k < S->super[s + 1]; k++) S->rows[next[s]++] = k;
    }
    for (int32_t i = 0; i < n; i++) {
        const int32_t own = S->super_of[i], local = i - S->super[own];
        mark[own] = i;
        put_entry(S, own, i, local, A.colptr[S->perm[i] + 1] - 1);
        for (int64_t p = U->colptr[first[i]]; p < U->colptr[first[i] + 1]; p++) {
            const int32_t k = U->row[p], t = super_of[k];
            for (int32_t s = t; mark[s] != i; s = S->parent[s]) {
                S->rows[next[s]++] = i;
                mark[s] = i;
            }
            put_entry(S, t, last[k], t == own ? local : next[t] - 1 - S->rowptr[t], U->source[p]);
        }
    }
    memmove(S->entry + 1, S->entry, (size_t)ns * sizeof *S->entry);
    S->entry[0] = 0;
    qc__free(next);
    return QC_OK;
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

static qc_status analyze(qc_ctx *ctx, qc__pattern A, const qc_analyze_options *options,
                         qc_symbolic *S) {
    int32_t *work = QC__NEW(ctx, int32_t, 7 * (int64_t)S->n);
    if (!work) return QC_ERR_NOMEM;
    qc_status status = allocate(ctx, S) ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK && !qc__progress(ctx, 0.0)) status = QC_ERR_CANCELLED;
    if (status == QC_OK) status = qc__order(ctx, A, options, S->perm);
    if (status == QC_OK && !qc__progress(ctx, 0.6)) status = QC_ERR_CANCELLED;
    permuted U = {NULL, NULL, NULL, NULL};
    if (status == QC_OK) status = permute(ctx, A, S, &U);
    if (status == QC_OK) status = eliminate(ctx, &U, S, work);
    if (status == QC_OK && !qc__progress(ctx, 0.8)) status = QC_ERR_CANCELLED;
    if (status == QC_OK) status = fill_rows(ctx, A, &U, S, work);
    free_permuted(&U);
    if (status == QC_OK) status = fill_relative(ctx, S);
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
