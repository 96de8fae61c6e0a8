/* Gradient, divergence and curl in the conforming and non-conforming versions (Kaelberer 2013,
 * Definition 1.11 and section 3.2.3), in complex notation on the mesh below the covering. */
#include "sdk/dec/internal.h"

void qc__gradient(const qc_mesh *m, const int8_t *corner_turn, const qc_complex *F, qc_complex *z) {
    for (int32_t t = 0; t < m->n_faces; t++) {
        qc_complex f[3];
        for (int k = 0; k < 3; k++)
            f[k] = qc_quarter_turn(F[m->face_vertex[3 * t + k]], corner_turn[3 * t + k]);
        for (int k = 0; k < 3; k++) z[3 * t + k] = qc__sub(f[(k + 2) % 3], f[(k + 1) % 3]);
    }
}

qc_status qc_form_gradient(qc_ctx *ctx, const qc_cover *cover, const qc_complex *F, qc_complex *z) {
    int8_t *turn = QC__NEW(ctx, int8_t, 3 * (size_t)cover->mesh->n_faces);
    if (!turn) return QC_ERR_NOMEM;
    const qc_status status = qc_cover_corner_turns(ctx, cover, turn);
    if (status == QC_OK) qc__gradient(cover->mesh, turn, F, z);
    qc__free(turn);
    return status;
}

/* Midpoint values of the three edges in the gauge of face t. */
static void local_midpoints(const qc_cover *cover, const qc_complex *v, int32_t t,
                            qc_complex w[3]) {
    for (int k = 0; k < 3; k++)
        w[k] = qc_quarter_turn(v[cover->mesh->halfedge_edge[3 * t + k]],
                               qc__edge_turn(cover, 3 * t + k));
}

/* Corner values are f_k = w_{k+1} + w_{k+2} - w_k. */
qc_status qc_form_gradient_edges(qc_ctx *ctx, const qc_cover *cover, const qc_complex *v,
                                 qc_complex *z) {
    (void)ctx;
    for (int32_t t = 0; t < cover->mesh->n_faces; t++) {
        qc_complex w[3];
        local_midpoints(cover, v, t, w);
        for (int k = 0; k < 3; k++)
            z[3 * t + k] = qc__scale(2, qc__sub(w[(k + 1) % 3], w[(k + 2) % 3]));
    }
    return QC_OK;
}

/* (J grad v).e_j = sum_k w_k <e_k, e_j> / A with <e_k, e_j> / A = -2 c_i (i, j, k different) and
 * 2 (c_i + c_k) for k = j. */
void qc__subtract_rotation(const qc_cover *cover, const double *cotangent, const qc_complex *v,
                           const qc_complex *z, qc_complex *out) {
    for (int32_t t = 0; t < cover->mesh->n_faces; t++) {
        qc_complex w[3], d[3]; /* d_k = 2 c_k (w_{k+1} - w_{k+2}) */
        local_midpoints(cover, v, t, w);
        for (int k = 0; k < 3; k++)
            d[k] = qc__scale(2 * cotangent[3 * t + k], qc__sub(w[(k + 1) % 3], w[(k + 2) % 3]));
        for (int k = 0; k < 3; k++)
            out[3 * t + k] = qc__sub(z[3 * t + k], qc__sub(d[(k + 2) % 3], d[(k + 1) % 3]));
    }
}

qc_status qc_form_weak_curl_edges(qc_ctx *ctx, const qc_cover *cover, const qc_complex *z,
                                  qc_complex *r) {
    (void)ctx;
    const qc_mesh *m = cover->mesh;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t s = m->edge_halfedge[2 * e], t = m->edge_halfedge[2 * e + 1];
        const qc_complex zero = {0, 0};
        r[e] = t < 0 ? zero : qc__add(z[s], qc_quarter_turn(z[t], qc_cover_turn(cover, s)));
    }
    return QC_OK;
}

qc_status qc_form_curl_edges(qc_ctx *ctx, const qc_cover *cover, const qc_complex *z,
                             qc_complex *curl) {
    const qc_status status = qc_form_weak_curl_edges(ctx, cover, z, curl);
    for (int32_t e = 0; status == QC_OK && e < cover->mesh->n_edges; e++)
        curl[e] = qc_quarter_turn(curl[e], 2);
    return status;
}

/* grad phi at corner k is 0, 1, -1 on the halfedges k, k+1, k+2. */
void qc__divergence(const qc_mesh *m, const double *cotangent, const int8_t *corner_turn,
                    const int8_t *branch, const qc_complex *z, qc_complex *div) {
    for (int32_t v = 0; v < m->n_vertices; v++) div[v] = (qc_complex){0, 0};
    for (int32_t c = 0; c < 3 * m->n_faces; c++) {
        const int32_t v = m->face_vertex[c], p = qc_next(c), q = qc_prev(c);
        if (branch && branch[v]) continue;
        const qc_complex flux =
            qc__sub(qc__scale(0.5 * cotangent[p], z[p]), qc__scale(0.5 * cotangent[q], z[q]));
        div[v] = qc__add(div[v], qc_quarter_turn(flux, -corner_turn[c]));
    }
}

qc_status qc_form_divergence(qc_ctx *ctx, const qc_cover *cover, const double *cotangent,
                             const qc_complex *z, qc_complex *div) {
    const qc_mesh *m = cover->mesh;
    int8_t *turn = QC__NEW(ctx, int8_t, 3 * (size_t)m->n_faces);
    int8_t *shift = QC__NEW(ctx, int8_t, m->n_vertices);
    qc_status status = turn && shift ? qc_cover_corner_turns(ctx, cover, turn) : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc_cover_shifts(ctx, cover, shift);
    if (status == QC_OK) qc__divergence(m, cotangent, turn, shift, z, div);
    qc__free(turn);
    qc__free(shift);
    return status;
}
