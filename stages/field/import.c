/* Stage qc.field.import: cross field from a .rawfield or .rosy file. */
#include <qc/field.h>
#include <qc/stages.h>

#define PI 3.14159265358979323846

typedef struct params {
    const char *file;
    double agree;
} params;

static qc_status import(const qc_run *run, const void *p) {
    const params *given = p;
    if (!given->file)
        return run->fail(run, QC_ERR_ARGUMENT, -1, "no file given: set the parameter `file`");
    qc_face_field *out = NULL;
    const qc_mesh *mesh = run->input(run, "mesh");
    const qc_features *features = run->input(run, "features");
    if (features && features->mesh != mesh)
        return run->fail(run, QC_ERR_ARGUMENT, -1, "the features belong to another mesh");
    qc_status status = qc_face_field_read(run->ctx, mesh, given->file, &out);
    if (status || !features || !features->hard)
        return status ? status : run->output(run, "field", out);
    qc_face_field *read = out;
    status = qc_field_follow(run->ctx, read, features->edge, given->agree * PI / 180, &out);
    qc_object_release(read);
    return status ? status : run->output(run, "field", out);
}

static const qc_port inputs[] = {
    {"mesh", QC_TYPE_MESH, 0, "the triangle mesh the field is on"},
    {"features", QC_TYPE_FEATURES, QC_PORT_OPTIONAL, "hard features which the field may follow"},
};
static const qc_port outputs[] = {{"field", QC_TYPE_FACE_FIELD, 0, "the cross field of the file"}};
static const qc_param table[] = {
    QC_PARAM_TEXT(params, file, ".rawfield or .rosy file, recognised by its content; - = stdin"),
    QC_PARAM_REAL(params, agree, 15, 0, 45, "deg",
                  "hard features which the field follows within this angle are kept, the others "
                  "dropped"),
};

const qc_stage qc_stage_field_import = {
    QC_STAGE_SIZES,
    "qc.field.import",
    "1.0",
    "Read a cross field from a file",
    "Reads Directional's .rawfield (`N F`, then N vectors a face) or .rosy (F, N, then one vector "
    "a "
    "face). Vectors are projected to their face; only their direction counts. Faces are those of "
    "the "
    "file the mesh was read from, also after repair. Along hard features which it follows "
    "nearly, the field is turned to follow them exactly.",
    "docs/files.md",
    inputs,
    outputs,
    2,
    1,
    table,
    2,
    sizeof(params),
    import,
};
