/* Closest points on a triangle list: a binary tree of bounding boxes over the centroids, split at
 * the median of the longest axis; queries go to the nearer child first. The point-triangle distance
 * follows the Voronoi regions of a triangle (Ericson, Real-Time Collision Detection, 5.1.5). */
#include <float.h>
#include <math.h>
#include <qc/closest_point.h>
#include <string.h>

#include "sdk/base/internal.h"

enum { LEAF = 4, DEPTH = 64 };

typedef struct node {
    double lo[3], hi[3];
    int32_t first, count; /* leaf: triangles first .. first + count - 1; inner: count = 0, children
                             first and first + 1 */
} node;

struct qc_closest_tree {
    int32_t n_nodes;
    node *node;
    double *corner; /* 9 per triangle, in leaf order           */
    int32_t *order; /* number of the triangle at each place    */
    int32_t *place; /* inverse of order                        */
};

typedef struct builder {
    const double *centroid; /* 3 n */
    int32_t *order;
    qc_closest_tree *tree;
} builder;

/* Moves the `middle - begin` smallest along `axis` to the front of order[begin, end). */
static void select_median(const builder *b, int32_t begin, int32_t end, int32_t middle, int axis) {
    int32_t *order = b->order;
    while (end - begin > 1) {
        const double pivot = b->centroid[3 * (int64_t)order[begin + (end - begin) / 2] + axis];
        int32_t i = begin, j = end - 1;
        while (i <= j) {
            while (b->centroid[3 * (int64_t)order[i] + axis] < pivot) i++;
            while (b->centroid[3 * (int64_t)order[j] + axis] > pivot) j--;
            if (i > j) break;
            const int32_t swap = order[i];
            order[i++] = order[j];
            order[j--] = swap;
        }
        if (middle <= j)
            end = j + 1;
        else if (middle >= i)
            begin = i;
        else
            return;
    }
}

