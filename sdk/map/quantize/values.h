/* From the marker of a face to its corners. Internal to sdk/map/quantize. */
#ifndef QC_MAP_QUANTIZE_VALUES_H
#define QC_MAP_QUANTIZE_VALUES_H

#include "sdk/map/quantize/walk.h"

/* Walks of one face begin in the chart of the triangle of its marker. */
typedef struct qc__face_walk {
    qc__cursor cursor;
    int turn; /* quarter turns from the chart of the face */
    qc__point marker, corner[3];
} qc__face_walk;

qc__face_walk qc__face_walk_begin(const qc__exact_map *map, const qc__coarse_map *coarse,
                                  const qc__point *x, int32_t face);
/* In the triangle in which the straight line from the marker ends at corner k. */
qc__cursor qc__face_walk_to(const qc__face_walk *walk, int k);
/* Values of all corners (6 n_faces), each face in the turn of its own chart. */
void qc__quantized_values(const qc__exact_map *map, const qc__coarse_map *coarse,
                          const qc__point *x, double *uv);

#endif
