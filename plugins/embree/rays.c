/* "qc.ray_caster/1" by Embree: a ray shortens to the nearest triangle found so far. */
#include "tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct qc_ray_scene {
    qe_scene scene;
};

/* What the callback needs goes with the context of the call. */
typedef struct search {
    struct RTCIntersectContext context; /* first: Embree hands this back */
    const double *origin, *direction;
    double unit; /* t of 1 inside Embree     */
    double skip; /* t where Embree's ray starts */
    double best, *weight;
    int32_t triangle;
} search;

/* Of equally near triangles the lowest one, whatever their order. */
static void intersect(const struct RTCIntersectFunctionNArguments *args) {
    if (!args->valid[0]) return;
    const qe_scene *scene = args->geometryUserPtr;
    search *s = (search *)(void *)args->context;
    const int32_t triangle = (int32_t)args->primID;
    double t, weight[3];
    if (!qc_triangle_ray(scene->corner + 9 * (size_t)triangle, s->origin, s->direction, &t, weight))
        return;
    if (t > s->best || (!(t < s->best) && triangle > s->triangle)) return;
    s->best = t;
    s->triangle = triangle;
    memcpy(s->weight, weight, sizeof weight);
    struct RTCRay *ray =
        &((struct RTCRayHit *)(void *)args->rayhit)->ray; /* N = 1: rtcIntersect1 */
    const float far = (float)((t - s->skip) * s->unit * (1 + 2 * QE_SLACK) + 2 * QE_SLACK);
    ray->tfar = fminf(ray->tfar, fmaxf(far, 0));
}

/* Parameter where the ray enters the box of everything, a little enlarged; INFINITY = never. */
static double enter(const qe_scene *s, const double *o, const double *d) {
    const double pad = QE_SLACK / s->scale;
    double near = 0, far = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double lo = s->lo[k] - pad, hi = s->hi[k] + pad;
        if (!(fabs(d[k]) > 0)) {
            if (o[k] < lo || o[k] > hi) return INFINITY;
            continue;
        }
        near = fmax(near, fmin((lo - o[k]) / d[k], (hi - o[k]) / d[k]));
        far = fmin(far, fmax((lo - o[k]) / d[k], (hi - o[k]) / d[k]));
    }
    return near <= far ? near : INFINITY;
}

static double query(const qc_ray_scene *rays, const double origin[3], const double direction[3],
                    int32_t *triangle, double weight[3]) {
    const qe_scene *scene = &rays->scene;
    const double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] +
                               direction[2] * direction[2]);
    search s = {.origin = origin, .direction = direction, .best = INFINITY, .weight = weight};
    *triangle = -1;
    bool finite = isfinite(length) && length > 0;
    for (int k = 0; k < 3; k++) finite = finite && isfinite(origin[k]);
    s.skip = finite ? enter(scene, origin, direction) : INFINITY;
    if (isinf(s.skip)) return INFINITY;
    s.unit = length * scene->scale;
    float o[3], d[3];
    for (int k = 0; k < 3; k++) {
        o[k] = (float)((origin[k] + s.skip * direction[k] - scene->centre[k]) * scene->scale);
        d[k] = (float)(direction[k] / length);
    }
    struct RTCRayHit ray = {.ray = {.org_x = o[0],
                                    .org_y = o[1],
                                    .org_z = o[2],
                                    .dir_x = d[0],
                                    .dir_y = d[1],
                                    .dir_z = d[2],
                                    .tfar = INFINITY,
                                    .mask = ~0u}};
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    s.triangle = INT32_MAX;
    rtcInitIntersectContext(&s.context);
    rtcIntersect1(scene->scene, &s.context, &ray);
    if (!isinf(s.best)) *triangle = s.triangle;
    return s.best;
}

static void destroy(qc_ray_scene *rays) {
    if (rays) qe_scene_free(&rays->scene);
    free(rays);
}

static qc_status build(const qc_ray_caster *self, qc_ctx *ctx, int32_t n, const double *position,
                       const int32_t *vertex, qc_ray_scene **out) {
    (void)self;
    qc_ray_scene *rays = malloc(sizeof *rays);
    if (!rays) return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "embree: out of memory");
    const qc_status status = qe_scene_create(ctx, n, position, vertex, intersect, &rays->scene);
    if (status == QC_OK)
        *out = rays;
    else
        free(rays);
    return status;
}

const qc_ray_caster qe_ray_caster = {
    {sizeof(qc_ray_caster), 0, "embree", "Embree's rays, decided in double precision"},
    NULL,
    build,
    query,
    destroy,
};
