/* Figures of a cage and of its limit surface. */
#include "parts.h"

#include <math.h>
#include <stdlib.h>

qc_status qo_nomem(const qc_run *run) {
    return (run->fail)(run, QC_ERR_NOMEM, -1, "opensubdiv: out of memory");
}

static void count_faces(const qc_polygon_mesh *cage, const uint8_t *flag,
                        qc_subdivision_report *report) {
    for (int32_t f = 0; f < cage->n_faces; f++) {
        int32_t several = 0;
        for (int32_t c = cage->face_offset[f]; c < cage->face_offset[f + 1]; c++)
            several += flag[cage->face_vertex[c]];
        report->n_non_quads += cage->face_offset[f + 1] - cage->face_offset[f] != 4;
        report->n_crowded += several > 1;
    }
}

qc_status qo_measure_cage(const qc_run *run, const qc_polygon_mesh *cage, const qo_surface *surface,
                          qc_subdivision_report *report) {
    const size_t n = (size_t)cage->n_vertices;
    int32_t *valence = malloc((n + 1) * sizeof *valence);
    uint8_t *flag = malloc(2 * n + 1);
    qc_status status = valence && flag ? QC_OK : qo_nomem(run);
    if (status == QC_OK) {
        uint8_t *boundary = flag + n;
        qo_surface_valences(surface, valence, boundary);
        report->n_vertices = cage->n_vertices;
        report->n_faces = cage->n_faces;
        report->n_creases = qo_surface_creases(surface);
        for (size_t v = 0; v < n; v++) {
            flag[v] = !boundary[v] && valence[v] != 4 && valence[v] > 0;
            report->n_extraordinary += flag[v];
            report->n_boundary_extraordinary += boundary[v] && valence[v] > 3;
            if (!boundary[v]) report->valence[valence[v] < 8 ? valence[v] : 8]++;
        }
        count_faces(cage, flag, report);
        status = qo_measure_spacing(run, surface, cage->n_vertices, flag, report);
    }
    free(valence);
    free(flag);
    return status;
}

/* --- the limit surface ------------------------------------------------------------------------ */

static double distance(const double *a, const double *b) {
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* Cosine of the angle between a unit vector and the normal of face t; 1 where it has none. */
static double face_cosine(const qc_mesh *mesh, int32_t t, const double *normal) {
    const double *p[3];
    double a[3], b[3];
    for (int k = 0; k < 3; k++) p[k] = mesh->position + 3 * (size_t)mesh->face_vertex[3 * t + k];
    for (int k = 0; k < 3; k++) {
        a[k] = p[1][k] - p[0][k];
        b[k] = p[2][k] - p[0][k];
    }
    const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return length > 0 ? (n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2]) / length : 1;
}

/* One sample against the target. */
static void compare(const qo_target *target, const double *x, const double *normal,
                    double *jacobian, int32_t *nearest, qc_subdivision_report *report) {
    double weight[3];
    const double d = target->closest->query(target->tree, x, nearest, weight);
    report->distance = fmax(report->distance, d);
    report->mean_distance += d;
    const double cosine = face_cosine(target->mesh, *nearest, normal);
    if (!(fabs(normal[0]) + fabs(normal[1]) + fabs(normal[2]) > 0)) return;
    report->normal_deviation = fmax(report->normal_deviation, acos(fmin(fmax(cosine, -1), 1)));
    if (cosine < 0) {
        *jacobian = -*jacobian;
        report->n_reversed++;
    }
}

static qc_status measure(const qc_run *run, const qo_target *target, int32_t n, const double *x,
                         const double *normal, double *jacobian, qc_subdivision_report *report) {
    int32_t nearest = 0;
    report->jacobian = 1;
    report->distance = report->mean_distance = report->normal_deviation = 0;
    report->n_reversed = 0;
    for (int32_t i = 0; i < n; i++) {
        if (i % 1024 == 0 && !run->progress(run, 0.6 + 0.4 * i / n)) return QC_ERR_CANCELLED;
        if (target->tree)
            compare(target, x + 3 * (size_t)i, normal + 3 * (size_t)i, jacobian + i, &nearest,
                    report);
        report->jacobian = fmin(report->jacobian, jacobian[i]);
    }
    if (n > 0) report->mean_distance /= n;
    return QC_OK;
}

qc_status qo_measure_limit(const qc_run *run, const qo_surface *surface, const qo_target *target,
                           int32_t n_vertices, const double *control, const double *place,
                           qc_subdivision_report *report) {
    const int32_t n = report->n_samples = qo_surface_samples(surface);
    double *x = malloc((7 * (size_t)n + 1) * sizeof *x), weight[3];
    if (!x) return qo_nomem(run);
    double *normal = x + 3 * (size_t)n, *jacobian = x + 6 * (size_t)n;
    qc_status status = qo_surface_limit(run->ctx, surface, control, x, normal, jacobian);
    if (status == QC_OK) status = measure(run, target, n, x, normal, jacobian, report);
    int32_t nearest = 0;
    report->vertex_distance = report->cage_distance = 0;
    for (size_t v = 0; status == QC_OK && v < (size_t)n_vertices; v++) {
        report->vertex_distance = fmax(report->vertex_distance, distance(x + 3 * v, place + 3 * v));
        if (target->tree)
            report->cage_distance =
                fmax(report->cage_distance,
                     target->closest->query(target->tree, control + 3 * v, &nearest, weight));
    }
    free(x);
    return status;
}
