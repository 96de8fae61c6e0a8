/* Edge weights and transport of a mesh, and the pattern of matrices with one unknown per face. */
#include "internal.h"

/* |e|^2 / A_e of an edge between two equilateral triangles is 3.5. Needles would make it unbounded
 * and the system unsolvable in double precision; above this value the two faces move as one anyway.
 */
#define OMEGA_MAX 1e5

static void fill_omega(const qc_mesh *mesh, const qc__connection *c) {
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[2 * e], g = mesh->edge_halfedge[2 * e + 1];
        if (g < 0) {
            c->omega[e] = 0;
            continue;
        }
        qc_complex v = c->edge[h];
        double A = (c->area[h / 3] + c->area[g / 3]) / 3, square = v.re * v.re + v.im * v.im;
        c->omega[e] = square < OMEGA_MAX * A ? square / A : OMEGA_MAX;
    }
}

qc_status qc__connection_create(qc_ctx *ctx, const qc_mesh *mesh, qc__connection *out) {
    int32_t F = mesh->n_faces, E = mesh->n_edges;
    qc__connection c = {QC__NEW(ctx, qc_complex, 3 * (size_t)F), QC__NEW(ctx, qc_complex, E),
                        QC__NEW(ctx, double, F), QC__NEW(ctx, double, E)};
    qc_status status = c.edge && c.rho && c.area && c.omega ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_tangent_edges(ctx, mesh, c.edge);
    if (!status) status = qc_tangent_transport(ctx, mesh, c.edge, c.rho);
    if (status) {
        qc__connection_free(&c);
        return status;
    }
    for (int32_t t = 0; t < F; t++) {
        qc_complex a = c.edge[3 * t], b = c.edge[3 * t + 1];
        c.area[t] = fabs(a.re * b.im - a.im * b.re) / 2;
    }
    fill_omega(mesh, &c);
    *out = c;
    return QC_OK;
}

void qc__connection_free(qc__connection *c) {
    qc__free(c->edge);
    qc__free(c->rho);
    qc__free(c->area);
    qc__free(c->omega);
    *c = (qc__connection){NULL, NULL, NULL, NULL};
}

/* Lower-numbered neighbours of face t, sorted, without repetition. */
static int lower_neighbours(const qc_mesh *mesh, int32_t t, int32_t row[3]) {
    int n = 0;
    for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
        int32_t s = mesh->twin[h] < 0 ? t : mesh->twin[h] / 3;
        int i = n;
        bool known = s >= t;
        for (int j = 0; j < n; j++) known |= row[j] == s;
        if (known) continue;
        for (; i > 0 && row[i - 1] > s; i--) row[i] = row[i - 1];
        row[i] = s;
        n++;
    }
    return n;
}

qc_status qc__face_pattern_create(qc_ctx *ctx, const qc_mesh *mesh, qc__face_pattern *out) {
    int32_t F = mesh->n_faces, E = mesh->n_edges;
    qc__face_pattern p = {QC__NEW(ctx, int64_t, (size_t)F + 1),
                          QC__NEW(ctx, int32_t, (size_t)F + (size_t)E), QC__NEW(ctx, int64_t, E)};
    if (!p.colptr || !p.row || !p.entry) {
        qc__face_pattern_free(&p);
        return QC_ERR_NOMEM;
    }
    int64_t k = 0;
    for (int32_t t = 0; t < F; t++) {
        int32_t row[3];
        int n = lower_neighbours(mesh, t, row);
        p.colptr[t] = k;
        for (int i = 0; i < n; i++) p.row[k++] = row[i];
        p.row[k++] = t;
    }
    p.colptr[F] = k;
    for (int32_t e = 0; e < E; e++) {
        int32_t g = mesh->edge_halfedge[2 * e + 1];
        p.entry[e] = -1;
        if (g < 0) continue;
        int32_t s = mesh->edge_halfedge[2 * e] / 3;
        for (int64_t j = p.colptr[g / 3]; j < p.colptr[g / 3 + 1] - 1; j++)
            if (p.row[j] == s) p.entry[e] = j;
    }
    *out = p;
    return QC_OK;
}

void qc__face_pattern_free(qc__face_pattern *p) {
    qc__free(p->colptr);
    qc__free(p->row);
    qc__free(p->entry);
    *p = (qc__face_pattern){NULL, NULL, NULL};
}
