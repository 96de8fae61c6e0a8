/* Stage qc.features: crease and boundary edges of a mesh. */
#include <qc/mesh.h>
#include <qc/stages.h>

#define PI 3.14159265358979323846

typedef struct params {
    double angle;
    bool hard;
} params;

static qc_status features(const qc_run *run, const void *p) {
    const params *given = p;
    qc_features *out = NULL;
    qc_status status = qc_features_detect(run->ctx, run->input(run, "mesh"),
                                          given->angle * PI / 180, 0, NULL, &out);
    if (status) return status;
    out->hard = given->hard;
    return run->output(run, "features", out);
}

static const qc_port inputs[] = {{"mesh", QC_TYPE_MESH, 0, "triangle mesh"}};
static const qc_port outputs[] = {
    {"features", QC_TYPE_FEATURES, 0, "flags of crease and boundary edges"},
};
static const qc_param table[] = {
    QC_PARAM_REAL(params, angle, 35, 0, 180, "deg",
                  "edges whose faces' normals differ by more are creases; 180 = boundaries only"),
    QC_PARAM_BOOL(params, hard, false,
                  "isolines have to follow the features; off: they guide the field only"),
};

const qc_stage qc_stage_features = {
    QC_STAGE_SIZES,
    "qc.features",
    "1.0",
    "Find crease and boundary edges",
    "An edge is a crease when the angle between the normals of its two faces exceeds `angle`. "
    "Boundary "
    "edges are features always. Later stages turn the cross field along features and put them on "
    "integer isolines.",
    "thesis 2.1, 5.1.2",
    inputs,
    outputs,
    1,
    1,
    table,
    2,
    sizeof(params),
    features,
};
