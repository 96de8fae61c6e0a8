/* Parts of the page of a run (docs/report.md). */
#ifndef QC_CLI_REPORT_H
#define QC_CLI_REPORT_H

#include "bindings/cli/cli.h"
#include <jansson.h>

/* --- arrays of integers, packed -------------------------------------------------------------- */

enum { CLI_ARRAYS_MAX = 16 };
typedef struct cli_arrays {
    json_t *list; /* {name, count, stride} of each */
    unsigned char *bytes;
    size_t size;
    bool failed; /* out of memory */
} cli_arrays;

/* Room for n integers, or NULL. */
int32_t *cli_integers(size_t n);
/* Appends count values, neighbours in value being `stride` apart, and frees them. values NULL: out
 * of memory. */
void cli_arrays_add(cli_arrays *arrays, const char *name, int32_t *values, size_t count,
                    int stride);
/* free() it. NULL: out of memory. */
char *cli_base64(const unsigned char *in, size_t n);
/* All arrays deflated as base64 text; free() it. NULL: out of memory. */
char *cli_arrays_text(const cli_arrays *arrays);
void cli_arrays_free(cli_arrays *arrays);

/* --- the map as triangles ----------------------------------------------------------------------
 */

typedef struct cli_grid {
    size_t n_points, n_corners; /* three corners a triangle */
    double *position;           /* 3 n_points                */
    int32_t *corner;            /* n_corners: point          */
    double *uv;                 /* 2 n_corners               */
} cli_grid;
/* false: out of memory. To be freed in either case. */
bool cli_grid_create(const qc_polygon_mesh *uv, cli_grid *out);
void cli_grid_free(cli_grid *grid);

/* --- singularities ---------------------------------------------------------------------------- */

typedef struct cli_cone {
    double position[3];
    int32_t index4;
} cli_cone;
typedef struct cli_cones {
    size_t n;
    cli_cone *cone; /* owned */
} cli_cones;
/* false: out of memory, or the library failed. */
bool cli_cones_create(qc_ctx *ctx, const qc_remesh_result *result, cli_cones *out);

/* --- contents -------------------------------------------------------------------------------- */

/* Quantises what the run made and adds it to `arrays`; the rest of the description as JSON. NULL:
 * out of memory, or the library failed. */
json_t *cli_report_geometry(qc_ctx *ctx, const qc_remesh_result *result, cli_arrays *arrays);
/* Edge lengths / mean and corner angles (thesis, Figure 7.1), JSON. */
json_t *cli_histograms(const qc_polygon_mesh *quads);

/* Curves: {step, curves: {name: [[x, y], ...]}} of each run of a step, in order. */
json_t *cli_report_trace(const cli_sample *sample, size_t n);

/* The page without its data: bindings/report/viewer.html. */
extern const char cli_viewer[];

#endif
