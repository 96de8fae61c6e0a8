/* Keeping cones apart when periods are rounded. Internal to sdk/map.
 *
 * Two cones rounded to one lattice point, or past each other, leave no injective map
 * (docs/theory/rounding.md). For cones which are neighbours on the surface and nearer than about
 * two quads, the vector between them, developed along the shortest path, is a linear form in the
 * free variables; it has to stay non-zero and on the side where the seamless map has it. So has the
 * shift around a pole of index 1, which is also the number of grid lines that end there: four at
 * least. */
#ifndef QC_MAP_SEPARATION_H
#define QC_MAP_SEPARATION_H

#include "sdk/map/periods/seams.h"

typedef struct qc__separation {
    int32_t n;      /* pairs, then poles */
    int32_t *cone;  /* 2 n, -1 for poles */
    int64_t *start; /* n + 1: the form by free variables */
    int32_t *variable;
    double _Complex *value;
} qc__separation;

/* Pairs of cones whose Voronoi cells touch, with a path shorter than `reach` (units of the mesh),
 * and the poles with pole_index4 = 4 (NULL = none). */
qc_status qc__separation_create(qc_ctx *ctx, const qc__seams *seams, double reach,
                                const int32_t *pole_index4, qc__separation **out);
void qc__separation_free(qc__separation *separation);

/* Moves integers z (n_free) with small energy 1/2 (z - t)^T P (z - t) until no pair collides.
 * *energy is updated; *left = pairs which still collide. P: n_free^2. */
qc_status qc__separate(qc_ctx *ctx, const qc__separation *separation, int32_t n_free,
                       const double *P, const double *t, double *z, double *energy, int32_t *left);

#endif
