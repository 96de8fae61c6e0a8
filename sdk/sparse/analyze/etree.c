/* Elimination tree (Liu 1990): parent(k) = min { i > k : L(i,k) != 0 }, and postorder. */
#include "sdk/sparse/internal.h"

void qc__etree(qc__pattern upper, int32_t *parent, int32_t *ancestor) {
    for (int32_t j = 0; j < upper.n; j++) {
        parent[j] = ancestor[j] = -1;
        for (int64_t p = upper.colptr[j]; p < upper.colptr[j + 1]; p++) {
            /* from i to the root of its present tree, compressing the path to point at j */
            int32_t i = upper.row[p];
            while (ancestor[i] != -1 && ancestor[i] != j) {
                const int32_t next = ancestor[i];
                ancestor[i] = j;
                i = next;
            }
            if (ancestor[i] == -1 && i != j) ancestor[i] = parent[i] = j;
        }
    }
}

void qc__postorder(int32_t n, const int32_t *parent, int32_t *post, int32_t *work) {
    int32_t *head = work, *next = work + n, *stack = work + 2 * (int64_t)n, count = 0;
    for (int32_t j = 0; j < n; j++) head[j] = -1;
    for (int32_t j = n; j-- > 0;) {
        if (parent[j] == -1) continue;
        next[j] = head[parent[j]];
        head[parent[j]] = j;
    }
    for (int32_t root = 0; root < n; root++) {
        if (parent[root] != -1) continue;
        int32_t top = 0;
        stack[0] = root;
        while (top >= 0) {
            const int32_t j = stack[top], child = head[j];
            if (child == -1) {
                post[count++] = j;
                top--;
            } else {
                head[j] = next[child];
                stack[++top] = child;
            }
        }
    }
}
