/* Writing a polygon mesh: checks, the format by extension, a temporary which is renamed. */
#include "output.h"

#include <math.h>
#include <string.h>

static qc_status check_finite(qc_ctx *ctx, const double *x, int64_t n, int dimension,
                              const char *what) {
    for (int64_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return qc__fail(ctx, QC_ERR_ARGUMENT, i / dimension,
                            "%s %lld is not finite and cannot be written", what,
                            (long long)(i / dimension));
    return QC_OK;
}

static qc_status check(qc_ctx *ctx, const qc_polygon_mesh *m) {
    static const char *const places[] = {"vertex", "face", "corner"};
    qc_status status = check_finite(ctx, m->position, 3 * (int64_t)m->n_vertices, 3, "vertex");
    if (status == QC_OK && m->uv)
        status = check_finite(ctx, m->uv, 2 * (int64_t)m->n_uvs, 2, "texture coordinate");
    for (int32_t i = 0; i < m->n_attributes && status == QC_OK; i++) {
        const qc_attribute *a = &m->attribute[i];
        char what[96];
        snprintf(what, sizeof what, "attribute '%.60s' of %s", a->name, places[a->at]);
        status = check_finite(ctx, a->value, (int64_t)a->width * qc_polygon_mesh_elements(m, a->at),
                              a->width, what);
    }
    return status;
}

static int32_t format_of(const char *path) {
    if (qc__ends_in(path, ".ply")) return QC_FORMAT_PLY;
    if (qc__ends_in(path, ".off")) return QC_FORMAT_OFF;
    return QC_FORMAT_OBJ;
}

static qc_status put(qc_ctx *ctx, qc__output *o, const qc_polygon_mesh *m, int32_t format,
                     const char *comment) {
    switch (format) {
    case QC_FORMAT_OBJ:
        return qc__write_obj(ctx, o, m, comment);
    case QC_FORMAT_OFF:
        return qc__write_off(ctx, o, m, comment);
    default:
        return qc__write_ply(ctx, o, m, format == QC_FORMAT_PLY_ASCII, comment);
    }
}

qc_status qc_polygon_mesh_write_as(qc_ctx *ctx, const qc_polygon_mesh *mesh, const char *path,
                                   int32_t format, const char *comment) {
    qc__writer writer;
    if (format < QC_FORMAT_AUTO || format > QC_FORMAT_PLY_ASCII)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "%d is no format of files; take QC_FORMAT_...",
                        (int)format);
    qc_status status = check(ctx, mesh);
    if (status != QC_OK) return status;
    qc__output *o = QC__NEW(ctx, qc__output, 1);
    if (!o) return QC_ERR_NOMEM;
    status = qc__writer_open(ctx, path, &writer);
    if (status == QC_OK) {
        o->file = writer.file;
        o->n = 0;
        o->failed = false;
        status = put(ctx, o, mesh, format == QC_FORMAT_AUTO ? format_of(path) : format, comment);
        qc__flush(o);
        if (status == QC_OK)
            status = qc__writer_commit(ctx, &writer); /* sees write errors */
        else
            qc__writer_abort(&writer);
    }
    qc__free(o);
    return status;
}

qc_status qc_polygon_mesh_write(qc_ctx *ctx, const qc_polygon_mesh *mesh, const char *path,
                                const char *comment) {
    return qc_polygon_mesh_write_as(ctx, mesh, path, QC_FORMAT_AUTO, comment);
}
