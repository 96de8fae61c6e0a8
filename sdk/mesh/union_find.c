/* Disjoint sets with path halving. The lowest member represents its set, so that numbering sets in
 * the order of their roots is independent of the order of the unions. */
#include "sdk/mesh/internal.h"

void qc__sets_init(int32_t *parent, int32_t n) {
    for (int32_t i = 0; i < n; i++) parent[i] = i;
}

int32_t qc__sets_find(int32_t *parent, int32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

bool qc__sets_unite(int32_t *parent, int32_t a, int32_t b) {
    a = qc__sets_find(parent, a);
    b = qc__sets_find(parent, b);
    if (a == b) return false;
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
    return true;
}
