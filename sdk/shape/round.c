/* Sphere and ellipsoid: an icosahedron, its faces subdivided and projected. */
#include "sdk/shape/internal.h"

typedef struct face {
    const double *corner[3];
    const double *axes;
} face;

static void project(const void *data, double u, double v, double out[3]) {
    const face *f = data;
    for (int i = 0; i < 3; i++)
        out[i] = (1 - u - v) * f->corner[0][i] + u * f->corner[1][i] + v * f->corner[2][i];
    qc__normalize(out);
    for (int i = 0; i < 3; i++) out[i] *= f->axes[i];
}

static void icosphere(qc__soup *soup, const qc_shape_options *options, const double axes[3]) {
    static const int index[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    const double g = 0.5 * (1 + sqrt(5));
    const double corner[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                  {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                  {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    int32_t n = qc__segments(options->resolution, 10, 1);
    for (int i = 0; i < 20; i++) {
        face f = {{corner[index[i][0]], corner[index[i][1]], corner[index[i][2]]}, axes};
        qc__soup_triangle(soup, n, project, &f);
    }
}

void qc__shape_sphere(qc__soup *soup, const qc_shape_options *options) {
    icosphere(soup, options, (double[3]){1, 1, 1});
}

void qc__shape_ellipsoid(qc__soup *soup, const qc_shape_options *options) {
    icosphere(soup, options, (double[3]){1.5, 1, 0.7});
}
