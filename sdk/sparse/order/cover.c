/* Greedy partition of the edges of a pattern into cliques.
 *
 * Columns in descending order; an entry (i, c) in no clique yet starts one: {c, i}, then the
 * largest row k < i whose entries with all members are in no clique, and so on. All entries of the
 * clique lie in its columns, hence the upper triangle suffices, and each belongs to one clique
 * only: the sum of their sizes is at most twice the number of entries. */
#include "sdk/sparse/order/internal.h"
#include <string.h>

typedef struct covering {
    qc__pattern A;
    bool *covered; /* entries of A */
    int32_t *clique, size;
    int32_t *candidate; /* rows adjacent to all members so far, descending; size: longest column */
    qc__cover C;
    int64_t element_capacity, entry_capacity, entries;
} covering;

/* Position of row i in column j, or -1. */
static int64_t find_entry(qc__pattern A, int32_t i, int32_t j) {
    int64_t lo = A.colptr[j], hi = A.colptr[j + 1];
    while (hi - lo > 8) {
        const int64_t middle = lo + (hi - lo) / 2;
        if (A.row[middle] <= i)
            lo = middle;
        else
            hi = middle;
    }
    for (; lo < hi; lo++)
        if (A.row[lo] == i) return lo;
    return -1;
}

/* Adds the largest candidate adjacent to the last member until there is none. */
static void grow(covering *g, int32_t count) {
    while (count > 0) {
        const int32_t j = g->clique[g->size - 1];
        int32_t kept = 0;
        for (int32_t k = 0; k < count; k++) {
            const int32_t i = g->candidate[k];
            if (i >= j) continue;
            const int64_t p = find_entry(g->A, i, j);
            if (p >= 0 && !g->covered[p]) g->candidate[kept++] = i;
        }
        count = kept;
        if (count > 0) g->clique[g->size++] = g->candidate[0];
    }
}

static void mark_covered(covering *g) {
    for (int32_t a = 0; a < g->size; a++)
        for (int32_t b = a + 1; b < g->size; b++)
            g->covered[find_entry(g->A, g->clique[b], g->clique[a])] = true;
}

static bool append(qc_ctx *ctx, covering *g) {
    qc__cover *C = &g->C;
    if (!qc__reserve(ctx, (void **)&C->element, &g->element_capacity, C->m + 1,
                     sizeof *C->element) ||
        !qc__reserve(ctx, (void **)&C->entry, &g->entry_capacity, g->entries + g->size,
                     sizeof *C->entry))
        return false;
    const int32_t begin = (int32_t)g->entries;
    memcpy(C->entry + begin, g->clique, (size_t)g->size * sizeof *g->clique);
    g->entries += g->size;
    C->element[C->m++] = (qc__element){begin, (int32_t)g->entries, (int32_t)g->entries, -1};
    return true;
}

static bool cover_column(qc_ctx *ctx, covering *g, int32_t c) {
    const int64_t begin = g->A.colptr[c], end = g->A.colptr[c + 1] - 1; /* without the diagonal */
    for (int64_t p = end; p-- > begin;) {
        if (g->covered[p]) continue;
        int32_t count = 0;
        for (int64_t q = p; q-- > begin;)
            if (!g->covered[q]) g->candidate[count++] = g->A.row[q];
        g->clique[0] = c;
        g->clique[1] = g->A.row[p];
        g->size = 2;
        grow(g, count);
        mark_covered(g);
        if (!append(ctx, g)) return false;
    }
    return true;
}

static bool fill_nets(qc_ctx *ctx, covering *g) {
    qc__cover *C = &g->C;
    C->n = g->A.n;
    C->net = QC__ZERO(ctx, qc__net, C->n);
    C->element_of = QC__NEW(ctx, int32_t, g->entries);
    if (!C->net || !C->element_of) return false;
    for (int64_t p = 0; p < g->entries; p++) C->net[C->entry[p]].end++;
    int32_t sum = 0;
    for (int32_t i = 0; i < C->n; i++) {
        const int32_t count = C->net[i].end;
        C->net[i] = (qc__net){sum, sum, i};
        sum += count;
    }
    for (int32_t e = 0; e < C->m; e++)
        for (int32_t p = C->element[e].begin; p < C->element[e].end; p++)
            C->element_of[C->net[C->entry[p]].end++] = e;
    return true;
}

void qc__cover_free(qc__cover *C) {
    qc__free(C->element);
    qc__free(C->net);
    qc__free(C->entry);
    qc__free(C->element_of);
}

qc_status qc__cover_create(qc_ctx *ctx, qc__pattern A, qc__cover *out) {
    int64_t longest = 1;
    for (int32_t j = 0; j < A.n; j++)
        if (A.colptr[j + 1] - A.colptr[j] > longest) longest = A.colptr[j + 1] - A.colptr[j];
    covering g = {.A = A};
    g.covered = QC__ZERO(ctx, bool, A.colptr[A.n]);
    g.clique = QC__NEW(ctx, int32_t, longest + 1);
    g.candidate = QC__NEW(ctx, int32_t, longest);
    qc_status status = g.covered && g.clique && g.candidate ? QC_OK : QC_ERR_NOMEM;
    for (int32_t c = A.n; c-- > 0 && status == QC_OK;) {
        if (!cover_column(ctx, &g, c)) status = QC_ERR_NOMEM;
        if ((c & 0xffff) == 0 && !qc__progress(ctx, 0.1 * (A.n - c) / A.n))
            status = QC_ERR_CANCELLED;
    }
    if (status == QC_OK && !fill_nets(ctx, &g)) status = QC_ERR_NOMEM;
    qc__free(g.covered);
    qc__free(g.clique);
    qc__free(g.candidate);
    if (status == QC_OK)
        *out = g.C;
    else
        qc__cover_free(&g.C);
    return status;
}
