/* Distances to a plane and mirror images. About a plane across a coordinate axis every mirror image
 * of a mirror image is the point itself once qc__mirror_pair has been there, to the last bit. */
#ifndef QC_MESH_PLANE_H
#define QC_MESH_PLANE_H

#include "sdk/mesh/internal.h"

/* The axis along which the normal lies, exactly; -1 = none. */
static inline int qc__plane_axis(const qc_plane *plane) {
    for (int k = 0; k < 3; k++)
        if (fabs(plane->normal[k]) == 1) return k;
    return -1;
}

static inline double qc__plane_distance(const qc_plane *plane, const double p[3]) {
    return qc__dot3(plane->normal, p) - plane->offset;
}

static inline void qc__mirror(const qc_plane *plane, const double p[3], double out[3]) {
    const int axis = qc__plane_axis(plane);
    const double twice = 2 * qc__plane_distance(plane, p);
    for (int k = 0; k < 3; k++) out[k] = axis < 0 ? p[k] - twice * plane->normal[k] : p[k];
    if (axis >= 0) out[axis] = 2 * plane->offset * plane->normal[axis] - p[axis];
}

/* Puts a point onto the plane. */
static inline void qc__flatten(const qc_plane *plane, double p[3]) {
    const int axis = qc__plane_axis(plane);
    const double far = qc__plane_distance(plane, p);
    for (int k = 0; k < 3 && axis < 0; k++) p[k] -= far * plane->normal[k];
    if (axis >= 0) p[axis] = plane->offset * plane->normal[axis];
}

/* The mirror image of p, which moves by at most a rounding error so that it is that of its image,
 * too. */
static inline void qc__mirror_pair(const qc_plane *plane, double p[3], double out[3]) {
    qc__mirror(plane, p, out);
    if (qc__plane_axis(plane) < 0) return;
    qc__mirror(plane, out, p);
    qc__mirror(plane, p, out);
}

#endif
