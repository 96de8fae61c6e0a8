/* Cones which wind the wrong number of times. Internal to sdk/map.
 *
 * All faces may be positive and the map still be wrong: a cone of five quarter turns with an image
 * angle of one, beside a regular vertex with eight. Untangling cannot leave such a state by itself,
 * so the star of the cone is laid out again along the guiding field. */
#ifndef QC_MAP_UNTANGLE_CONES_H
#define QC_MAP_UNTANGLE_CONES_H

#include "sdk/map/untangle/reduced_map.h"

typedef struct qc__guide {
    const qc__reduced_map *map;
    const int8_t *rotation;  /* n_edges, of the transitions  */
    const qc_complex *cross; /* n_faces, in the gauge of the map */
    const qc_complex *edge;  /* 3 n_faces, tangent edges in units of the quad edge length  */
} qc__guide;

/* Angle about vertex v, on the boundary of its open fan: of the guiding field and of the map. */
double qc__guide_angle(const qc__guide *guide, int32_t v);
double qc__map_angle(const qc__guide *guide, int32_t v);
/* The same in quarter turns. */
int32_t qc__guide_turns(const qc__guide *guide, int32_t v);
int32_t qc__map_turns(const qc__guide *guide, int32_t v);
/* Puts the movable neighbours of interior vertex v where the guiding field would have them, `scale`
 * times as far.
 */
void qc__lay_out_star(const qc__guide *guide, int32_t v, double scale);

#endif
