/* The untangling energy of one patch of a map. Internal to sdk/map.
 *
 * The sum of that of its faces (face_energy.h); eps falls with the worst determinant. The target
 * shape is the face itself in units of the quad edge length. */
#ifndef QC_MAP_UNTANGLE_ENERGY_H
#define QC_MAP_UNTANGLE_ENERGY_H

#include "sdk/map/untangle/face_energy.h"
#include "sdk/map/untangle/reduced_map.h"

typedef struct qc__patch {
    const qc__reduced_map *map;
    const qc_complex
        *hat;           /* 3 n_faces: gradient of the hat function of each corner, target frame   */
    const double *area; /* n_faces: of the target shapes                                         */
    int32_t n_vertices, n_faces;
    const int32_t *vertex; /* active vertices: unknowns (2j, 2j+1) of vertex j */
    const int32_t *face; /* faces with an active vertex                                           */
    const int32_t *local; /* mesh vertex -> j, -1 */
    double eps;
    bool positive; /* all faces are and stay: their energy is qc__face_barrier */
    int64_t work;  /* faces evaluated so far */
    int64_t work_limit;
} qc__patch;

/* Target shapes, slivers thickened to `thinnest`: hat (3 n_faces), area (n_faces). */
qc_status qc__untangle_targets(qc_ctx *ctx, const qc_mesh *mesh, double edge_length,
                               double thinnest, qc_complex *hat, double *area);
/* det J of face t for the values of the map. */
double qc__face_det(const qc__reduced_map *map, const qc_complex *hat, int32_t t);
/* Energy and gradient at x (2 n_vertices). */
double qc__patch_energy(qc__patch *patch, const double *x, double *gradient);
/* Lowers the energy from x until the patch is clean, no better, or work_limit is reached; x in
 * place. */
qc_status qc__patch_minimise(qc_ctx *ctx, qc__patch *patch, const qc_untangle_options *options,
                             double *x);
/* From a patch whose faces are all positive: lowers the symmetric Dirichlet energy for at most
 * `steps` steps, each ending short of where a face collapses; x in place. */
qc_status qc__patch_relax(qc_ctx *ctx, qc__patch *patch, int32_t steps, double *x);
/* Length of the step along p, in units of p, within which the faces stay positive. */
double qc__patch_limit(const qc__patch *patch, const double *x, const double *p);
/* Smallest det J over the faces of the patch. */
double qc__patch_min_det(const qc__patch *patch, const double *x);

#endif
