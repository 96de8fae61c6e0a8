/* qc_mesh_find_symmetry: the plane of mirror symmetry of a surface. A plane of symmetry holds the
 * centre of mass and is across a principal axis of inertia, so these three are tried, moved so that
 * mirrored points match the surface (closest points, one plane fitted to all pairs), and those
 * across the coordinate axes before them. Which of them is one is decided by the distances of
 * mirrored points to the surface. */
#include <qc/closest_point.h>
#include <string.h>

#include "sdk/mesh/plane.h"

enum { SAMPLES_MAX = 20000, FITS = 3, SWEEPS = 30 };

/* A later plane has to be so much better. */
static const double better = 0.5;
/* In diagonals: as good as exact. */
static const double exact = 1e-7;

typedef struct search {
    const qc_mesh *mesh;
    const qc_closest_point *closest;
    qc_closest_tree *tree;
    double *sample; /* 3 n: vertices and centres of faces */
    int32_t n;
    double limit; /* in units of the mesh */
    double centre[3], box[3];
    double inertia[9]; /* second moments of the area, about the centre */
    double best;
    qc_plane plane;
} search;

/* --- moments ---------------------------------------------------------------------------------- */

/* Second moments of a triangle: A / 12 (sum v v^T + 9 c c^T) with the centre c of its corners. */
static void add_moments(double area, double v[4][3], double out[9]) {
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                out[3 * i + j] += area / 12 * (k == 3 ? 9 : 1) * v[k][i] * v[k][j];
}

static void corners(const search *s, int32_t t, const double origin[3], double v[4][3]) {
    memset(v[3], 0, sizeof v[3]);
    for (int k = 0; k < 3; k++) {
        const int32_t a = s->mesh->face_vertex[3 * (int64_t)t + k];
        for (int i = 0; i < 3; i++) {
            v[k][i] = s->mesh->position[3 * (int64_t)a + i] - origin[i];
            v[3][i] += v[k][i] / 3;
        }
    }
}

static qc_status find_moments(qc_ctx *ctx, search *s) {
    const qc_mesh *m = s->mesh;
    const double zero[3] = {0, 0, 0};
    double *area = QC__NEW(ctx, double, m->n_faces), v[4][3];
    qc_status status = area ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc_mesh_geometry(ctx, m, NULL, area, NULL, NULL, NULL, NULL);
    for (int32_t t = 0; status == QC_OK && t < m->n_faces; t++) {
        corners(s, t, zero, v);
        for (int i = 0; i < 3; i++) s->centre[i] += area[t] / m->area * v[3][i];
    }
    for (int32_t t = 0; status == QC_OK && t < m->n_faces; t++) {
        corners(s, t, s->centre, v);
        add_moments(area[t], v, s->inertia);
    }
    qc__free(area);
    return status;
}

/* Eigenvectors of a symmetric matrix, the columns of e, by Jacobi's rotations. */
static void eigenvectors(double a[9], double e[9]) {
    for (int i = 0; i < 9; i++) e[i] = i % 4 == 0;
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++) {
                if (a[3 * p + q] == 0) continue;
                const double theta = (a[4 * q] - a[4 * p]) / (2 * a[3 * p + q]);
                const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + hypot(theta, 1));
                const double c = 1 / hypot(t, 1), r = t * c;
                for (int k = 0; k < 3; k++) {
                    const double x = a[3 * k + p], y = a[3 * k + q];
                    a[3 * k + p] = c * x - r * y;
                    a[3 * k + q] = r * x + c * y;
                }
                for (int k = 0; k < 3; k++) {
                    const double x = a[3 * p + k], y = a[3 * q + k];
                    a[3 * p + k] = c * x - r * y;
                    a[3 * q + k] = r * x + c * y;
                    const double u = e[3 * k + p], w = e[3 * k + q];
                    e[3 * k + p] = c * u - r * w;
                    e[3 * k + q] = r * u + c * w;
                }
            }
}

/* --- planes ----------------------------------------------------------------------------------- */

static qc_status take_samples(qc_ctx *ctx, search *s) {
    const qc_mesh *m = s->mesh;
    const double origin[3] = {0, 0, 0};
    const int32_t by_vertex = 1 + m->n_vertices / (SAMPLES_MAX / 2);
    const int32_t by_face = 1 + m->n_faces / (SAMPLES_MAX / 2);
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY},
           v[4][3];
    s->sample = QC__NEW(ctx, double, 3 * (int64_t)(SAMPLES_MAX + 2));
    if (!s->sample) return QC_ERR_NOMEM;
    for (int32_t i = 0; i < m->n_vertices; i += by_vertex)
        memcpy(s->sample + 3 * (int64_t)s->n++, m->position + 3 * (int64_t)i, sizeof v[0]);
    for (int32_t t = 0; t < m->n_faces; t += by_face) {
        corners(s, t, origin, v);
        memcpy(s->sample + 3 * (int64_t)s->n++, v[3], sizeof v[3]);
    }
    for (int64_t i = 0; i < 3 * (int64_t)m->n_vertices; i++) {
        lo[i % 3] = fmin(lo[i % 3], m->position[i]);
        hi[i % 3] = fmax(hi[i % 3], m->position[i]);
    }
    for (int k = 0; k < 3; k++) s->box[k] = 0.5 * (lo[k] + hi[k]);
    return QC_OK;
}

