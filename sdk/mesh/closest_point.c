/* Closest points on a triangle list: the boxes of a tree, the nearer child first. The
 * point-triangle distance follows the Voronoi regions of a triangle (Ericson, Real-Time Collision
 * Detection, 5.1.5). */
#include <math.h>
#include <qc/closest_point.h>
#include <string.h>

#include "sdk/mesh/internal.h"
#include "sdk/mesh/box_tree.h"

struct qc_closest_tree {
    qc__box_tree boxes;
};

static void destroy(qc_closest_tree *tree) {
    if (tree) qc__box_tree_free(&tree->boxes);
    qc__free(tree);
}

static qc_status build(const qc_closest_point *self, qc_ctx *ctx, int32_t n, const double *position,
                       const int32_t *vertex, qc_closest_tree **out) {
    (void)self;
    qc_closest_tree *tree = QC__ZERO(ctx, qc_closest_tree, 1);
    const qc_status status =
        tree ? qc__box_tree_build(ctx, n, position, vertex, &tree->boxes) : QC_ERR_NOMEM;
    if (status == QC_OK)
        *out = tree;
    else
        qc__free(tree);
    return status;
}

/* |p - (s a + t b)|^2 for p, a, b relative to the same corner; weight = (1 - s - t, s, t). */
static double residual2(const double p[3], const double a[3], double s, const double b[3], double t,
                        double weight[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double d = p[k] - s * a[k] - t * b[k];
        sum += d * d;
    }
    weight[0] = fmax(1 - s - t, 0);
    weight[1] = s;
    weight[2] = t;
    return sum;
}

static double at_corner(const double d[3], int k, double weight[3]) {
    for (int i = 0; i < 3; i++) weight[i] = i == k;
    return qc__dot3(d, d);
}

double qc_triangle_distance2(const double x[9], const double p[3], double weight[3]) {
    double b[3], c[3], ap[3], bp[3], cp[3];
    for (int k = 0; k < 3; k++) {
        b[k] = x[3 + k] - x[k];
        c[k] = x[6 + k] - x[k];
        ap[k] = p[k] - x[k];
        bp[k] = p[k] - x[3 + k];
        cp[k] = p[k] - x[6 + k];
    }
    const double d1 = qc__dot3(b, ap), d2 = qc__dot3(c, ap);
    if (d1 <= 0 && d2 <= 0) return at_corner(ap, 0, weight);
    const double d3 = qc__dot3(b, bp), d4 = qc__dot3(c, bp);
    if (d3 >= 0 && d4 <= d3) return at_corner(bp, 1, weight);
    const double d5 = qc__dot3(b, cp), d6 = qc__dot3(c, cp);
    if (d6 >= 0 && d5 <= d6) return at_corner(cp, 2, weight);
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3)
        return residual2(ap, b, d1 / (d1 - d3), c, 0, weight);
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6)
        return residual2(ap, b, 0, c, d2 / (d2 - d6), weight);
    if (va <= 0 && d4 >= d3 && d5 >= d6 && (d4 - d3) + (d5 - d6) > 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return residual2(ap, b, 1 - w, c, w, weight);
    }
    const double sum = va + vb + vc;
    if (sum > 0) return residual2(ap, b, vb / sum, c, vc / sum, weight);
    const double a2 = qc__dot3(ap, ap), b2 = qc__dot3(bp, bp), c2 = qc__dot3(cp, cp);
    if (a2 <= b2 && a2 <= c2) return at_corner(ap, 0, weight);
    return b2 <= c2 ? at_corner(bp, 1, weight) : at_corner(cp, 2, weight);
}

static double box_distance2(const qc__box *box, const double p[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double d = fmax(fmax(box->lo[k] - p[k], p[k] - box->hi[k]), 0.0);
        sum += d * d;
    }
    return sum;
}

/* A triangle at place i which is closer than *best becomes the best one. */
static void compare(const qc__box_tree *tree, int32_t i, const double p[3], double *best,
                    int32_t *nearest, double weight[3]) {
    double w[3];
    const double d = qc_triangle_distance2(tree->corner + 9 * (int64_t)i, p, w);
    if (d >= *best) return;
    *best = d;
    *nearest = i;
    memcpy(weight, w, sizeof w);
}

static double query(const qc_closest_tree *closest, const double p[3], int32_t *triangle,
                    double weight[3]) {
    const qc__box_tree *tree = &closest->boxes;
    struct {
        int32_t at;
        double distance2;
    } stack[QC__BOX_DEPTH];
    int top = 0;
    int32_t nearest = tree->place[*triangle];
    double best = qc_triangle_distance2(tree->corner + 9 * (int64_t)nearest, p, weight);
    stack[top].at = 0;
    stack[top++].distance2 = box_distance2(tree->box, p);
    while (top > 0) {
        const int32_t at = stack[--top].at;
        if (stack[top].distance2 >= best) continue;
        const qc__box *self = &tree->box[at];
        for (int32_t i = self->first; i < self->first + self->count; i++)
            compare(tree, i, p, &best, &nearest, weight);
        if (self->count > 0) continue;
        const double d0 = box_distance2(&tree->box[self->first], p);
        const double d1 = box_distance2(&tree->box[self->first + 1], p);
        const int far = d0 <= d1 ? 1 : 0;
        stack[top].at = self->first + far;
        stack[top++].distance2 = far ? d1 : d0;
        stack[top].at = self->first + 1 - far;
        stack[top++].distance2 = far ? d0 : d1;
    }
    *triangle = tree->order[nearest];
    return sqrt(best);
}

const qc_closest_point qc_closest_point_builtin = {
    {sizeof(qc_closest_point), 0, "builtin", "tree of bounding boxes"}, NULL, build, query, destroy,
};
