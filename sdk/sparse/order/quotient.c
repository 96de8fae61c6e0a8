/* Quotients of a pattern: rows in groups, groups ordered instead of rows. Groups come from the
 * caller or are the indistinguishable rows, those with the same closed neighbourhood (Ashcraft
 * 1995): an order of minimum degree may keep these together. */
#include "sdk/sparse/order/internal.h"
#include <string.h>

static uint64_t mix(uint64_t x) { /* the finaliser of splitmix64 */
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* group[i] = number of the first key equal to key[i], by first appearance. slot: 2^bits. */
static int32_t number_keys(int32_t n, const uint64_t *key, int bits, int32_t *slot,
                           int32_t *group) {
    const uint64_t mask = ((uint64_t)1 << bits) - 1;
    int32_t count = 0;
    memset(slot, 255, ((size_t)mask + 1) * sizeof *slot);
    for (int32_t i = 0; i < n; i++) {
        uint64_t at = mix(key[i]) & mask;
        while (slot[at] != -1 && key[slot[at]] != key[i]) at = (at + 1) & mask;
        if (slot[at] == -1) {
            slot[at] = i;
            group[i] = count++;
        } else {
            group[i] = group[slot[at]];
        }
    }
    return count;
}

/* Sums of hashes: rows with equal keys have, up to a chance of 2^-64, equal neighbourhoods. */
static void neighbourhood_keys(qc__pattern A, uint64_t *key) {
    memset(key, 0, (size_t)A.n * sizeof *key);
    for (int32_t j = 0; j < A.n; j++)
        for (int64_t p = A.colptr[j]; p < A.colptr[j + 1]; p++) {
            const int32_t i = A.row[p];
            key[j] += mix((uint64_t)i + 1);
            if (i != j) key[i] += mix((uint64_t)j + 1);
        }
}

qc_status qc__find_groups(qc_ctx *ctx, qc__pattern A, const int32_t *given, int32_t *group,
                          int32_t *count) {
    int bits = 1;
    while (((int64_t)1 << bits) < 2 * (int64_t)A.n) bits++;
    uint64_t *key = QC__NEW(ctx, uint64_t, A.n);
    int32_t *slot = QC__NEW(ctx, int32_t, (int64_t)1 << bits);
    const qc_status status = key && slot ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        if (given)
            for (int32_t i = 0; i < A.n; i++) key[i] = (uint32_t)given[i];
        else
            neighbourhood_keys(A, key);
        *count = number_keys(A.n, key, bits, slot, group);
    }
    qc__free(key);
    qc__free(slot);
    return status;
}

/* Entries (a, b) with a <= b by row a, from those of A; start: n + 1, zero. */
static void bucket_rows(qc__pattern A, const int32_t *group, int64_t *start, int32_t *column) {
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t j = 0; j < A.n; j++)
            for (int64_t p = A.colptr[j]; p < A.colptr[j + 1]; p++) {
                const int32_t a = group[A.row[p]], b = group[j];
                if (pass == 0)
                    start[a < b ? a : b]++;
                else
                    column[--start[a < b ? a : b]] = a < b ? b : a;
            }
        /* counts become ends, which the second pass moves to the starts */
        for (int64_t g = 1; pass == 0 && g <= A.n; g++) start[g] += start[g - 1];
    }
}

/* Deals the rows out to the columns in order: sorted, equal entries adjacent and dropped. */
static qc_status deal_columns(qc_ctx *ctx, int32_t n, const int64_t *start, const int32_t *column,
                              int64_t *colptr, int32_t *row) {
    int32_t *last = QC__NEW(ctx, int32_t, n);
    if (!last) return QC_ERR_NOMEM;
    for (int pass = 0; pass < 2; pass++) {
        memset(last, 255, (size_t)n * sizeof *last);
        for (int32_t a = 0; a < n; a++)
            for (int64_t p = start[a]; p < start[a + 1]; p++) {
                const int32_t b = column[p];
                if (last[b] == a) continue;
                last[b] = a;
                if (pass == 1) row[colptr[b]] = a;
                colptr[b]++;
            }
        int64_t sum = 0;
        for (int32_t b = 0; b <= n && pass == 0; b++) {
            const int64_t size = b < n ? colptr[b] : 0;
            colptr[b] = sum;
            sum += size;
        }
    }
    memmove(colptr + 1, colptr, (size_t)n * sizeof *colptr);
    colptr[0] = 0;
    qc__free(last);
    return QC_OK;
}

qc_status qc__quotient(qc_ctx *ctx, qc__pattern A, const int32_t *group, int32_t count,
                       int64_t **colptr, int32_t **row) {
    int64_t *start = QC__ZERO(ctx, int64_t, (int64_t)A.n + 1);
    int32_t *column = QC__NEW(ctx, int32_t, A.colptr[A.n]);
    *colptr = QC__ZERO(ctx, int64_t, (int64_t)count + 1);
    *row = QC__NEW(ctx, int32_t, A.colptr[A.n]);
    qc_status status = start && column && *colptr && *row ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        bucket_rows(A, group, start, column);
        status = deal_columns(ctx, count, start, column, *colptr, *row);
    }
    qc__free(start);
    qc__free(column);
    return status;
}

qc_status qc__expand_groups(qc_ctx *ctx, int32_t n, const int32_t *group, int32_t count,
                            const int32_t *order, int32_t *perm) {
    int32_t *next = QC__ZERO(ctx, int32_t, (int64_t)count + 1);
    if (!next) return QC_ERR_NOMEM;
    for (int32_t i = 0; i < n; i++) next[group[i]]++;
    for (int32_t k = 0, sum = 0; k < count; k++) {
        const int32_t size = next[order[k]];
        next[order[k]] = sum;
        sum += size;
    }
    for (int32_t i = 0; i < n; i++) perm[next[group[i]]++] = i;
    qc__free(next);
    return QC_OK;
}
