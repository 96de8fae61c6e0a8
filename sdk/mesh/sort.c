/* Stable linear-time sorting of edges (pairs of vertices) and of real weights. */
#include <string.h>

#include "sdk/mesh/internal.h"

/* One pass of a counting sort: out = in ordered by key[in[i]]; in NULL = 0, 1, 2, ... */
static void counting_pass(int32_t n_keys, int32_t n, const int32_t *key, const int32_t *in,
                          int32_t *out, int32_t *count) {
    memset(count, 0, ((size_t)n_keys + 1) * sizeof *count);
    for (int32_t i = 0; i < n; i++) count[key[i] + 1]++;
    for (int32_t k = 0; k < n_keys; k++) count[k + 1] += count[k];
    for (int32_t i = 0; i < n; i++) {
        int32_t element = in ? in[i] : i;
        out[count[key[element]]++] = element;
    }
}

qc_status qc__sort_pairs(qc_ctx *ctx, int32_t n_keys, int32_t n, const int32_t *a, const int32_t *b,
                         int32_t *order) {
    int32_t *count = QC__NEW(ctx, int32_t, (size_t)n_keys + 1);
    int32_t *by_b = QC__NEW(ctx, int32_t, n);
    qc_status status = count && by_b ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        counting_pass(n_keys, n, b, NULL, by_b, count);
        counting_pass(n_keys, n, a, by_b, order, count);
    }
    qc__free(count);
    qc__free(by_b);
    return status;
}

uint64_t qc__sort_key(double x) {
    uint64_t bits;
    x += 0.0; /* -0 becomes +0 */
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

enum { DIGIT_BITS = 11, DIGITS = 6, RADIX = 1 << DIGIT_BITS };

/* Least significant digit first; digits on which all keys agree are skipped. */
qc_status qc__sort_keys(qc_ctx *ctx, int32_t n, uint64_t *key, int32_t *index) {
    uint64_t *key2 = QC__NEW(ctx, uint64_t, n);
    int32_t *index2 = QC__NEW(ctx, int32_t, n);
    if (!key2 || !index2) {
        qc__free(key2);
        qc__free(index2);
        return QC_ERR_NOMEM;
    }
    uint64_t *from = key, *to = key2;
    int32_t *ifrom = index, *ito = index2;
    for (int digit = 0; digit < DIGITS; digit++) {
        int shift = digit * DIGIT_BITS;
        int32_t start[RADIX + 1] = {0};
        for (int32_t i = 0; i < n; i++) start[((from[i] >> shift) & (RADIX - 1)) + 1]++;
        if (n == 0 || start[((from[0] >> shift) & (RADIX - 1)) + 1] == n) continue;
        for (int k = 0; k < RADIX; k++) start[k + 1] += start[k];
        for (int32_t i = 0; i < n; i++) {
            int32_t place = start[(from[i] >> shift) & (RADIX - 1)]++;
            to[place] = from[i];
            ito[place] = ifrom[i];
        }
        uint64_t *swap = from;
        int32_t *iswap = ifrom;
        from = to, to = swap;
        ifrom = ito, ito = iswap;
    }
    if (from != key && n > 0) {
        memcpy(key, from, (size_t)n * sizeof *key);
        memcpy(index, ifrom, (size_t)n * sizeof *index);
    }
    qc__free(key2);
    qc__free(index2);
    return QC_OK;
}
