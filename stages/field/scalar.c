/* Stage qc.field.scalar: the gradient of a function on the vertices as cross field (second paper,
 * section 6). */
#include "sdk/base/internal.h"
#include <qc/field.h>
#include <qc/stages.h>

#include <stdio.h>

typedef struct params {
    int32_t direction;
    const char *file;
    double persistence;
} params;

/* Numbers separated by white space. */
static qc_status parse(const qc_run *run, const char *path, const char *text, int64_t *n,
                       double **out) {
    int64_t capacity = 0;
    *n = 0;
    for (const char *at = text;; (*n)++) {
        char *end = NULL;
        while (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t') at++;
        if (!*at) return QC_OK;
        const double value = qc__parse_double(at, &end);
        if (end == at)
            return qc__fail(run->ctx, QC_ERR_INPUT, *n, "%s: value %lld is not a number", path,
                            (long long)*n + 1);
        if (!qc__reserve(run->ctx, (void **)out, &capacity, *n + 1, sizeof **out))
            return QC_ERR_NOMEM;
        (*out)[*n] = value;
        at = end;
    }
}

/* The value of a vertex is that of its number in the file of the mesh. */
static qc_status read_values(const qc_run *run, const char *path, const qc_mesh *mesh, double *g) {
    char *text = NULL;
    double *value = NULL;
    size_t size = 0;
    int64_t n = 0;
    qc_status status = qc__read_file(run->ctx, path, &text, &size);
    if (!status) status = parse(run, path, text, &n, &value);
    for (int32_t v = 0; !status && v < mesh->n_vertices; v++) {
        const int32_t source = mesh->source_vertex ? mesh->source_vertex[v] : v;
        if (source < 0 || source >= n)
            status = qc__fail(run->ctx, QC_ERR_INPUT, v,
                              "%s has %lld values, none for vertex %d of the mesh", path,
                              (long long)n, (int)source + 1);
        else
            g[v] = value[source];
    }
    qc__free(text);
    qc__free(value);
    return status;
}

static qc_status compute(const qc_run *run, const params *p, const qc_mesh *mesh, double *g) {
    if (p->file && *p->file) return read_values(run, p->file, mesh, g);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        g[v] = mesh->position[3 * (int64_t)v + p->direction];
    return QC_OK;
}

static qc_status simplify(const qc_run *run, double persistence, const qc_mesh *mesh, double *g) {
    int32_t removed = 0;
    char text[64];
    const qc_status status = qc_scalar_simplify(run->ctx, mesh, persistence, g, &removed);
    snprintf(text, sizeof text, "%d low extrema removed", (int)removed);
    if (!status && removed > 0) run->log(run, QC_LOG_INFO, text);
    return status;
}

static qc_status scalar(const qc_run *run, const void *p) {
    const params *o = p;
    const qc_mesh *mesh = run->input(run, "mesh");
    const size_t F = (size_t)mesh->n_faces;
    double *g = QC__NEW(run->ctx, double, mesh->n_vertices), *weight = QC__NEW(run->ctx, double, F);
    qc_complex *x = QC__NEW(run->ctx, qc_complex, F);
    uint8_t *trusted = QC__ZERO(run->ctx, uint8_t, F);
    qc_face_field *out = NULL;
    qc_status status = g && weight && x && trusted ? compute(run, o, mesh, g) : QC_ERR_NOMEM;
    if (!status) status = simplify(run, o->persistence, mesh, g);
    if (!status) status = qc_field_gradient(run->ctx, mesh, g, x, weight, trusted);
    if (!status) status = qc_face_field_create(run->ctx, mesh, x, weight, trusted, &out);
    if (!status) out->is_vector = 1;
    qc__free(g);
    qc__free(weight);
    qc__free(x);
    qc__free(trusted);
    return status ? status : run->output(run, "field", out);
}

static const qc_port inputs[] = {{"mesh", QC_TYPE_MESH, 0, "triangle mesh"}};
static const qc_port outputs[] = {
    {"field", QC_TYPE_FACE_FIELD, 0,
     "direction of the gradient, weighted by its length; faces without gradient are not trusted"},
};
static const char *const directions[] = {"x", "y", "z", NULL};
static const qc_param table[] = {
    QC_PARAM_ENUM(params, direction, 2, directions, "the function is this coordinate"),
    QC_PARAM_TEXT(
        params, file,
        "file with one value for each vertex of the input, taken instead of a coordinate; "
        "- = stdin"),
    QC_PARAM_REAL(params, persistence, 0.01, 0.0, 0.99, NULL,
                  "extrema which rise above the saddle beside them by less than this part of the "
                  "range of the function are removed"),
};

const qc_stage qc_stage_field_scalar = {
    QC_STAGE_SIZES,
    "qc.field.scalar",
    "1.0",
    "Follow the gradient of a function on the vertices",
    "u runs along the gradient, v around it: isolines of the function become grid lines. Its "
    "extrema are "
    "vertices of index 1, its saddles of index -1. Neighbouring gradients are matched without "
    "quarter "
    "turns. Leave out the stages which optimise branch points after it.",
    "second paper, section 6, Figures 1 and 10",
    inputs,
    outputs,
    1,
    1,
    table,
    3,
    sizeof(params),
    scalar,
};
