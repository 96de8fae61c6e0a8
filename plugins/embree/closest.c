/* "qc.closest_point/1" by Embree's point queries: a sphere about the point shrinks to the closest
 * triangle found so far. */
#include "tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct qc_closest_tree {
    qe_scene scene;
};

typedef struct search {
    const qe_scene *scene;
    const double *point;
    double reach; /* slack of the sphere, inside Embree */
    double best, *weight;
    int32_t triangle;
} search;

static float radius(const search *s) {
    return (float)(sqrt(s->best) * s->scene->scale * (1 + 2 * QE_SLACK) + s->reach);
}

/* Of equally close triangles the lowest one, whatever their order. */
static bool compare(struct RTCPointQueryFunctionArguments *args) {
    search *s = args->userPtr;
    double weight[3];
    const int32_t triangle = (int32_t)args->primID;
    const double d =
        qc_triangle_distance2(s->scene->corner + 9 * (size_t)triangle, s->point, weight);
    if (d > s->best || (!(d < s->best) && triangle >= s->triangle)) return false;
    s->best = d;
    s->triangle = triangle;
    memcpy(s->weight, weight, sizeof weight);
    args->query->radius = fminf(args->query->radius, radius(s));
    return true;
}

static double query(const qc_closest_tree *tree, const double point[3], int32_t *triangle,
                    double weight[3]) {
    const qe_scene *scene = &tree->scene;
    float x[3];
    double far = 1;
    for (int k = 0; k < 3; k++) {
        const double y = (point[k] - scene->centre[k]) * scene->scale;
        x[k] = (float)y;
        far = fmax(far, fabs(y));
    }
    search s = {scene, point, 2 * QE_SLACK * far, 0, weight, *triangle};
    s.best = qc_triangle_distance2(scene->corner + 9 * (size_t)*triangle, point, weight);
    struct RTCPointQuery sphere = {x[0], x[1], x[2], 0, radius(&s)};
    struct RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene->scene, &sphere, &context, compare, &s);
    *triangle = s.triangle;
    return sqrt(s.best);
}

static void destroy(qc_closest_tree *tree) {
    if (tree) qe_scene_free(&tree->scene);
    free(tree);
}

static qc_status build(const qc_closest_point *self, qc_ctx *ctx, int32_t n, const double *position,
                       const int32_t *vertex, qc_closest_tree **out) {
    (void)self;
    qc_closest_tree *tree = malloc(sizeof *tree);
    if (!tree) return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "embree: out of memory");
    const qc_status status = qe_scene_create(ctx, n, position, vertex, NULL, &tree->scene);
    if (status == QC_OK)
        *out = tree;
    else
        free(tree);
    return status;
}

const qc_closest_point qe_closest_point = {
    {sizeof(qc_closest_point), 0, "embree", "Embree's point queries, decided in double precision"},
    NULL,
    build,
    query,
    destroy,
};
