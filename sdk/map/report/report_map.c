/* Figures of a parameterization: orientation of its triangles, mismatch across seams, and the
 * as-rigid-as-possible distortion (thesis 6.1): per triangle the squared distance of the Jacobian,
 * in units of the target edge length, from the nearest rotation. */
#include "sdk/map/report/report.h"
#include <math.h>

/* a d - b c with the right sign (Kahan: the error of the second product is added back by fma; the
 * first test decides nearly always). */
static double determinant(double a, double b, double c, double d) {
    const double ad = a * d, bc = b * c, det = ad - bc;
    if (fabs(det) > 1e-14 * (fabs(ad) + fabs(bc))) return det;
    return fma(a, d, -bc) + fma(-b, c, bc);
}

/* Squared Frobenius distance of J to the rotations is s1^2 + s2^2 + 2 - 2 (s1 + s2) with s2 < 0 for
 * a reversed triangle, and s1 + s2 = |(J11 + J22) + i (J21 - J12)|. p: plane coordinates of the
 * triangle with the first corner at the origin; f: parameters relative to the first corner. */
static double rigid_distance2(const double p[3], const double f[4], double edge_length) {
    const double inverse = edge_length / (p[0] * p[2]); /* p1 = (p[0], 0), p2 = (p[1], p[2]) */
    const double j11 = f[0] * p[2] * inverse, j21 = f[1] * p[2] * inverse;
    const double j12 = (f[2] * p[0] - f[0] * p[1]) * inverse;
    const double j22 = (f[3] * p[0] - f[1] * p[1]) * inverse;
    const double norm2 = j11 * j11 + j12 * j12 + j21 * j21 + j22 * j22;
    return fmax(norm2 + 2 - 2 * hypot(j11 + j22, j21 - j12), 0.0);
}

/* Corner 1 at (p[0], 0), corner 2 at (p[1], p[2]); false for a face without area. */
static bool flatten(const qc_mesh *mesh, int32_t t, double p[3]) {
    const int32_t *v = mesh->face_vertex + 3 * (int64_t)t;
    double bb = 0, bc = 0, cc = 0;
    for (int k = 0; k < 3; k++) {
        const double x = mesh->position[3 * (int64_t)v[0] + k];
        const double b = mesh->position[3 * (int64_t)v[1] + k] - x;
        const double c = mesh->position[3 * (int64_t)v[2] + k] - x;
        bb += b * b;
        bc += b * c;
        cc += c * c;
    }
    if (!(bb > 0)) return false;
    p[0] = sqrt(bb);
    p[1] = bc / p[0];
    p[2] = sqrt(fmax(cc - p[1] * p[1], 0.0));
    return p[2] > 0;
}

static void add_face(const qc_corner_map *map, int32_t t, double edge_length, qc_report *report) {
    const double *uv = map->uv + 6 * (int64_t)t;
    const double f[4] = {uv[2] - uv[0], uv[3] - uv[1], uv[4] - uv[0], uv[5] - uv[1]};
    const double det = determinant(f[0], f[1], f[2], f[3]);
    if (det < 0) report->uv.flipped++;
    if (det == 0) report->uv.degenerate++;
    double p[3];
    if (!flatten(map->mesh, t, p)) return;
    const double area = 0.5 * p[0] * p[2];
    const double distance2 = rigid_distance2(p, f, edge_length);
    if (!isfinite(distance2)) return;
    report->uv.arap_sum += area * distance2;
    report->uv.area += area;
}

/* How far the transition across an edge is from a quarter turn and an integer shift. */
static double seam_error(const qc_corner_map *map, int32_t e) {
    const qc_mesh *mesh = map->mesh;
    const int32_t h = mesh->edge_halfedge[2 * (int64_t)e];
    const int32_t g = mesh->edge_halfedge[2 * (int64_t)e + 1];
    if (g < 0) return 0;
    const double *s0 = map->uv + 2 * (int64_t)qc_next(h), *s1 = map->uv + 2 * (int64_t)qc_prev(h);
    const double *t0 = map->uv + 2 * (int64_t)qc_prev(g), *t1 = map->uv + 2 * (int64_t)qc_next(g);
    const double su = s1[0] - s0[0], sv = s1[1] - s0[1];
    const double tu = t1[0] - t0[0], tv = t1[1] - t0[1];
    const double along = su * tu + sv * tv, across = su * tv - sv * tu; /* t / s, up to scale */
    const int32_t r = fabs(along) >= fabs(across) ? (along >= 0 ? 0 : 2) : (across >= 0 ? 1 : 3);
    const qc_complex f0 = qc_quarter_turn((qc_complex){s0[0], s0[1]}, r);
    const qc_complex f1 = qc_quarter_turn((qc_complex){s1[0], s1[1]}, r);
    const double u = round(t0[0] - f0.re), v = round(t0[1] - f0.im);
    return fmax(hypot(t0[0] - f0.re - u, t0[1] - f0.im - v),
                hypot(t1[0] - f1.re - u, t1[1] - f1.im - v));
}

/* The edge length which the map's own area asks for, when it is not recorded. */
static double fitted_edge_length(const qc_corner_map *map) {
    double area = 0;
    for (int32_t t = 0; t < map->mesh->n_faces; t++) {
        const double *uv = map->uv + 6 * (int64_t)t;
        area += 0.5 * ((uv[2] - uv[0]) * (uv[5] - uv[1]) - (uv[3] - uv[1]) * (uv[4] - uv[0]));
    }
    return area > 0 ? sqrt(map->mesh->area / area) : map->mesh->mean_edge_length;
}

qc_status qc__report_map(qc_ctx *ctx, const qc_corner_map *map, qc_report *report) {
    const double edge_length = map->edge_length > 0 ? map->edge_length : fitted_edge_length(map);
    if (report->density.edge_length == 0) report->density.edge_length = edge_length;
    report->energy.field = map->field_energy;
    report->energy.curl = map->curl_energy;
    report->energy.harmonic = map->harmonic_energy;
    report->energy.harmonic_direct = map->harmonic_energy_direct;
    report->energy.iterations = map->iterations;
    report->energy.evaluations = map->evaluations;
    for (int32_t t = 0; t < map->mesh->n_faces; t++) {
        if (t % 65536 == 0 && !qc__progress(ctx, 0.5 * t / map->mesh->n_faces))
            return QC_ERR_CANCELLED;
        add_face(map, t, edge_length, report);
    }
    for (int32_t e = 0; e < map->mesh->n_edges; e++) {
        const double error = seam_error(map, e);
        if (error > report->uv.max_seam_error) report->uv.max_seam_error = error;
    }
    return QC_OK;
}
