/* The warnings of a result: which components failed and why. */
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "sdk/remesh/internal.h"

qc_status qc__warn(qc_ctx *ctx, qc_remesh_result *result, const char *format, ...) {
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    char *copy = QC__NEW(ctx, char, strlen(text) + 1);
    if (!copy) return QC_ERR_NOMEM;
    char **grown = qc__realloc(ctx, result->warning, (size_t)result->n_warnings + 1, sizeof *grown);
    if (!grown) {
        qc__free(copy);
        return QC_ERR_NOMEM;
    }
    memcpy(copy, text, strlen(text) + 1);
    result->warning = grown;
    result->warning[result->n_warnings++] = copy;
    return QC_OK;
}

qc_status qc__warn_failure(qc_ctx *ctx, const qc__parts *parts, int32_t c,
                           qc_remesh_result *result) {
    double lo[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, hi[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (int32_t i = parts->vertex_start[c]; i < parts->vertex_start[c + 1]; i++)
        for (int k = 0; k < 3; k++) {
            const double x = parts->mesh->position[3 * (int64_t)parts->vertex[i] + k];
            lo[k] = fmin(lo[k], x);
            hi[k] = fmax(hi[k], x);
        }
    const qc_error *error = qc_ctx_error(ctx);
    return qc__warn(
        ctx, result,
        "component %d of %d (%d faces, from (%g, %g, %g) to (%g, %g, %g)) has no result: "
        "%s: %s",
        (int)c + 1, (int)parts->n, (int)(parts->face_start[c + 1] - parts->face_start[c]), lo[0],
        lo[1], lo[2], hi[0], hi[1], hi[2], error->stage, error->text);
}
