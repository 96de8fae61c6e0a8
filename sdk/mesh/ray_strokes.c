/* Guide strokes from camera rays: between two rays the interpolated ones are cast, bisected until
 * neighbours are close on the surface. What is still apart after the last bisection is a silhouette
 * or the rim of the surface: the stroke is broken there. */
#include <math.h>
#include <qc/ray.h>
#include <string.h>

#include "sdk/mesh/internal.h"

enum { DEPTH = 24 };

typedef struct hit {
    double ray[6], point[3];
    int32_t number; /* in the result, -1 = not yet in it, -2 = nothing is hit */
} hit;

typedef struct tracer {
    qc_ctx *ctx;
    const qc_ray_caster *casts;
    qc_ray_scene *scene;
    double step;
    double *point;
    int32_t *line;
    int64_t n_points, point_room, n_lines, line_room;
} tracer;

static void cast(const tracer *t, hit *h) {
    int32_t triangle;
    double weight[3];
    const double s = t->casts->query(t->scene, h->ray, h->ray + 3, &triangle, weight);
    h->number = triangle < 0 ? -2 : -1;
    for (int k = 0; triangle >= 0 && k < 3; k++) h->point[k] = h->ray[k] + s * h->ray[3 + k];
}

static double gap(const hit *a, const hit *b) {
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += (a->point[k] - b->point[k]) * (a->point[k] - b->point[k]);
    return sqrt(sum);
}

static bool add_point(tracer *t, hit *h) {
    if (h->number >= 0) return true;
    if (t->n_points > INT32_MAX / 8 || !qc__reserve(t->ctx, (void **)&t->point, &t->point_room,
                                                    3 * t->n_points + 3, sizeof(double)))
        return false;
    memcpy(t->point + 3 * t->n_points, h->point, sizeof h->point);
    h->number = (int32_t)t->n_points++;
    return true;
}

static qc_status add_line(tracer *t, hit *a, hit *b) {
    if (!add_point(t, a) || !add_point(t, b) ||
        !qc__reserve(t->ctx, (void **)&t->line, &t->line_room, 2 * t->n_lines + 2, sizeof(int32_t)))
        return qc__nomem(t->ctx);
    t->line[2 * t->n_lines] = a->number;
    t->line[2 * t->n_lines++ + 1] = b->number;
    return QC_OK;
}

static qc_status join(tracer *t, hit *a, hit *b, int depth) {
    const bool both = a->number > -2 && b->number > -2;
    if (both && gap(a, b) <= t->step) return add_line(t, a, b);
    if (depth == 0 || (a->number == -2 && b->number == -2)) return QC_OK;
    hit middle;
    for (int k = 0; k < 6; k++) middle.ray[k] = a->ray[k] / 2 + b->ray[k] / 2;
    cast(t, &middle);
    const qc_status status = join(t, a, &middle, depth - 1);
    return status == QC_OK ? join(t, &middle, b, depth - 1) : status;
}

/* Directions are made unit vectors, so that the middle of two rays is halfway between them. */
static qc_status start(const tracer *t, const double *ray, int32_t number, hit *out) {
    const double length = sqrt(ray[3] * ray[3] + ray[4] * ray[4] + ray[5] * ray[5]);
    bool finite = isfinite(length) && length > 0;
    for (int k = 0; k < 3; k++) {
        finite = finite && isfinite(ray[k]);
        out->ray[k] = ray[k];
        out->ray[3 + k] = finite ? ray[3 + k] / length : 0;
    }
    if (!finite)
        return qc__fail(t->ctx, QC_ERR_INPUT, number,
                        "ray %d of the strokes: origin and direction must be finite numbers, the "
                        "direction not zero",
                        (int)number);
    cast(t, out);
    return QC_OK;
}

