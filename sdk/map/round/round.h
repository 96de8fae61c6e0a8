/* Rounding the periods of a seamless map: what its parts share. Internal to round*.c; the parts are
 * the alignment of features (round_align.c), one trial (round_trial.c), the search for the number
 * of quads (round_density.c) and the map that comes out (round_publish.c). */
#ifndef QC_MAP_ROUND_H
#define QC_MAP_ROUND_H

#include "sdk/map/periods/period_matrix.h"
#include "sdk/map/round/separation.h"
#include "sdk/map/quantize/exact_map.h"

static const double qc__round_slack = 1e-9; /* deviations nearer than that are equal */
/* Deviation of the number of quads which is good enough. */
static const double qc__round_promised = 0.05;

typedef struct qc__rounding {
    qc_ctx *ctx;
    const qc_seamless_map *seamless;
    const qc_mesh *mesh;
    qc_round_options options;
    double *cotangent; /* times the weights of the faces, which are those of the seamless map */
    qc__seams *seams;
    qc__periods *periods;
    qc__separation *separation;
    double *P;                               /* n^2, NULL = direct rounding only */
    double *period;                          /* n: real-valued periods in lattice units */
    double *gap;                             /* n: rounded minus scaled periods */
    double *target, *rounded, *best_rounded; /* n */
    qc_complex *z;  /* 3 n_faces: the frame field in combed charts, where there are features */
    double *symbol; /* n_symbols */
    double _Complex *wedge;          /* n_wedges */
    double _Complex *F, *correction; /* n_vertices: unknown coordinates of f, and what is added */
    qc_complex *f; /* 3 n_faces: the shifted, aligned seamless map                                */
    qc_complex *trial, *best; /* 3 n_faces */
    double curl_energy;       /* of f, before scaling */
    double best_scale, best_miss, harmonic, harmonic_direct;
    int64_t moves, evaluations;
    bool coarse;             /* this trial only tells the number of quads */
    bool quantized;          /* the best map is nearly that of quantization ... */
    qc__imprint imprint;     /* ... and, when it was wanted, that on a refined mesh */
    int32_t collisions;      /* pairs which could not be kept apart in the last trial ... */
    int32_t best_collisions; /* ... and in the best map                                           */
    int32_t wrong, best_wrong; /* cones which wind wrong */
} qc__rounding;

/* Signed area of the image: unit cells covered. */
double qc__round_area(const qc_complex *f, int32_t n_faces);
/* Whether the best map folds over or winds wrong. */
bool qc__round_folds(const qc__rounding *r);
/* 1/2 int |df - z|^2 of corner values f and a form z (3 n_faces each, NULL = 0) in the norm without
 * the weights of the faces. */
double qc__round_energy(const qc__rounding *r, const qc_complex *f, const qc_complex *z);
/* Puts the features of the seamless map on isolines, with real levels, and unfolds it. Then finds
 * what has to stay apart. */
qc_status qc__round_align(qc__rounding *r);
/* The rounded map at a scale and its number of quads; unless coarse, keeps it when it beats the
 * best one. */
qc_status qc__round_try(qc__rounding *r, double scale, double wanted, double *quads);
/* What comes after the integers are chosen: the harmonic map which closes the gap of r->rounded,
 * and its number of quads; keeps it as qc__round_try does. found: energies and work of the search,
 * NULL = unknown. */
qc_status qc__round_extend(qc__rounding *r, double scale, double wanted,
                           const qc_lattice_result *found, double *quads);
/* Whether quantization is allowed and could be tried. */
bool qc__round_can_quantize(const qc__rounding *r);
/* The same by quantization (docs/theory/quantization.md), which replaces the best map. *done: false
 * where the aligned map is not positive, so that nothing was changed. */
qc_status qc__round_quantized(qc__rounding *r, bool *done);
/* f (3 n_faces): the smooth map, which gives way to a feasible one with the same integers where it
 * folds over. mesh: that of r or a refinement of it. */
qc_status qc__round_blend(const qc__rounding *r, const qc_mesh *mesh, const qc_complex *smooth,
                          const qc_complex *feasible, qc_complex *f);
/* The best map whose number of quads meets what is asked for. */
qc_status qc__round_meet(qc__rounding *r);
/* Rotations across edges and features in the charts of the map (n_edges each); axis is left alone
 * where there are no features. */
void qc__round_charts(const qc__rounding *r, int8_t *rotation, int8_t *axis);
qc_status qc__round_publish(qc__rounding *r, qc_corner_map **out);

#endif
