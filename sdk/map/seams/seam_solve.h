/* Steps of solving for the free variables of a map with seams (see seam_relations.c). Internal to
 * sdk/map. */
#ifndef QC_MAP_SEAM_SOLVE_H
#define QC_MAP_SEAM_SOLVE_H

#include "sdk/map/seams/seams.h"

/* A spanning forest of the graph of nodes and segments, rooted at all boundary vertices and, in
 * components without, at a cone of odd turning, else at any node. */
typedef struct qc__seam_forest {
    int32_t *vertex_node;    /* n_vertices: node of an interior node vertex, -1 */
    int32_t *order, n_order; /* vertices of the forest, roots first */
    int32_t *parent_segment; /* n_vertices, -1 = root or not in the forest */
} qc__seam_forest;
/* Errors: NOMEM; free as well then. */
qc_status qc__seam_forest_create(qc_ctx *ctx, const qc__seams *s, qc__seam_forest *out);
void qc__seam_forest_free(qc__seam_forest *forest);

/* Moves the free variables which a global shift of each component sets to zero behind the others
 * and out of symbol_row. Errors: NOMEM. */
qc_status qc__seams_fix_gauge(qc_ctx *ctx, qc__seams *s);

#endif
