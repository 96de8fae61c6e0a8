/* The state of untangling, shared by its parts. Internal to sdk/map/untangle. */
#ifndef QC_MAP_UNTANGLE_UNTANGLER_H
#define QC_MAP_UNTANGLE_UNTANGLER_H

#include "sdk/map/untangle/cones.h"
#include "sdk/map/untangle/energy.h"

enum { QC__GROWTHS = 5 }; /* of the neighbourhood: 3, 6, 12, 24, 48 rings */

typedef struct qc__untangler {
    qc_ctx *ctx;
    const qc_mesh *mesh;
    qc_untangle_options options;
    const int8_t *rotation;  /* of the transitions, known from the first grid  */
    const int8_t *axis;      /* of the features, or NULL                       */
    qc__reduced_map *map;    /* moves */
    qc__reduced_map *target; /* the rounded map */
    qc__guide guide;         /* cross NULL: the map does not tell         */
    double unit;             /* length of a parameter unit */
    qc_complex *edge;
    qc_complex *hat;
    double *area;
    int32_t *distance; /* n_vertices: rings from the nearest bad face, -1 = far */
    int32_t *queue;    /* n_vertices */
    int32_t *local;    /* n_vertices: number in the patch, -1                                   */
    int32_t *vertex;   /* n_vertices: of the patch                                             */
    int32_t n_patch;
    int32_t *face; /* n_faces: of the patch                                                */
    int32_t n_patch_faces;
    int32_t *face_stamp; /* n_faces: last patch a face was listed in                             */
    int32_t stamp;
    uint8_t *frozen; /* n_vertices: stars laid out anew keep still while the rest adapts         */
    double star_scale;
    int32_t *active;   /* n_vertices: of the patch, without the frozen ones                    */
    double *x;         /* 2 n_vertices                                                         */
    qc_complex *saved; /* n_vertices: values of the patch before it was touched                */
    int64_t work, work_limit; /* faces whose energy was evaluated: so far, at most             */
} qc__untangler;

/* --- neighbourhood.c: where to untangle --- */

/* Whether v is a cone which winds otherwise in the map than in the guiding field. */
bool qc__is_wrong_cone(const qc__untangler *u, int32_t v);
/* Rings about the folded faces and the wrong cones, up to `rings`; returns the number of bad
 * places. */
int32_t qc__mark_neighbourhood(qc__untangler *u, int32_t rings);
/* Collects the connected patch of marked, movable vertices around `seed`, unmarking them. */
void qc__collect_patch(qc__untangler *u, int32_t seed);

/* --- rings.c: patch by patch --- */

/* Lowers an energy over the vertices of the patch which are not frozen. */
qc_status qc__descend(qc__untangler *u, qc_status (*step)(qc__untangler *, qc__patch *));
bool qc__untangle_exhausted(const qc__untangler *u);
/* Until no bad place is left, with growing neighbourhoods; lo, hi: the range of progress. *bad: how
 * many places there were before the last growth. */
qc_status qc__untangle_growing(qc__untangler *u, int32_t growths, double lo, double hi,
                               int32_t *bad);

/* --- uneven.c: what was moved or is distorted --- */

/* Lowers the symmetric Dirichlet energy over what untangling moved and where the map, whose faces
 * are positive, is distorted: no face collapses on the way, so none is turned over and no cone
 * changes its winding. */
qc_status qc__relax_uneven(qc__untangler *u);

/* --- continuation.c: from the map before rounding --- */

/* Brings the working map of `grid` from the relaxed positions of `map` to the rounded ones. */
qc_status qc__untangle_continue(qc__untangler *u, const qc_corner_map *map,
                                const qc_grid_map *grid);

#endif
