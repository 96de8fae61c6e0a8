/* Remeshing of one half of a symmetric surface. Not installed. */
#ifndef QC_REMESH_SYMMETRY_H
#define QC_REMESH_SYMMETRY_H

#include "sdk/remesh/internal.h"

/* What qc_remesh_options.symmetry says. */
typedef struct qc__symmetry {
    bool wanted, given; /* given: the plane itself */
    int32_t axis;       /* 0..2, or -1 = any; not given */
    qc_plane plane;
} qc__symmetry;
/* text NULL = off. Errors: ARGUMENT. */
qc_status qc__symmetry_parse(qc_ctx *ctx, const char *text, qc__symmetry *out);
/* Finds the plane and cuts the mesh; *half stays NULL, with a warning, where it has to be remeshed
 * as a whole. Errors: NOMEM, CANCELLED. */
qc_status qc__symmetry_cut(qc_ctx *ctx, const qc__symmetry *symmetry, const qc_mesh *mesh,
                           qc_remesh_result *result, qc_plane *plane, qc_mesh **half);
/* Makes the results of a half those of the whole surface result->mesh; FAILED where the halves do
 * not fit together. */
qc_status qc__mirror_results(qc_ctx *ctx, const qc_mesh *half, const qc_plane *plane,
                             qc_remesh_result *result);

/* What the boundary of quads has to be for them to be mirrored: its vertices nearer to the plane
 * than `tolerance` are on it (all where the whole boundary of the half is), and these form so many
 * arcs which are not closed. */
typedef struct qc__border {
    double tolerance;
    int32_t arcs;
} qc__border;
qc__border qc__border_of(const qc_mesh *half, const qc_plane *plane);
/* Whether an edge is on the boundary of a half, on the plane. */
bool qc__on_border(const qc_mesh *half, const qc_plane *plane, int32_t e);
/* These edges as hard features. */
qc_status qc__border_features(qc_ctx *ctx, const qc_mesh *half, const qc_plane *plane,
                              qc_features **out);
/* Half and mirror image, joined at the boundary vertices on the plane; sources are not set. FAILED
 * where the joint is no manifold or open. */
qc_status qc__mirror_polygons(qc_ctx *ctx, const qc_polygon_mesh *half, const qc_plane *plane,
                              const qc__border *border, qc_polygon_mesh **out);

#endif
