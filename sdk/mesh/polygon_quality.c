/* Scaled Jacobian of a polygon: the sines of its corner angles against its normal, which is the
 * direction of its area vector (Knupp, Algebraic mesh quality metrics, 2001). */
#include "sdk/mesh/internal.h"

static void difference(const double *position, int32_t from, int32_t to, double d[3]) {
    for (int k = 0; k < 3; k++)
        d[k] = position[3 * (int64_t)to + k] - position[3 * (int64_t)from + k];
}

/* Twice the area vector. */
static void area_vector(const double *position, const int32_t *v, int32_t n, double normal[3]) {
    normal[0] = normal[1] = normal[2] = 0;
    for (int32_t i = 1; i + 1 < n; i++) {
        double a[3], b[3], c[3];
        difference(position, v[0], v[i], a);
        difference(position, v[0], v[i + 1], b);
        qc__cross3(a, b, c);
        for (int k = 0; k < 3; k++) normal[k] += c[k];
    }
}

double qc__scaled_jacobian(const double *position, const int32_t *v, int32_t n) {
    double normal[3], least = 1;
    area_vector(position, v, n, normal);
    const double area = qc__norm3(normal);
    for (int32_t i = 0; i < n; i++) {
        double next[3], previous[3], c[3];
        difference(position, v[i], v[(i + 1) % n], next);
        difference(position, v[i], v[(i + n - 1) % n], previous);
        qc__cross3(next, previous, c);
        const double scale = qc__norm3(next) * qc__norm3(previous) * area;
        least = fmin(least, scale > 0 ? qc__dot3(c, normal) / scale : -1);
    }
    return least;
}