static qc_status trace(tracer *t, int32_t first, int32_t last, const double *ray) {
    hit a, b;
    qc_status status = first < last ? start(t, ray + 6 * (size_t)first, first, &a) : QC_OK;
    for (int32_t i = first + 1; status == QC_OK && i < last; i++) {
        status = start(t, ray + 6 * (size_t)i, i, &b);
        if (status == QC_OK) status = join(t, &a, &b, DEPTH);
        a = b;
        if (i % 16 == 0 && status == QC_OK && !qc__progress(t->ctx, 0)) status = QC_ERR_CANCELLED;
    }
    return status;
}

/* --- the surface ------------------------------------------------------------------------------ */

/* Fans of triangles, and the mean length of their edges. */
static int32_t fans(const qc_polygon_mesh *s, int32_t *vertex, double *mean) {
    int32_t n = 0;
    double sum = 0;
    for (int32_t f = 0; f < s->n_faces; f++) {
        const int32_t first = s->face_offset[f];
        for (int32_t c = first + 1; c + 1 < s->face_offset[f + 1]; c++, n++) {
            const int32_t v[3] = {s->face_vertex[first], s->face_vertex[c], s->face_vertex[c + 1]};
            memcpy(vertex + 3 * (size_t)n, v, sizeof v);
            for (int i = 0; i < 3; i++) {
                const double *p = s->position + 3 * (size_t)v[i];
                const double *q = s->position + 3 * (size_t)v[(i + 1) % 3];
                sum += hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]) / 3;
            }
        }
    }
    *mean = n > 0 ? sum / n : 0;
    return n;
}

static qc_status build(tracer *t, const qc_polygon_mesh *surface) {
    int32_t *vertex = QC__NEW(t->ctx, int32_t, 3 * (int64_t)surface->n_corners);
    if (!vertex) return QC_ERR_NOMEM;
    double mean = 0;
    const int32_t n = fans(surface, vertex, &mean);
    const qc_status status =
        n > 0 ? t->casts->build(t->casts, t->ctx, n, surface->position, vertex, &t->scene)
              : qc__fail(t->ctx, QC_ERR_ARGUMENT, -1, "strokes: the surface has no faces");
    if (!(t->step > 0)) t->step = mean;
    qc__free(vertex);
    return status;
}

static qc_status publish(const tracer *t, qc_polygon_mesh **out) {
    if (t->n_lines == 0)
        return qc__fail(t->ctx, QC_ERR_INPUT, -1,
                        "strokes: no two neighbouring rays meet the surface; rays are origin and "
                        "direction in the coordinates of the mesh");
    qc_polygon_mesh *m = NULL;
    const qc_status status =
        qc_polygon_mesh_create(t->ctx, (int32_t)t->n_points, 0, 0, 0, (int32_t)t->n_lines, 0, &m);
    if (status != QC_OK) return status;
    memcpy(m->position, t->point, 3 * (size_t)t->n_points * sizeof(double));
    memcpy(m->line, t->line, 2 * (size_t)t->n_lines * sizeof(int32_t));
    *out = m;
    return QC_OK;
}

qc_status qc_ray_strokes(qc_ctx *ctx, const qc_polygon_mesh *surface, const qc_ray_caster *casts,
                         int32_t n_strokes, const int32_t *stroke_offset, const double *ray,
                         double step, qc_polygon_mesh **out) {
    tracer t = {.ctx = ctx, .casts = casts ? casts : &qc_ray_caster_builtin, .step = step};
    qc_status status = build(&t, surface);
    for (int32_t i = 0; status == QC_OK && i < n_strokes; i++) {
        status = trace(&t, stroke_offset[i], stroke_offset[i + 1], ray);
        if (status == QC_OK && !qc__progress(ctx, (i + 1.0) / n_strokes)) status = QC_ERR_CANCELLED;
    }
    if (status == QC_OK) status = publish(&t, out);
    t.casts->destroy(t.scene);
    qc__free(t.point);
    qc__free(t.line);
    return status;
}
