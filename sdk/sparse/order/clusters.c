/* Clusters of neighbouring elements, grown one after the other around those which there are, and
 * their places in space. */
#include "sdk/sparse/order/internal.h"

/* Appends elements without a cluster which share a row with u to order[count..most). */
static int32_t append_neighbours(const qc__cover *C, int32_t u, int32_t cluster, int32_t *order,
                                 int32_t count, int32_t most) {
    for (int32_t p = C->element[u].begin; p < C->element[u].active; p++) {
        const qc__net net = C->net[C->entry[p]];
        if (net.end - net.begin > QC__WIDE_NET) continue;
        for (int32_t q = net.begin; q < net.end && count < most; q++) {
            const int32_t v = C->element_of[q];
            if (C->element[v].cluster != -1) continue;
            C->element[v].cluster = cluster;
            order[count++] = v;
        }
    }
    return count;
}

int32_t qc__cluster_elements(qc__cover *C, int32_t size, int32_t *order) {
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
    return cluster;
}

/* Mean position of the rows of each cluster, sum: 4 per cluster. */
static void add_positions(const qc__cover *C, const double *position, double *sum) {
    for (int32_t e = 0; e < C->m; e++) {
        double *s = sum + 4 * (int64_t)C->element[e].cluster;
        for (int32_t p = C->element[e].begin; p < C->element[e].active; p++) {
            const double *x = position + 3 * (int64_t)C->net[C->entry[p]].name;
            for (int d = 0; d < 3; d++) s[d] += x[d];
            s[3] += 1;
        }
    }
}

/* Coordinates count from the lowest in parts of the largest extent, hence not in units. Products
 * with places which rarely fall on whole numbers keep rounding errors of the input from mattering.
 */
bool qc__cluster_centers(qc_ctx *ctx, const qc__cover *C, int32_t clusters, const double *position,
                         int16_t *center) {
    double *sum = QC__ZERO(ctx, double, 4 * (int64_t)clusters);
    if (!sum) return false;
    double lo[3] = {INFINITY, INFINITY, INFINITY}, extent = 0;
    add_positions(C, position, sum);
    for (int32_t k = 0; k < clusters; k++)
        for (int d = 0; d < 3; d++) {
            sum[4 * (int64_t)k + d] /= sum[4 * (int64_t)k + 3];
            lo[d] = fmin(lo[d], sum[4 * (int64_t)k + d]);
        }
    for (int32_t k = 0; k < clusters; k++)
        for (int d = 0; d < 3; d++) extent = fmax(extent, sum[4 * (int64_t)k + d] - lo[d]);
    for (int32_t k = 0; k < clusters; k++)
        for (int d = 0; d < 3; d++) {
            const double t = extent > 0 ? (sum[4 * (int64_t)k + d] - lo[d]) / extent : 0;
            center[3 * (int64_t)k + d] = (int16_t)(t * (QC__PLACES - 1.28) + 0.1416);
        }
    qc__free(sum);
    return true;
}
