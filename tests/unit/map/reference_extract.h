/* A slow second extraction for the tests: unit squares and lattice points are classes of what the
 * triangles hold of them, glued across mesh edges. No ports, no tracing; all tests in integers. */
#ifndef QC_TESTS_REFERENCE_EXTRACT_H
#define QC_TESTS_REFERENCE_EXTRACT_H

#include <qc/map.h>

typedef struct reference_quads {
    int32_t n_vertices, n_quads;
    int32_t *quad; /* 4 n_quads: from the smallest vertex, counter-clockwise, sorted */
    struct reference_point *point;
    int32_t n_points;
    const qc_grid_map *grid;
} reference_quads;

/* For grids without fold-overs whose boundary follows isolines. false: some square is not whole. */
bool reference_extract(const qc_grid_map *grid, reference_quads *out);
void reference_free(reference_quads *r);
/* Vertex at parameters (u, v) in the chart of face t, -1 = none. */
int32_t reference_vertex(const reference_quads *r, int32_t t, int64_t u, int64_t v);
/* Brings quads into the order of reference_quads.quad. */
void reference_sort(int32_t *quad, int32_t n);

#endif
