/* What finds the pairs to be kept apart (see separation.h), shared by its parts. Internal to
 * sdk/map/round. */
#ifndef QC_MAP_SEPARATION_FINDER_H
#define QC_MAP_SEPARATION_FINDER_H

#include "sdk/map/round/separation.h"
#include "sdk/mesh/internal.h"

typedef struct qc__bridge { /* mesh edge joining the cells of two sites */
    int32_t a, b, edge;     /* a < b */
    double length;
} qc__bridge;

typedef struct qc__finder {
    qc_ctx *ctx;
    const qc__seams *seams;
    const int8_t *axis;
    const qc_complex *map;
    int32_t *site; /* n_vertices, -1: points by number, then pieces of features between them */
    double *distance;
    int32_t *predecessor; /* edge towards the site */
    int32_t *cell;        /* nearest site of a vertex, -1 */
    qc__bridge *bridges;
    int64_t n_bridges, capacity;
    double _Complex *sum; /* n_free, dense accumulator of one form */
    int64_t value_capacity, variable_capacity, vertex_capacity, start_capacity;
} qc__finder;

/* --- separation_cells.c: neighbours --- */

double qc__edge_length(const qc_mesh *mesh, int32_t e);
/* Pieces of features without the points between them become sites. */
qc_status qc__separation_find_pieces(qc__finder *f);
/* The Voronoi cells of the sites. */
qc_status qc__separation_grow_cells(qc__finder *f);
/* The shortest bridge of each pair of touching cells, one of them at least beyond the first ones.
 */
qc_status qc__separation_find_bridges(qc__finder *f, double reach, int32_t beyond);

/* --- separation_forms.c: linear forms in the free variables --- */

void qc__separation_add_symbol(qc__finder *f, int32_t symbol, double _Complex factor);
/* Follows n edges from vertex `*v` to the last one, left in *v. The form f_b - f_a in the chart of
 * the first face, i^-turn (f_b - T) - f_a, is left in the sum; *parts tells which parts of it are
 * given, *way is the vector in the map. */
qc_status qc__separation_develop(qc__finder *f, const int32_t *path, int32_t n, qc__walk *walk,
                                 int32_t *v, int32_t *parts, double _Complex *way);
/* Room for n forms in all. */
qc_status qc__separation_reserve(qc__finder *f, qc__separation *s, int64_t n);
/* Appends the parts of the sum, unless they vanish, and clears it. */
qc_status qc__separation_store(qc__finder *f, qc__separation *s, const int32_t ends[2],
                               int32_t parts);

/* --- separation_along.c --- */

/* The pieces of features shorter than the reach, between points or round. */
qc_status qc__separation_along(qc__finder *f, qc__separation *s, double reach);

#endif
