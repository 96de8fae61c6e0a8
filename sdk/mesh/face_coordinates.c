/* Where a point lies in the plane of a face. */
#include "sdk/mesh/internal.h"

bool qc__face_coordinates(const qc_mesh *m, int32_t face, const double x[3], double w[3]) {
    double e[2][3], d[3], n[3], c[3];
    const double one[3] = {1, 0, 0};
    qc__face_point(m, face, one, d);
    for (int i = 0; i < 3; i++) d[i] = x[i] - d[i];
    qc__halfedge_vector(m, 3 * face + 2, e[0]); /* from corner 0 to corner 1 */
    qc__halfedge_vector(m, 3 * face + 1, e[1]); /* from corner 2 to corner 0 */
    for (int i = 0; i < 3; i++) e[1][i] = -e[1][i];
    qc__cross3(e[0], e[1], n);
    const double square = qc__dot3(n, n);
    if (!(square > 0)) return false;
    qc__cross3(d, e[1], c);
    w[1] = qc__dot3(c, n) / square;
    qc__cross3(e[0], d, c);
    w[2] = qc__dot3(c, n) / square;
    w[0] = 1 - w[1] - w[2];
    return true;
}
