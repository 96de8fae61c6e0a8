/* Stage qc.size: target edge length of the quads. */
#include <qc/field.h>
#include <qc/stages.h>

#include <math.h>
#include <stdio.h>

#include "sdk/base/internal.h"

typedef struct params {
    double quads, edge_length, edge_length_rel;
    double turn, range, gradation, anisotropy;
    bool painted;
    const char *file;
} params;

#define PI 3.14159265358979323846

#define DEFAULT_QUADS 10000.0
/* More than any later stage can number. */
#define MOST_QUADS 268435456.0

static qc_status count_quads(const qc_run *run, const qc_sizing *sizing, double *n) {
    const qc_mesh *mesh = sizing->mesh;
    double *area = QC__NEW(run->ctx, double, mesh->n_faces);
    qc_status status =
        area ? qc_mesh_geometry(run->ctx, mesh, NULL, area, NULL, NULL, NULL, NULL) : QC_ERR_NOMEM;
    *n = 0;
    for (int32_t t = 0; !status && t < mesh->n_faces; t++) {
        const double h = sizing->length ? sizing->length[t] : sizing->edge_length;
        *n += area[t] / h / h;
    }
    qc__free(area);
    return status;
}

static qc_status check_number(const qc_run *run, const qc_sizing *sizing) {
    char text[160];
    double n;
    const qc_status status = count_quads(run, sizing, &n);
    if (status || n <= MOST_QUADS) return status;
    snprintf(text, sizeof text,
             "%g quads of edge length %g would be needed, more than the %.0f which are possible; "
             "ask for longer edges or fewer quads",
             n, sizing->edge_length, MOST_QUADS);
    return (run->fail)(run, QC_ERR_ARGUMENT, -1, text);
}

/* Precedence: edge_length, edge_length_rel, quads, the default number. */
static qc_status size(const qc_run *run, const void *p) {
    const params *given = p;
    const qc_mesh *mesh = run->input(run, "mesh");
    double quads = given->quads > 0 ? given->quads : DEFAULT_QUADS,
           length = sqrt(mesh->area / quads);
    if (given->edge_length > 0 || given->edge_length_rel > 0) {
        quads = 0;
        length =
            given->edge_length > 0 ? given->edge_length : given->edge_length_rel * mesh->diagonal;
    }
    qc_sizing *out = NULL;
    qc_status status;
    if (given->turn > 0 || given->painted || given->file || given->anisotropy > 1) {
        qc_size_options options = QC_SIZE_OPTIONS_INIT;
        options.edge_length = length;
        options.turn = given->turn * PI / 180;
        options.range = given->range;
        options.gradation = given->gradation;
        options.anisotropy = given->anisotropy;
        options.painted = given->painted;
        options.path = given->file;
        options.input = run->input(run, "input");
        status = qc_sizing_create_varying(run->ctx, mesh, quads, &options, &out);
    } else {
        status = qc_sizing_create(run->ctx, mesh, length, quads, NULL, &out);
    }
    if (status) return status;
    status = check_number(run, out);
    if (!status) return run->output(run, "sizing", out);
    qc_object_release(out);
    return status;
}

static const qc_port inputs[] = {
    {"mesh", QC_TYPE_MESH, 0, "triangle mesh"},
    {"input", QC_TYPE_POLYGON_MESH, QC_PORT_OPTIONAL,
     "what it was repaired from: painted density, and what a file of lengths counts"},
};
static const qc_port outputs[] = {{"sizing", QC_TYPE_SIZING, 0, "target edge length"}};
static const qc_param table[] = {
    QC_PARAM_REAL(
        params, quads, 0, 0, 1e9, "",
        "number of quads to be met; 0 = not given (10000 when no length is given either)"),
    QC_PARAM_REAL(
        params, edge_length, 0, 0, 1e300, "length",
        "edge length of a quad in the units of the mesh; 0 = not given; wins over the others"),
    QC_PARAM_REAL(params, edge_length_rel, 0, 0, 1, "diagonal",
                  "edge length of a quad in parts of the bounding box diagonal; 0 = not given"),
    QC_PARAM_REAL(params, turn, 0, 0, 180, "deg",
                  "edges shrink where the surface turns by more along them; 0 = same length "
                  "everywhere"),
    QC_PARAM_REAL(params, range, 4, 1, 100, "",
                  "factor by which curvature and paint change the length at most"),
    QC_PARAM_REAL(params, gradation, 0.25, 0, 10, "",
                  "lengths grow by at most this times the way on the surface; 0 = no limit"),
    QC_PARAM_REAL(
        params, anisotropy, 1, 1, 100, "",
        "edges in the direction of least curvature are longer by at most this factor than "
        "those across; 1 = as long"),
    QC_PARAM_BOOL(params, painted, false,
                  "the PLY vertex property `quality` multiplies the number of quads on an area"),
    QC_PARAM_TEXT(params, file,
                  "text file with a length for each vertex, or for each face, of the input, or "
                  "five numbers: a length along a direction, that across, the direction"),
};

const qc_stage qc_stage_size = {
    QC_STAGE_SIZES,
    "qc.size",
    "1.0",
    "Choose the density of the quads",
    "The edge length h of a quad is edge_length, else edge_length_rel times the bounding box "
    "diagonal, "
    "else sqrt(area / quads). A length is meant literally; a number of quads is met by later "
    "stages. turn, painted and file make the length change over the surface, anisotropy and file "
    "with the direction (h is the geometric mean of the two lengths then); with a number of quads "
    "all lengths are scaled to ask for that many.",
    "docs/files.md",
    inputs,
    outputs,
    2,
    1,
    table,
    sizeof table / sizeof *table,
    sizeof(params),
    size,
};
