/* The built-in stages and interfaces as arrays; sdk/pipeline reads them through these symbols. */
#include "sdk/pipeline/builtin.h"
#include <qc/closest_point.h>
#include <qc/ray.h>
#include <qc/solver.h>
#include <qc/stages.h>

#define QC_STAGE(symbol) &symbol,
const qc_stage *const qc__builtin_stages[] = {
#include "stages/stage_list.h"
    NULL};
#undef QC_STAGE

const qc__offer qc__builtin_interfaces[] = {{QC_SOLVER_ID, &qc_solver_builtin.head},
                                            {QC_CLOSEST_POINT_ID, &qc_closest_point_builtin.head},
                                            {QC_RAY_CASTER_ID, &qc_ray_caster_builtin.head},
                                            {NULL, NULL}};
