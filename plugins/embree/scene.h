/* A triangle list as an Embree scene of user geometry: Embree finds candidates in single precision,
 * in boxes which are a little too large; the exact test of the SDK decides. */
#ifndef QE_SCENE_H
#define QE_SCENE_H

#include <embree3/rtcore.h>
#include <qc/base.h>

/* How much the boxes and searches are larger than need be, in units of the diagonal. Single
 * precision errs by 6e-8 of a coordinate (at most 1 here) in the box, the point or the ray. */
#define QE_SLACK 2e-6

typedef struct qe_scene {
    RTCDevice device;
    RTCScene scene;
    double centre[3], scale; /* inside Embree: (x - centre) scale, of diagonal 1 */
    double lo[3], hi[3];     /* of all triangles */
    double *corner;          /* 9 a triangle */
    int32_t n;
} qe_scene;

/* The intersect function is called for rays that enter the box of a triangle. */
qc_status qe_scene_create(qc_ctx *ctx, int32_t n, const double *position, const int32_t *vertex,
                          RTCIntersectFunctionN intersect, qe_scene *out);
void qe_scene_free(qe_scene *scene);

#endif
