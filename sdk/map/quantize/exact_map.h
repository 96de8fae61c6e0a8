/* What quantization starts from: a seamless map whose values are multiples of 2^-bits, so that it
 * is exact with real translations (docs/theory/quantization.md). Internal to sdk/map; plain arrays,
 * so that rounding can include it beside its own complex numbers. */
#ifndef QC_MAP_QUANTIZE_EXACT_MAP_H
#define QC_MAP_QUANTIZE_EXACT_MAP_H

#include <qc/map.h>

typedef struct qc__exact_map {
    const qc_mesh *mesh;
    const int64_t *uv; /* 6 n_faces, units of 2^-bits, |uv| < 2^48                          */
    int32_t bits;
    const int8_t *rotation; /* n_edges: r of f_t = i^r f_s + tau, exact at both ends              */
    const int8_t *axis;     /* n_edges, features as in qc_corner_map, exact; NULL = none          */
    const uint8_t *point;   /* n_vertices: 1 where a lattice point has to be: all cones; corners
                               of features and the boundary are found                           */
} qc__exact_map;

/* An integer-grid map on a refined mesh, positive on every face. */
typedef struct qc__imprint {
    qc_mesh *mesh;    /* old vertices keep their numbers; children of a face follow each other */
    double *uv;       /* 6 n_faces, in the charts of the parents */
    int8_t *rotation; /* n_edges */
    int8_t *axis;     /* n_edges, NULL without features */
    int32_t *parent;  /* n_faces: face of the old mesh */
    double *weight;   /* 9 n_faces: barycentric coordinates of the corners in the parent */
    qc_complex *turn; /* n_faces: x -> x turn takes tangent vectors to the frame of the child */
} qc__imprint;
void qc__imprint_free(qc__imprint *imprint);

/* Values (6 n_faces, parameter units) of an integer-grid map near scale times the map: rotations
 * are the same, translations and the levels of features are integers, points lie on lattice points.
 * Affine between them it is injective on the common refinement of mesh and coarse complex, not
 * always on the faces themselves; imprint (NULL = not wanted): the map on that refinement. quads,
 * *made as in qc__coarse_integers. Errors: those, and FAILED
 * where a face is not positive, a vertex which is no point has other than a full turn, or the map
 * is not exact (where = the element). */
qc_status qc__quantize(qc_ctx *ctx, const qc__exact_map *map, double scale, double quads,
                       double *uv, double *made, qc__imprint *imprint);

#endif
