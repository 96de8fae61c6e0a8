/* Rays on a triangle list: the boxes of a tree, the nearer child first. The test of a triangle is
 * watertight: Woop, Benthin, Wald, Watertight Ray/Triangle Intersection (JCGT 2, 2013). */
#include <math.h>
#include <qc/ray.h>
#include <string.h>

#include "sdk/mesh/box_tree.h"

/* Twice the signed area of (0, a, b); exactly -edge(b, a). */
static double edge(const double a[2], const double b[2]) {
    return a[0] * b[1] - a[1] * b[0];
}

bool qc_triangle_ray(const double corner[9], const double origin[3], const double direction[3],
                     double *t, double weight[3]) {
    int z = fabs(direction[0]) >= fabs(direction[1]) ? 0 : 1;
    if (fabs(direction[2]) > fabs(direction[z])) z = 2;
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    const double sx = direction[x] / direction[z], sy = direction[y] / direction[z];
    double p[3][2], depth[3];
    for (int i = 0; i < 3; i++) {
        const double *c = corner + 3 * i;
        depth[i] = c[z] - origin[z];
        p[i][0] = c[x] - origin[x] - sx * depth[i];
        p[i][1] = c[y] - origin[y] - sy * depth[i];
    }
    const double u = edge(p[1], p[2]), v = edge(p[2], p[0]), w = edge(p[0], p[1]);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    const double sum = u + v + w;
    if (!(fabs(sum) > 0) || isinf(sum)) return false;
    weight[0] = u / sum;
    weight[1] = v / sum;
    weight[2] = w / sum;
    *t = (weight[0] * depth[0] + weight[1] * depth[1] + weight[2] * depth[2]) / direction[z];
    return *t >= 0;
}

struct qc_ray_scene {
    qc__box_tree boxes;
};

static void destroy(qc_ray_scene *scene) {
    if (scene) qc__box_tree_free(&scene->boxes);
    qc__free(scene);
}

static qc_status build(const qc_ray_caster *self, qc_ctx *ctx, int32_t n, const double *position,
                       const int32_t *vertex, qc_ray_scene **out) {
    (void)self;
    qc_ray_scene *scene = QC__ZERO(ctx, qc_ray_scene, 1);
    const qc_status status =
        scene ? qc__box_tree_build(ctx, n, position, vertex, &scene->boxes) : QC_ERR_NOMEM;
    if (status == QC_OK)
        *out = scene;
    else
        qc__free(scene);
    return status;
}

/* Where the ray enters a box, INFINITY when it does not. The slack covers the rounding of the slabs
 * and of the triangle test, which may see a hit a little outside of the box (Woop 3.3). */
static double enter_box(const qc__box *box, const double o[3], const double d[3]) {
    const double slack = 1e-14;
    double near = 0, far = INFINITY;
    for (int k = 0; k < 3; k++) {
        if (!(fabs(d[k]) > 0)) {
            if (o[k] < box->lo[k] || o[k] > box->hi[k]) return INFINITY;
            continue;
        }
        const double a = (box->lo[k] - o[k]) / d[k], b = (box->hi[k] - o[k]) / d[k];
        near = fmax(near, fmin(a, b) * (1 - slack));
        far = fmin(far, fmax(a, b) * (1 + slack));
    }
    return near <= far ? near : INFINITY;
}

static bool is_usable(const double o[3], const double d[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        if (!isfinite(o[k]) || !isfinite(d[k])) return false;
        sum = fmax(sum, fabs(d[k]));
    }
    return sum > 0;
}

static double query(const qc_ray_scene *scene, const double origin[3], const double direction[3],
                    int32_t *triangle, double weight[3]) {
    const qc__box_tree *tree = &scene->boxes;
    int32_t stack[QC__BOX_DEPTH];
    int top = 0;
    double best = INFINITY;
    *triangle = -1;
    if (is_usable(origin, direction)) stack[top++] = 0;
    while (top > 0) {
        const qc__box *box = &tree->box[stack[--top]];
        if (enter_box(box, origin, direction) > best) continue;
        for (int32_t i = box->first; i < box->first + box->count; i++) {
            double t, w[3];
            if (!qc_triangle_ray(tree->corner + 9 * (int64_t)i, origin, direction, &t, w)) continue;
            if (t > best || (!(t < best) && tree->order[i] > *triangle)) continue;
            best = t;
            *triangle = tree->order[i];
            memcpy(weight, w, sizeof w);
        }
        if (box->count > 0) continue;
        const double a = enter_box(&tree->box[box->first], origin, direction);
        const double b = enter_box(&tree->box[box->first + 1], origin, direction);
        const int far = a <= b ? 1 : 0;
        if (!isinf(far ? b : a)) stack[top++] = box->first + far;
        if (!isinf(far ? a : b)) stack[top++] = box->first + 1 - far;
    }
    return best;
}

const qc_ray_caster qc_ray_caster_builtin = {
    {sizeof(qc_ray_caster), 0, "builtin", "tree of bounding boxes"}, NULL, build, query, destroy,
};
