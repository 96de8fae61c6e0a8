/* Stage qc.field.import: cross field from a .rawfield or .rosy file. */
#include <qc/field.h>
#include <qc/stages.h>

typedef struct params {
    const char *file;
} params;

static qc_status import(const qc_run *run, const void *p) {
    const params *given = p;
    if (!given->file)
        return run->fail(run, QC_ERR_ARGUMENT, -1, "no file given: set the parameter `file`");
    qc_face_field *out = NULL;
    qc_status status = qc_face_field_read(run->ctx, run->input(run, "mesh"), given->file, &out);
    return status ? status : run->output(run, "field", out);
}

static const qc_port inputs[] = {{"mesh", QC_TYPE_MESH, 0, "the triangle mesh the field is on"}};
static const qc_port outputs[] = {{"field", QC_TYPE_FACE_FIELD, 0, "the cross field of the file"}};
static const qc_param table[] = {
    QC_PARAM_TEXT(params, file, ".rawfield or .rosy file, recognised by its content; - = stdin"),
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
    "file the mesh was read from, also after repair.",
    "docs/files.md",
    inputs,
    outputs,
    1,
    1,
    table,
    1,
    sizeof(params),
    import,
};
