/* Triangles as user geometry, in coordinates about the centre of their box. */
#include "scene.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void qe_scene_free(qe_scene *s) {
    if (s->scene) rtcReleaseScene(s->scene);
    if (s->device) rtcReleaseDevice(s->device);
    free(s->corner);
    memset(s, 0, sizeof *s);
}

static void bounds(const struct RTCBoundsFunctionArguments *args) {
    const qe_scene *s = args->geometryUserPtr;
    const double *x = s->corner + 9 * (size_t)args->primID;
    double lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        lo[k] = (fmin(fmin(x[k], x[3 + k]), x[6 + k]) - s->centre[k]) * s->scale - QE_SLACK;
        hi[k] = (fmax(fmax(x[k], x[3 + k]), x[6 + k]) - s->centre[k]) * s->scale + QE_SLACK;
    }
    *args->bounds_o = (struct RTCBounds){(float)lo[0], (float)lo[1], (float)lo[2], 0,
                                         (float)hi[0], (float)hi[1], (float)hi[2], 0};
}

static void fit(qe_scene *s) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        s->lo[k] = DBL_MAX;
        s->hi[k] = -DBL_MAX;
        for (size_t i = 0; i < 3 * (size_t)s->n; i++) {
            s->lo[k] = fmin(s->lo[k], s->corner[3 * i + (size_t)k]);
            s->hi[k] = fmax(s->hi[k], s->corner[3 * i + (size_t)k]);
        }
        s->centre[k] = s->lo[k] / 2 + s->hi[k] / 2;
        sum = hypot(sum, s->hi[k] - s->lo[k]);
    }
    s->scale = sum > 0 ? 1 / sum : 1;
}

static qc_status failure(qc_ctx *ctx, RTCDevice device, const char *what) {
    char text[128];
    const enum RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "embree: out of memory");
    snprintf(text, sizeof text, "embree: %s (its error %d)", what, (int)error);
    return qc_ctx_fail(ctx, QC_ERR_FAILED, -1, text);
}

static qc_status commit(qc_ctx *ctx, qe_scene *s, RTCIntersectFunctionN intersect) {
    char config[32];
    snprintf(config, sizeof config, "threads=%u", (unsigned)qc_ctx_threads(ctx));
    s->device = rtcNewDevice(config);
    if (!s->device) return failure(ctx, NULL, "no device");
    s->scene = rtcNewScene(s->device);
    RTCGeometry geometry = rtcNewGeometry(s->device, RTC_GEOMETRY_TYPE_USER);
    if (!s->scene || !geometry) return failure(ctx, s->device, "no scene");
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)s->n);
    rtcSetGeometryUserData(geometry, s);
    rtcSetGeometryBoundsFunction(geometry, bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(s->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(s->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(s->scene);
    const enum RTCError error = rtcGetDeviceError(s->device);
    if (error == RTC_ERROR_NONE) return QC_OK;
    return qc_ctx_fail(ctx, error == RTC_ERROR_OUT_OF_MEMORY ? QC_ERR_NOMEM : QC_ERR_FAILED, -1,
                       "embree: the scene cannot be built");
}

qc_status qe_scene_create(qc_ctx *ctx, int32_t n, const double *position, const int32_t *vertex,
                          RTCIntersectFunctionN intersect, qe_scene *out) {
    memset(out, 0, sizeof *out);
    out->n = n;
    out->corner = malloc(9 * (size_t)n * sizeof(double));
    if (!out->corner) return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "embree: out of memory");
    for (size_t i = 0; i < 3 * (size_t)n; i++)
        memcpy(out->corner + 3 * i, position + 3 * (size_t)vertex[i], 3 * sizeof(double));
    fit(out);
    qc_status status = qc_ctx_progress(ctx, 0) ? QC_OK : QC_ERR_CANCELLED;
    if (status == QC_OK) status = commit(ctx, out, intersect);
    if (status != QC_OK) qe_scene_free(out);
    return status;
}
