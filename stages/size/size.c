/* Stage qc.size: target edge length of the quads. */
#include <qc/field.h>
#include <qc/stages.h>

#include <math.h>

typedef struct params {
    double quads, edge_length, edge_length_rel;
} params;

#define DEFAULT_QUADS 10000.0

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
    qc_status status = qc_sizing_create(run->ctx, mesh, length, quads, NULL, &out);
    return status ? status : run->output(run, "sizing", out);
}

static const qc_port inputs[] = {{"mesh", QC_TYPE_MESH, 0, "triangle mesh"}};
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
};

const qc_stage qc_stage_size = {
    QC_STAGE_SIZES,
    "qc.size",
    "1.0",
    "Choose the density of the quads",
    "The edge length h of a quad is edge_length, else edge_length_rel times the bounding box "
    "diagonal, "
    "else sqrt(area / quads). A length is meant literally; a number of quads is met by later "
    "stages.",
    "docs/files.md",
    inputs,
    outputs,
    1,
    1,
    table,
    3,
    sizeof(params),
    size,
};
