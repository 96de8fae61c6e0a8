/* The two tables this plugin offers. */
#ifndef QE_TABLES_H
#define QE_TABLES_H

#include <qc/ray.h>

#include "scene.h"

extern const qc_closest_point qe_closest_point;
extern const qc_ray_caster qe_ray_caster;

#endif
