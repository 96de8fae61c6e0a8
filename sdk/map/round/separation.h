/* Keeping points and features apart when periods are rounded. Internal to sdk/map.
 *
 * Two points rounded to one lattice point, or past each other, leave no injective map, and neither
 * do a point or a parallel feature rounded onto a feature (docs/theory/rounding.md). For those
 * which are neighbours on the surface and nearer than about three quads, the vector between them,
 * developed along the shortest path, is a linear form in the free variables, where only one side is
 * a feature its part across; it has to stay non-zero and on the side where the map has it. So has
 * the shift around a pole of index 1, which is also the number of grid lines that end there: four
 * at least. */
#ifndef QC_MAP_SEPARATION_H
#define QC_MAP_SEPARATION_H

#include "sdk/map/seams/seams.h"

typedef struct qc__separation {
    int32_t n;       /* pairs, then poles */
    int32_t *vertex; /* 2 n: the ends of the path, -1 for poles */
    int64_t *start;  /* n + 1: the form by free variables */
    int32_t *variable;
    double _Complex *value;
} qc__separation;

/* Pairs whose Voronoi cells touch, with a path shorter than `reach` (units of the mesh): of points,
 * and where axis (n_edges, as in qc_matching) is given of points and features; and the poles with
 * pole_index4 = 4 (NULL = none). f: the aligned map. */
qc_status qc__separation_create(qc_ctx *ctx, const qc__seams *seams, const int8_t *axis,
                                const int32_t *pole_index4, const qc_complex *f, double reach,
                                qc__separation **out);
void qc__separation_free(qc__separation *separation);

/* Moves integers z (n_free) with small energy 1/2 (z - t)^T P (z - t) until no pair collides.
 * thorough: by two steps where one does not help, which takes long where many collide. *energy is
 * updated; *left = pairs which still collide. P: n_free^2. */
qc_status qc__separate(qc_ctx *ctx, const qc__separation *separation, int32_t n_free,
                       const double *P, const double *t, bool thorough, double *z, double *energy,
                       int32_t *left);
/* The first pair which integers z let collide, where t has it apart; -1 = none. */
int32_t qc__first_collision(const qc__separation *separation, const double *t, const double *z);

#endif
