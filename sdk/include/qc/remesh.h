/* qc/remesh.h - triangle mesh in, quad mesh out: the default pipeline, run per connected component.
 *
 * Everything here can be done by hand with qc/pipeline.h; this is the driver the command line uses.
 * Thread rule: that of qc/pipeline.h. */
#ifndef QC_REMESH_H
#define QC_REMESH_H

#include <qc/map.h>
#include <qc/pipeline.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- the default pipeline -------------------------------------------------------------------- */

enum {
    QC_MODE_FAST = 0,     /* none */
    QC_MODE_RELOCATE = 1, /* steps cancel and curl: they move and cancel */
    QC_MODE_BEST = 2      /* cancel, curl with new ones, balance: Algorithm 6.1 */
};
typedef struct qc_default_pipeline_options {
    uint32_t struct_size;
    /* Density: at most one is > 0; all 0 = the default of stage qc.size. */
    double quads;           /* target number of quads */
    double edge_length;     /* in the units of the mesh */
    double edge_length_rel; /* in units of the bounding box diagonal */
    double crease_angle;    /* degrees; 0 = default (35); < 0: neither creases nor boundaries */
    const char *field_path; /* .rawfield or .rosy to use instead of a computed field; NULL = none */
    uint64_t seed;          /* of stages which have one; 0 = their default */
    int32_t mode;           /* QC_MODE_...: optimisation of the branch points */
    int32_t keep_groups;    /* 1: borders of groups and materials are hard features, so that no quad
                               crosses them; with features only (crease_angle >= 0) */
} qc_default_pipeline_options;
#define QC_DEFAULT_PIPELINE_OPTIONS_INIT                                                           \
    { sizeof(qc_default_pipeline_options), 0.0, 0.0, 0.0, 0.0, NULL, 0, QC_MODE_FAST, 0 }

/* repair, size, features, refine, curvature and smooth (or field, when a file is given), matching,
 * cancel, curl and balance (as `mode` says), split, open, hodge, round, untangle, extract, finish,
 * measure. Change it with qc_pipeline_set, _insert, _remove. options NULL = defaults. Errors:
 * ARGUMENT (densities or a range), NOT_FOUND (a stage is not registered), NOMEM. */
QC_API qc_status qc_default_pipeline(qc_ctx *ctx, qc_registry *registry,
                                     const qc_default_pipeline_options *options, qc_pipeline **out);

/* --- remeshing ------------------------------------------------------------------------------- */

typedef struct qc_remesh_options {
    uint32_t struct_size;
    int32_t strict;       /* 1: a component which fails fails the call */
    const char *symmetry; /* NULL, "off": none; "auto": about any plane; "x", "y", "z": about one
                             across that axis; "nx,ny,nz,d": about nx x + ny y + nz z = d */
} qc_remesh_options;
#define QC_REMESH_OPTIONS_INIT                                                                     \
    { sizeof(qc_remesh_options), 0, NULL }

/* ARGUMENT where qc_remesh would not understand its options. */
QC_API qc_status qc_remesh_check(qc_ctx *ctx, const qc_remesh_options *options);

/* Members are NULL when no step made them. */
typedef struct qc_remesh_result {
    qc_mesh *mesh;             /* the whole surface after the first steps (repaired) */
    qc_repair_report *repairs; /* what was changed to get it; logged as warnings, too */
    qc_polygon_mesh *quads;    /* source_face counts faces of the input, whose
                                  attributes, groups and uvs they have */
    qc_polygon_mesh *uv;       /* the triangles with one vt per corner */
    qc_face_field *field; /* cross field on `mesh`; components that failed have a constant one */
    qc_report *report;    /* sums over the components; report->input is that of `mesh` */
    int32_t n_failed;     /* components without a result */
    int32_t n_warnings;
    char **warning; /* one line each: components that failed */
} qc_remesh_result;

/* Runs the steps up to and including the first that outputs a qc.mesh/1 on the whole input (bag
 * name "input"), then the others once per connected component, in order. A target number of quads
 * is shared by area, a relative edge length is made absolute once (parameters of the steps of stage
 * qc.size). A component that fails becomes a warning which names it, the stage and the reason,
 * unless strict or unless all fail; so does one whose quads are not a manifold of quads with its
 * number of boundary loops and its Euler characteristic. Where borders of groups are hard features
 * (qc.features: `groups`, `hard`) a warning names quads which cross one.
 *
 * With a plane of symmetry only the half on the side of its normal is remeshed, its boundary on the
 * plane being a hard feature (parameter "hard" of the step of stage qc.features), and mirrored; the
 * results are those of the whole surface, and the quads are symmetric, to the last bit where the
 * plane is across a coordinate axis. Where "auto" finds none, or the plane does not cut the surface
 * or the halves do not fit together, it is remeshed as a whole, with a warning. The surface counts
 * as symmetric when mirrored points are within 0.5 % of the diagonal of it; a plane which is asked
 * for
 * ("x", ...) is used in any case, so that the half on its positive side wins. Errors: those of the
 * stages (qc_error.stage = the step); FAILED for such quads; CANCELLED. */
QC_API qc_status qc_remesh(qc_ctx *ctx, qc_pipeline *pipeline, const qc_polygon_mesh *input,
                           const qc_remesh_options *options, qc_remesh_result *result);
/* Releases all members and zeroes the struct. NULL is fine. */
QC_API void qc_remesh_result_clear(qc_remesh_result *result);

/* --- statistics ------------------------------------------------------------------------------ */

/* Ratios made from the sums of a report, as the keys of the statistics say (docs/files.md). */
typedef struct qc_figures {
    double rsd_edge, rsd_angle, hausdorff_rel, mean_dist_rel, feature_distance_rel, arap_mean;
} qc_figures;
QC_API void qc_report_figures(const qc_report *report, qc_figures *out);

typedef struct qc_stats_options {
    uint32_t struct_size;
    const char *input, *mode;  /* texts of these keys; NULL = "" */
    double total, read, write; /* seconds                        */
    int32_t n_warnings;
    const char *const *warning;
} qc_stats_options;
#define QC_STATS_OPTIONS_INIT                                                                      \
    { sizeof(qc_stats_options), NULL, NULL, 0.0, 0.0, 0.0, 0, NULL }
/* The statistics of a run as JSON text with the keys of docs/files.md, freed with qc_text_free.
 * pipeline (may be NULL): the one which was run. Errors: INPUT (a text is not UTF-8), NOMEM. */
QC_API qc_status qc_stats_json(qc_ctx *ctx, const qc_report *report, const qc_pipeline *pipeline,
                               const qc_stats_options *options, char **json);

#ifdef __cplusplus
}
#endif
#endif
