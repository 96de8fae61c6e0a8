/* Winding of the images of cones, and stiffening. */
#include "sdk/map/periods/wrong_cones.h"
#include <math.h>

static const double quarter = 1.57079632679489661923;

static double image_angle(const qc_mesh *mesh, const qc_complex *f, int32_t v) {
    const int32_t start = mesh->vertex_corner[v];
    double angle = 0;
    int32_t c = start;
    do {
        const qc_complex p = f[c], a = f[qc_next(c)], b = f[qc_prev(c)];
        const double ax = a.re - p.re, ay = a.im - p.im, bx = b.re - p.re, by = b.im - p.im;
        angle += atan2(ax * by - ay * bx, ax * bx + ay * by);
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
    return angle;
}

bool qc__is_folded(const qc_complex *p) {
    return (p[1].re - p[0].re) * (p[2].im - p[0].im) - (p[2].re - p[0].re) * (p[1].im - p[0].im) <=
           0;
}

bool qc__winds_wrong(const qc_mesh *mesh, int32_t index4, const qc_complex *f, int32_t v) {
    return lround(image_angle(mesh, f, v) / quarter) != 4 - index4;
}

int32_t qc__wrong_cones(const qc_mesh *mesh, const int32_t *index4, const qc_complex *f) {
    int32_t wrong = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (index4[v] != 0) wrong += qc__winds_wrong(mesh, index4[v], f, v);
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) {
        const int32_t v = mesh->face_vertex[c];
        if (index4[v] == 0 && qc__is_folded(f + c / 3 * 3))
            wrong += lround(image_angle(mesh, f, v) / quarter) > 4;
    }
    return wrong;
}

void qc__stiffen(const qc_mesh *mesh, const qc_complex *f, double *weight) {
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (qc__is_folded(f + 3 * (int64_t)t)) weight[t] *= 4;
    for (int32_t h = 0; h < 3 * mesh->n_faces; h++) {
        const int32_t g = mesh->twin[h];
        if (g >= 0 && weight[h / 3] < 0.5 * weight[g / 3]) weight[h / 3] = 0.5 * weight[g / 3];
    }
}