static int longest_axis(const builder *b, int32_t begin, int32_t end) {
    double lo[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, hi[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (int32_t i = begin; i < end; i++)
        for (int k = 0; k < 3; k++) {
            const double x = b->centroid[3 * (int64_t)b->order[i] + k];
            lo[k] = fmin(lo[k], x);
            hi[k] = fmax(hi[k], x);
        }
    int axis = hi[1] - lo[1] > hi[0] - lo[0] ? 1 : 0;
    if (hi[2] - lo[2] > hi[axis] - lo[axis]) axis = 2;
    return axis;
}

static void split(builder *b, int32_t at, int32_t begin, int32_t end) {
    node *self = &b->tree->node[at];
    if (end - begin <= LEAF) {
        self->first = begin;
        self->count = end - begin;
        return;
    }
    const int32_t middle = begin + (end - begin) / 2;
    select_median(b, begin, end, middle, longest_axis(b, begin, end));
    self->first = b->tree->n_nodes;
    self->count = 0;
    b->tree->n_nodes += 2;
    const int32_t child = self->first;
    split(b, child, begin, middle);
    split(b, child + 1, middle, end);
}

static void copy_corners(const builder *b, int32_t n, const double *position,
                         const int32_t *vertex) {
    for (int32_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            memcpy(b->tree->corner + 9 * (int64_t)i + 3 * k,
                   position + 3 * (int64_t)vertex[3 * (int64_t)b->order[i] + k],
                   3 * sizeof(double));
}

/* Children have higher numbers than their parent, so one backward sweep fits all boxes. */
static void fit_boxes(qc_closest_tree *tree) {
    for (int32_t at = tree->n_nodes - 1; at >= 0; at--) {
        node *self = &tree->node[at];
        for (int k = 0; k < 3; k++) {
            double lo = DBL_MAX, hi = -DBL_MAX;
            if (self->count == 0) {
                const node *child = &tree->node[self->first];
                lo = fmin(child[0].lo[k], child[1].lo[k]);
                hi = fmax(child[0].hi[k], child[1].hi[k]);
            }
            for (int32_t c = 3 * self->first; c < 3 * (self->first + self->count); c++) {
                lo = fmin(lo, tree->corner[3 * (int64_t)c + k]);
                hi = fmax(hi, tree->corner[3 * (int64_t)c + k]);
            }
            self->lo[k] = lo;
            self->hi[k] = hi;
        }
    }
}

static void destroy(qc_closest_tree *tree) {
    if (!tree) return;
    qc__free(tree->node);
    qc__free(tree->corner);
    qc__free(tree->order);
    qc__free(tree->place);
    qc__free(tree);
}

static qc_closest_tree *allocate(qc_ctx *ctx, int64_t n) {
    qc_closest_tree *tree = QC__ZERO(ctx, qc_closest_tree, 1);
    if (!tree) return NULL;
    tree->node = QC__NEW(ctx, node, 2 * n);
    tree->corner = QC__NEW(ctx, double, 9 * n);
    tree->order = QC__NEW(ctx, int32_t, n);
    tree->place = QC__NEW(ctx, int32_t, n);
    if (tree->node && tree->corner && tree->order && tree->place) return tree;
    destroy(tree);
    return NULL;
}

static qc_status build(const qc_closest_point *self, qc_ctx *ctx, int32_t n, const double *position,
                       const int32_t *vertex, qc_closest_tree **out) {
    (void)self;
    qc_closest_tree *tree = allocate(ctx, n);
    double *centroid = QC__NEW(ctx, double, 3 * (int64_t)n);
    if (!tree || !centroid) {
        destroy(tree);
        qc__free(centroid);
        return QC_ERR_NOMEM;
    }
    for (int32_t i = 0; i < n; i++) {
        const int32_t *v = vertex + 3 * (int64_t)i;
        tree->order[i] = i;
        for (int k = 0; k < 3; k++)
            centroid[3 * (int64_t)i + k] =
                (position[3 * (int64_t)v[0] + k] + position[3 * (int64_t)v[1] + k] +
                 position[3 * (int64_t)v[2] + k]) /
                3;
    }
    builder b = {centroid, tree->order, tree};
    tree->n_nodes = 1;
    split(&b, 0, 0, n);
    for (int32_t i = 0; i < n; i++) tree->place[tree->order[i]] = i;
    copy_corners(&b, n, position, vertex);
    fit_boxes(tree);
    qc__free(centroid);
    *out = tree;
    return QC_OK;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
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
    return dot(d, d);
}

static double triangle_distance2(const double *x, const double p[3], double weight[3]) {
    double b[3], c[3], ap[3], bp[3], cp[3];
    for (int k = 0; k < 3; k++) {
        b[k] = x[3 + k] - x[k];
        c[k] = x[6 + k] - x[k];
        ap[k] = p[k] - x[k];
        bp[k] = p[k] - x[3 + k];
        cp[k] = p[k] - x[6 + k];
    }
    const double d1 = dot(b, ap), d2 = dot(c, ap);
    if (d1 <= 0 && d2 <= 0) return at_corner(ap, 0, weight);
    const double d3 = dot(b, bp), d4 = dot(c, bp);
    if (d3 >= 0 && d4 <= d3) return at_corner(bp, 1, weight);
    const double d5 = dot(b, cp), d6 = dot(c, cp);
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
    const double a2 = dot(ap, ap), b2 = dot(bp, bp), c2 = dot(cp, cp);
    if (a2 <= b2 && a2 <= c2) return at_corner(ap, 0, weight);
    return b2 <= c2 ? at_corner(bp, 1, weight) : at_corner(cp, 2, weight);
}

static double box_distance2(const node *box, const double p[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double d = fmax(fmax(box->lo[k] - p[k], p[k] - box->hi[k]), 0.0);
        sum += d * d;
    }
    return sum;
}

/* A triangle at place i which is closer than *best becomes the best one. */
static void compare(const qc_closest_tree *tree, int32_t i, const double p[3], double *best,
                    int32_t *nearest, double weight[3]) {
    double w[3];
    const double d = triangle_distance2(tree->corner + 9 * (int64_t)i, p, w);
    if (d >= *best) return;
    *best = d;
    *nearest = i;
    memcpy(weight, w, sizeof w);
}

static double query(const qc_closest_tree *tree, const double p[3], int32_t *triangle,
                    double weight[3]) {
    struct {
        int32_t at;
        double distance2;
    } stack[DEPTH];
    int top = 0;
    int32_t nearest = tree->place[*triangle];
    double best = triangle_distance2(tree->corner + 9 * (int64_t)nearest, p, weight);
    stack[top].at = 0;
    stack[top++].distance2 = box_distance2(tree->node, p);
    while (top > 0) {
        const int32_t at = stack[--top].at;
        if (stack[top].distance2 >= best) continue;
        const node *self = &tree->node[at];
        for (int32_t i = self->first; i < self->first + self->count; i++)
            compare(tree, i, p, &best, &nearest, weight);
        if (self->count > 0) continue;
        const double d0 = box_distance2(&tree->node[self->first], p);
        const double d1 = box_distance2(&tree->node[self->first + 1], p);
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
