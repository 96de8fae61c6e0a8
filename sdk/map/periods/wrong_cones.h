/* Fold-overs of a map: cones which it winds wrong, and stiffening. Internal to sdk/map. */
#ifndef QC_MAP_WRONG_CONES_H
#define QC_MAP_WRONG_CONES_H

#include <qc/mesh.h>

/* Whether the triangle p[0..2] is not positive. */
bool qc__is_folded(const qc_complex *p);
/* Number of cones whose image angle is not 4 - index4 quarter turns, and of folded corners whose
 * regular vertex is wound more than once: fold-overs which untangling can hardly undo. f: 3
 * n_faces, index4: n_vertices. */
int32_t qc__wrong_cones(const qc_mesh *mesh, const int32_t *index4, const qc_complex *f);
/* Whether the image angle of inner vertex v is not 4 - index4 quarter turns. */
bool qc__winds_wrong(const qc_mesh *mesh, int32_t index4, const qc_complex *f, int32_t v);
/* Raises the weight (n_faces) of folded faces, and of those around them half as much (stiffening as
 * in mixed-integer quadrangulation, Bommes, Zimmer, Kobbelt 2009, 5.4). */
void qc__stiffen(const qc_mesh *mesh, const qc_complex *f, double *weight);

#endif
