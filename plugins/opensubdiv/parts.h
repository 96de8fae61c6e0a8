/* The parts of the stage, one file each. */
#ifndef QO_PARTS_H
#define QO_PARTS_H

#include <qc/closest_point.h>
#include <qc/solver.h>
#include <qc/stage.h>

#include "qc_opensubdiv.h"
#include "surface.h"

/* The surface which limit positions are compared with. */
typedef struct qo_target {
    const qc_mesh *mesh;
    const qc_closest_point *closest;
    qc_closest_tree *tree;
} qo_target;

/* Counts, valences, crowded faces. */
qc_status qo_measure_cage(const qc_run *run, const qc_polygon_mesh *cage, const qo_surface *surface,
                          qc_subdivision_report *report);
/* Distances between extraordinary vertices along edges. flag: 1 at those. */
qc_status qo_measure_spacing(const qc_run *run, const qo_surface *surface, int32_t n_vertices,
                             const uint8_t *flag, qc_subdivision_report *report);
/* Limit surface of control points: its Jacobian, and its distance to the target (mesh NULL = none).
 * place: where the limit positions of the cage vertices should be. */
qc_status qo_measure_limit(const qc_run *run, const qo_surface *surface, const qo_target *target,
                           int32_t n_vertices, const double *control, const double *place,
                           qc_subdivision_report *report);
/* Moves control points so that the limit surface fits the target. */
qc_status qo_fit(const qc_run *run, const qc_polygon_mesh *cage, const qo_target *target,
                 const qc_solver *solver, int32_t rounds, double *control);
/* Numbers as one line of JSON, appended to a file. */
qc_status qo_append_json(const qc_run *run, const qc_subdivision_report *report, const char *path);

qc_status qo_nomem(const qc_run *run);

extern const qc_stage qo_stage;

#endif
