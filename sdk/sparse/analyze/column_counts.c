/* Column counts of L in nearly O(nnz(A)) (Gilbert, Ng, Peyton 1994).
 *
 * Row i of L is the subtree T_i of the elimination tree spanned by the k with A(i,k) != 0 and i.
 * Its indicator is the subtree sum of: +1 at each leaf of T_i, -1 at the lowest common ancestor of
 * consecutive leaves, -1 at parent(i). Summing over all i gives the count of every column. */
#include "sdk/sparse/internal.h"

static int32_t find_root(int32_t *set, int32_t k) {
    int32_t root = k;
    while (set[root] != root) root = set[root];
    while (set[k] != root) {
        const int32_t next = set[k];
        set[k] = root;
        k = next;
    }
    return root;
}

void qc__column_counts(qc__pattern lower, const int32_t *parent, int32_t *count, int32_t *work) {
    const int32_t n = lower.n;
    int32_t *first = work;                 /* first descendant                               */
    int32_t *seen = work + n;              /* first of the last leaf of T_i found, or -1     */
    int32_t *leaf = work + 2 * (int64_t)n; /* that leaf                                      */
    int32_t *set = work + 3 * (int64_t)n;  /* union-find: highest finished ancestor          */
    for (int32_t k = 0; k < n; k++) {
        first[k] = -1;
        seen[k] = leaf[k] = -1;
        set[k] = k;
    }
    for (int32_t k = 0; k < n; k++) {
        count[k] = first[k] == -1 ? 1 : 0; /* k is a leaf of the tree: T_k = {k} */
        for (int32_t j = k; j != -1 && first[j] == -1; j = parent[j]) first[j] = k;
    }
    for (int32_t k = 0; k < n; k++) {
        if (parent[k] != -1) count[parent[k]]--;
        for (int64_t p = lower.colptr[k]; p < lower.colptr[k + 1]; p++) {
            const int32_t i = lower.row[p];
            if (first[k] <= seen[i]) continue; /* a descendant of k is in T_i: no leaf */
            count[k]++;
            if (leaf[i] != -1) count[find_root(set, leaf[i])]--;
            seen[i] = first[k];
            leaf[i] = k;
        }
        if (parent[k] != -1) set[k] = parent[k];
    }
    for (int32_t k = 0; k < n; k++)
        if (parent[k] != -1) count[parent[k]] += count[k];
}
