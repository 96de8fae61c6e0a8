/* Parameters of the degenerate quads around poles. Internal to sdk/map.
 *
 * Each face (p_j, a_j, a_j+1) at a pole stands for the quad (a_j, a_j+1, q_j+1, q_j) with q_j and
 * q_j+1 in the pole (Fig. 6 of the second paper), and
 *     f_j(q_j) = 1/2 (i^r f_j-1(p_j-1) + d + f_j(p_j)), (3) r and d those of the transition from
 * its neighbour. The map is bilinear on the quads and agrees on the side which two of them share.
 */
#ifndef QC_MAP_POLE_VALUES_H
#define QC_MAP_POLE_VALUES_H

#include <qc/map.h>

/* By position in mesh->pole_corner. */
typedef struct qc__pole_values {
    int32_t *next;   /* the next tip of the pole */
    double *start;   /* 2 each: q_j in the chart of its face */
    double *end;     /* 2 each: q_j+1 in that chart */
    int32_t *end_uv; /* entry of q_j+1 */
} qc__pole_values;
qc_status qc__pole_values_create(qc_ctx *ctx, const qc_corner_map *map, qc__pole_values *out);
/* Entries of the ends: that of the next start (its corner in corner_uv) when the values are equal,
 * a new one otherwise. */
void qc__pole_values_number(const qc_corner_map *map, qc__pole_values *values,
                            const int32_t *corner_uv, int32_t *n_uvs);
void qc__pole_values_free(qc__pole_values *values);

#endif
