/* Named numbers at the vertices, faces and corners of polygon meshes. */
#include <string.h>

#include "sdk/mesh/internal.h"

void qc__polygon_free_attributes(qc_polygon_mesh *p) {
    for (int32_t i = 0; i < p->n_attributes; i++) qc__free(p->attribute[i].value);
    qc__free(p->attribute);
}

const qc_attribute *qc_polygon_mesh_attribute(const qc_polygon_mesh *p, int32_t at,
                                              const char *name) {
    for (int32_t i = 0; i < p->n_attributes; i++)
        if (p->attribute[i].at == at && strcmp(p->attribute[i].name, name) == 0)
            return &p->attribute[i];
    return NULL;
}

qc_status qc_polygon_mesh_add_attribute(qc_ctx *ctx, qc_polygon_mesh *p, const char *name,
                                        int32_t at, int32_t kind, int32_t width, double **value) {
    if (!name || !*name || width < 1 || at < QC_AT_VERTEX || at > QC_AT_CORNER ||
        kind < QC_ATTRIBUTE_LINEAR || kind > QC_ATTRIBUTE_LABEL)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "an attribute needs a name, a place, a kind and at least one number");
    if (qc_polygon_mesh_attribute(p, at, name))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "there is an attribute '%s' already; choose "
                        "another name",
                        name);
    qc_attribute *grown =
        qc__realloc(ctx, p->attribute, (size_t)p->n_attributes + 1, sizeof *grown);
    if (!grown) return QC_ERR_NOMEM;
    p->attribute = grown;
    /* one block: the numbers, then the name */
    const size_t n = (size_t)width * (size_t)qc_polygon_mesh_elements(p, at);
    const size_t whole = n + (strlen(name) + sizeof(double)) / sizeof(double);
    double *block = QC__ZERO(ctx, double, whole);
    if (!block) return QC_ERR_NOMEM;
    const qc_attribute a = {strcpy((char *)(block + n), name), at, kind, width, block};
    grown[p->n_attributes++] = a;
    if (value) *value = block;
    return QC_OK;
}

/* last[v]: the latest value at vertex v; next: earlier ones. */
static int32_t number(int32_t n_corners, const int32_t *corner_vertex, int32_t width,
                      const double *value, int32_t *index, double *distinct, int32_t *last,
                      int32_t *next) {
    const size_t size = (size_t)width * sizeof *value;
    int32_t n = 0;
    for (int32_t c = 0; c < n_corners; c++) {
        const double *x = value + (int64_t)width * c;
        int32_t *first = &last[corner_vertex[c]], i = *first;
        if (index[c] < 0) continue;
        while (i >= 0 && memcmp(distinct + (int64_t)width * i, x, size) != 0) i = next[i];
        if (i < 0) {
            i = n++;
            memmove(distinct + (int64_t)width * i, x, size);
            next[i] = *first;
            *first = i;
        }
        index[c] = i;
    }
    return n;
}

qc_status qc__number_corner_values(qc_ctx *ctx, int32_t n_vertices, int32_t n_corners,
                                   const int32_t *corner_vertex, int32_t width, const double *value,
                                   int32_t *index, double *distinct, int32_t *n) {
    int32_t *last = QC__NEW(ctx, int32_t, n_vertices), *next = QC__NEW(ctx, int32_t, n_corners);
    const qc_status status = last && next ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t v = 0; v < n_vertices; v++) last[v] = -1;
        *n = number(n_corners, corner_vertex, width, value, index, distinct, last, next);
    }
    qc__free(last);
    qc__free(next);
    return status;
}
