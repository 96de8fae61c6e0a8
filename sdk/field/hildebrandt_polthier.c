/* Shape operators of Hildebrandt and Polthier, "Anisotropic filtering of non-linear surface
 * features" (2004), thesis 1.1: S(e) = 2 |e| cos(alpha_e / 2) (e x n_e)(e x n_e)^T with the unit
 * edge direction e, the bisecting normal n_e and the interior dihedral angle alpha_e; S(p) = 1/2
 * sum_e <n_p, n_e> S(e) over the share A_p of vertex p; a face averages its three vertices and is
 * restricted to its plane. */
#include "internal.h"

#include <string.h>

/* Symmetric 3 x 3 tensors as xx, xy, xz, yy, yz, zz. */
static void add_square(double *tensor, double weight, const double b[3]) {
    tensor[0] += weight * b[0] * b[0];
    tensor[1] += weight * b[0] * b[1];
    tensor[2] += weight * b[0] * b[2];
    tensor[3] += weight * b[1] * b[1];
    tensor[4] += weight * b[1] * b[2];
    tensor[5] += weight * b[2] * b[2];
}

static double apply(const double *T, const double u[3], const double v[3]) {
    return T[0] * u[0] * v[0] + T[3] * u[1] * v[1] + T[5] * u[2] * v[2] +
           T[1] * (u[0] * v[1] + u[1] * v[0]) + T[2] * (u[0] * v[2] + u[2] * v[0]) +
           T[4] * (u[1] * v[2] + u[2] * v[1]);
}

/* Area-weighted vertex normals (unit) and vertex areas. */
static void vertex_normals(const qc_mesh *mesh, const double *normal, const double *area,
                           double *vertex_normal, double *vertex_area) {
    for (size_t c = 0; c < 3 * (size_t)mesh->n_faces; c++) {
        size_t p = (size_t)mesh->face_vertex[c], t = c / 3;
        for (size_t i = 0; i < 3; i++) vertex_normal[3 * p + i] += area[t] * normal[3 * t + i];
        vertex_area[p] += area[t] / 3;
    }
    for (size_t p = 0; p < (size_t)mesh->n_vertices; p++) {
        double *n = vertex_normal + 3 * p, r = sqrt(qc__dot3(n, n));
        for (int i = 0; i < 3 && r > 0; i++) n[i] /= r;
    }
}

/* cos(alpha/2) = sin(beta/2) with the bending angle beta = pi - alpha. */
static void add_edge(const qc_mesh *mesh, int32_t e, double beta, const double *normal,
                     const double *vertex_normal, double *tensor) {
    size_t s = (size_t)(mesh->edge_halfedge[2 * e] / 3),
           t = (size_t)(mesh->edge_halfedge[2 * e + 1] / 3);
    double axis[3], bisector[3], b[3];
    const int32_t *v = mesh->edge_vertex + 2 * e;
    qc__sub(mesh->position + 3 * (size_t)v[1], mesh->position + 3 * (size_t)v[0], axis);
    for (size_t i = 0; i < 3; i++) bisector[i] = normal[3 * s + i] + normal[3 * t + i];
    double length = sqrt(qc__dot3(axis, axis)), r = sqrt(qc__dot3(bisector, bisector));
    if (!(length > 0) || !(r > 1e-9)) return; /* folded flat: no bisector */
    for (int i = 0; i < 3; i++) bisector[i] /= r, axis[i] /= length;
    qc__cross3(axis, bisector, b);
    for (int i = 0; i < 2; i++) {
        double cosine = qc__dot3(vertex_normal + 3 * (size_t)v[i], bisector);
        add_square(tensor + 6 * (size_t)v[i], cosine * length * sin(beta / 2), b);
    }
}

static void restrict_to_faces(const qc_mesh *mesh, const double *tensor, const double *vertex_area,
                              const double *real_axis, const double *imaginary_axis,
                              double *shape) {
    for (size_t t = 0; t < (size_t)mesh->n_faces; t++) {
        const double *u = real_axis + 3 * t, *v = imaginary_axis + 3 * t;
        double *s = shape + 3 * t;
        s[0] = s[1] = s[2] = 0;
        for (int k = 0; k < 3; k++) {
            size_t p = (size_t)mesh->face_vertex[3 * t + (size_t)k];
            double w = vertex_area[p] > 0 ? 1 / (3 * vertex_area[p]) : 0;
            s[0] += w * apply(tensor + 6 * p, u, u);
            s[1] += w * apply(tensor + 6 * p, u, v);
            s[2] += w * apply(tensor + 6 * p, v, v);
        }
    }
}

qc_status qc__curvature_hildebrandt_polthier(qc_ctx *ctx, const qc_mesh *mesh, const double *normal,
                                             const double *beta, const double *area,
                                             const double *real_axis, const double *imaginary_axis,
                                             double *shape) {
    size_t V = (size_t)mesh->n_vertices;
    double *tensor = QC__ZERO(ctx, double, 6 * V), *vertex_normal = QC__ZERO(ctx, double, 3 * V);
    double *vertex_area = QC__ZERO(ctx, double, V);
    qc_status status = tensor && vertex_normal && vertex_area ? QC_OK : QC_ERR_NOMEM;
    if (!status) {
        vertex_normals(mesh, normal, area, vertex_normal, vertex_area);
        for (int32_t e = 0; e < mesh->n_edges; e++)
            if (beta[e] != 0) add_edge(mesh, e, beta[e], normal, vertex_normal, tensor);
        restrict_to_faces(mesh, tensor, vertex_area, real_axis, imaginary_axis, shape);
        if (!qc__progress(ctx, 1)) status = QC_ERR_CANCELLED;
    }
    qc__free(tensor);
    qc__free(vertex_normal);
    qc__free(vertex_area);
    return status;
}
