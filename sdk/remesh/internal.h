/* Parts of qc_remesh, one file each. Not installed. */
#ifndef QC_REMESH_INTERNAL_H
#define QC_REMESH_INTERNAL_H

#include <qc/remesh.h>

#include "sdk/base/internal.h"

#define QC__DEFAULT_QUADS 10000.0

/* --- connected components -------------------------------------------------------------------- */

/* Faces and vertices of a mesh sorted by component, each in increasing order. */
typedef struct qc__parts {
    const qc_mesh *mesh;
    int32_t n;
    int32_t *face_start, *face;     /* n + 1, n_faces */
    int32_t *vertex_start, *vertex; /* n + 1, n_vertices */
    int32_t *local;                 /* n_vertices: number in its component */
    double *area;                   /* n */
} qc__parts;
qc_status qc__parts_create(qc_ctx *ctx, const qc_mesh *mesh, qc__parts *out);
void qc__parts_clear(qc__parts *parts);
/* Component c as a mesh whose source numbers are those of parts->mesh (so: of the input). */
qc_status qc__parts_mesh(qc_ctx *ctx, const qc__parts *parts, int32_t c, qc_mesh **out);

/* --- density --------------------------------------------------------------------------------- */

/* The density parameters of one qc.size step as they were set. */
typedef struct qc__density {
    char step[64];
    double quads, edge_length, edge_length_rel;
} qc__density;
/* The first qc.size step from `first` on; false when there is none. */
bool qc__density_find(const qc_pipeline *pipeline, uint32_t first, qc__density *out);
/* Sets the step's parameters for a part of the mesh with the given area. */
qc_status qc__density_share(qc_pipeline *pipeline, const qc__density *density, const qc_mesh *mesh,
                            double area);
qc_status qc__density_restore(qc_pipeline *pipeline, const qc__density *density);

/* --- attempts -------------------------------------------------------------------------------- */

/* The parameter "seed" of a step which has one. */
qc_status qc__set_seed(qc_pipeline *pipeline, const char *step, uint64_t seed);
/* Runs the steps from `first` on. Where a step fails, they run again with other integers, with
 * fewer hard features, without any, and with more quads; each time a warning tells why. */
qc_status qc__run_with_attempts(qc_ctx *ctx, qc_pipeline *pipeline, uint32_t first, qc_bag *bag);

/* Chains of hard features and those of them which are given up. */
typedef struct qc__concessions {
    const qc_features *features; /* retained: as found, before any is given up */
    int32_t n, n_boundaries;
    int32_t *of;             /* n_edges: chain, -1 */
    qc_feature_chain *chain; /* n */
    uint8_t *gone;           /* n */
    int32_t n_gone, named;
} qc__concessions;
qc_status qc__concessions_create(qc_ctx *ctx, const qc_features *features, qc__concessions *out);
void qc__concessions_clear(qc__concessions *concessions);
/* Gives up chains until n are gone: the weakest near the place first (NULL = none is known); each
 * is named by a warning. */
qc_status qc__concessions_grow(qc_ctx *ctx, qc__concessions *concessions, int32_t n,
                               const double *place, double quad, const char *reason);
/* The features which are left. */
qc_status qc__concessions_features(qc_ctx *ctx, const qc__concessions *concessions,
                                   qc_features **out);

/* What the last step before `end` which made an object of this type has put into the bag; object
 * NULL: there is none. */
typedef struct qc__product {
    int64_t step;
    const void *object; /* borrowed */
    char name[128];
} qc__product;
qc__product qc__product_of(const qc_pipeline *pipeline, const qc_bag *bag, uint32_t end,
                           const char *type);
/* Whether the last features before `end` are hard, and there are any. */
bool qc__has_hard_features(const qc_pipeline *pipeline, const qc_bag *bag, uint32_t end);

/* The steps first .. end - 1 change the branch points; end = 0: there are none. */
typedef struct qc__optimisation {
    uint32_t first, end;
} qc__optimisation;
qc__optimisation qc__optimisation_find(const qc_pipeline *pipeline, uint32_t first, uint32_t end);
/* Puts what goes into these steps in the place of what comes out. */
qc_status qc__optimisation_undo(const qc_pipeline *pipeline, qc_bag *bag, qc__optimisation o);
/* Runs from `from` to before these steps; then, of hard features, whether they leave room for a
 * map with the field as it is. */
qc_status qc__optimisation_rehearse(qc_ctx *ctx, qc_pipeline *pipeline, qc_bag *bag,
                                    qc__optimisation o, uint32_t from, uint32_t round);

/* Fails where the quads of a component are not a manifold of quads with the topology of its mesh.
 */
qc_status qc__check_promises(qc_ctx *ctx, const qc_mesh *mesh, const qc_polygon_mesh *quads);

/* --- results --------------------------------------------------------------------------------- */

qc_status qc__warn(qc_ctx *ctx, qc_remesh_result *result, const char *format, ...) QC__PRINTF(3, 4);
/* Names component c by number, size and place, with the context's last error. */
qc_status qc__warn_failure(qc_ctx *ctx, const qc__parts *parts, int32_t c,
                           qc_remesh_result *result);

/* What the runs of the components made; entry c is NULL when there is none. */
typedef struct qc__collection {
    qc_polygon_mesh **quads, **uv; /* n components */
    qc_mesh **mesh;                /* those the quads are made from: the component or refined */
    qc_face_field **field;
    qc_report **report;
} qc__collection;
qc_status qc__collection_create(qc_ctx *ctx, int32_t n, qc__collection *out);
void qc__collection_clear(qc__collection *all, int32_t n);
/* Takes over what bag holds beyond `before`, the bag the run of component c began with. A field is
 * that on `mesh`, the component itself, else brought there from a refinement of it. */
qc_status qc__collection_add(qc_ctx *ctx, qc__collection *all, int32_t c, const qc_mesh *mesh,
                             const qc_bag *before, const qc_bag *bag);
/* Makes the barycentric coordinates of the merged quads those in the faces of parts->mesh where a
 * component was refined. */
qc_status qc__source_coordinates(qc_ctx *ctx, const qc__collection *all, const qc__parts *parts,
                                 qc_polygon_mesh *quads);
/* The field of a refinement of `mesh` on that: the mean cross of the parts of each face. */
qc_status qc__source_field(qc_ctx *ctx, const qc_mesh *mesh, const qc_face_field *field,
                           qc_face_field **out);
qc_status qc__collection_merge(qc_ctx *ctx, const qc__collection *all, const qc__parts *parts,
                               qc_remesh_result *result);

#endif