/* Tries a plane; *far (may be NULL) is the largest distance of a mirrored sample to the surface, or
 * one which already is too large. */
static qc_status try_plane(qc_ctx *ctx, search *s, const qc_plane *plane) {
    double far = 0, weight[3], q[3];
    const double enough = fmin(s->limit, s->best < INFINITY ? better * s->best : INFINITY);
    int32_t face = 0;
    if (s->best <= exact * s->mesh->diagonal) return QC_OK;
    for (int32_t i = 0; i < s->n && far <= enough; i++) {
        if (i % 1024 == 0 && !qc__progress(ctx, 0.5)) return QC_ERR_CANCELLED;
        qc__mirror(plane, s->sample + 3 * (int64_t)i, q);
        far = fmax(far, s->closest->query(s->tree, q, &face, weight));
    }
    if (far > enough) return QC_OK;
    s->best = far;
    s->plane = *plane;
    return QC_OK;
}

/* Fits a plane between the samples and what lies next to their mirror images. */
static void fit(const search *s, qc_plane *plane) {
    double spread[9] = {0}, e[9], middle[3] = {0}, weight[3], q[3];
    const int32_t step = 1 + s->n / 2000;
    int32_t face = 0, n = 0;
    for (int32_t i = 0; i < s->n; i += step, n++) {
        const double *p = s->sample + 3 * (int64_t)i;
        qc__mirror(plane, p, q);
        s->closest->query(s->tree, q, &face, weight);
        qc__face_point(s->mesh, face, weight, q);
        for (int k = 0; k < 3; k++) {
            middle[k] += 0.5 * (p[k] + q[k]);
            for (int j = 0; j < 3; j++) spread[3 * k + j] += (p[k] - q[k]) * (p[j] - q[j]);
        }
    }
    eigenvectors(spread, e);
    int most = 0;
    for (int k = 1; k < 3; k++)
        if (spread[4 * k] > spread[4 * most]) most = k;
    for (int k = 0; k < 3; k++) plane->normal[k] = e[3 * k + most];
    const double size = qc__norm3(plane->normal);
    for (int k = 0; k < 3; k++) plane->normal[k] /= size;
    plane->offset = qc__dot3(plane->normal, middle) / n;
}

static qc_status try_axis(qc_ctx *ctx, search *s, int axis) {
    const double offset[3] = {0, s->box[axis], s->centre[axis]};
    qc_status status = QC_OK;
    for (int i = 0; i < 3 && status == QC_OK; i++) {
        qc_plane plane = {{0, 0, 0}, offset[i]};
        plane.normal[axis] = 1;
        status = try_plane(ctx, s, &plane);
    }
    return status;
}

static qc_status try_inertia(qc_ctx *ctx, search *s) {
    double e[9];
    qc_status status = QC_OK;
    eigenvectors(s->inertia, e);
    for (int k = 0; k < 3 && status == QC_OK; k++) {
        qc_plane plane = {{e[k], e[3 + k], e[6 + k]}, 0};
        const double size = qc__norm3(plane.normal);
        for (int i = 0; i < 3; i++) plane.normal[i] /= size;
        plane.offset = qc__dot3(plane.normal, s->centre);
        for (int i = 0; i < FITS && s->best > exact * s->mesh->diagonal; i++) fit(s, &plane);
        /* the same side is kept whatever the sign of the eigenvector */
        int largest = 0;
        for (int i = 1; i < 3; i++)
            if (fabs(plane.normal[i]) > 1.001 * fabs(plane.normal[largest])) largest = i;
        const double sign = plane.normal[largest] < 0 ? -1 : 1;
        for (int i = 0; i < 3; i++) plane.normal[i] *= sign;
        plane.offset *= sign;
        status = try_plane(ctx, s, &plane);
    }
    return status;
}

qc_status qc_mesh_find_symmetry(qc_ctx *ctx, const qc_mesh *mesh, int32_t axis, double tolerance,
                                const qc_closest_point *closest, qc_plane *plane,
                                double *deviation) {
    if (axis < -1 || axis > 2 || !(tolerance >= 0))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "no axis or tolerance");
    search s = {.mesh = mesh,
                .closest = closest ? closest : &qc_closest_point_builtin,
                .limit = tolerance * mesh->diagonal,
                .best = INFINITY};
    qc_status status =
        s.closest->build(s.closest, ctx, mesh->n_faces, mesh->position, mesh->face_vertex, &s.tree);
    if (status == QC_OK) status = take_samples(ctx, &s);
    if (status == QC_OK) status = find_moments(ctx, &s);
    for (int k = 0; k < 3 && status == QC_OK; k++)
        if (axis < 0 || axis == k) status = try_axis(ctx, &s, k);
    if (status == QC_OK && axis < 0) status = try_inertia(ctx, &s);
    if (s.tree) s.closest->destroy(s.tree);
    qc__free(s.sample);
    if (status != QC_OK) return status;
    if (s.best < INFINITY) *plane = s.plane;
    *deviation = s.best / mesh->diagonal;
    return QC_OK;
}
