/* Clusters of neighbouring elements, grown one after the other around those which there are. */
#include "sdk/sparse/order/internal.h"

/* Appends elements without a cluster which share a row with u to order[count..most). */
static int32_t append_neighbours(const qc__cover *C, int32_t u, int32_t cluster, int32_t *order,
                                 int32_t count, int32_t most) {
    for (int32_t p = C->element[u].begin; p < C->element[u].active; p++) {
        const qc__net net = C->net[C->entry[p]];
        for (int32_t q = net.begin; q < net.end && count < most; q++) {
            const int32_t v = C->element_of[q];
            if (C->element[v].cluster != -1) continue;
            C->element[v].cluster = cluster;
            order[count++] = v;
        }
    }
    return count;
}

void qc__cluster_elements(qc__cover *C, int32_t size, int32_t *order) {
    int32_t count = 0, cluster = 0, around = 0;
    for (int32_t e = 0; e < C->m; e++) C->element[e].cluster = -1;
    for (int32_t root = 0; root < C->m; root++) {
        if (C->element[root].cluster != -1) continue;
        C->element[root].cluster = cluster;
        order[count++] = root;
        for (int32_t begin = count - 1; begin < count; cluster++) {
            const int64_t most = (int64_t)begin + size;
            for (int32_t k = begin; k < count && count < most; k++)
                count = append_neighbours(C, order[k], cluster, order, count,
                                          most < C->m ? (int32_t)most : C->m);
            begin = count;
            for (; around < count && count == begin; around++)
                count = append_neighbours(C, order[around], cluster + 1, order, count, count + 1);
            if (count > begin) around--; /* it may have more neighbours */
        }
    }
}
