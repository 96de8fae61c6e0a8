/* Forms which are constant on faces: cross fields as forms, the L2 product, rotation by J.
 *
 * With J e_k = c_{k+1} e_{k+1} - c_{k+2} e_{k+2} everything is intrinsic:
 *     (J X).e_k = -X.(J e_k) = c_{k+2} z_{k+2} - c_{k+1} z_{k+1}. */
#include "sdk/dec/internal.h"

double *qc__cotangents(qc_ctx *ctx, const qc_mesh *mesh) {
    double *cotangent = QC__NEW(ctx, double, 3 * (size_t)mesh->n_faces);
    if (!cotangent) return NULL;
    if (qc_mesh_geometry(ctx, mesh, NULL, NULL, cotangent, NULL, NULL, NULL) == QC_OK)
        return cotangent;
    qc__free(cotangent);
    return NULL;
}

qc_status qc_form_from_cross(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *edge,
                             const qc_complex *x, const double *scale, qc_complex *z) {
    (void)ctx;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const double _Complex conj_x = (scale ? scale[t] : 1) * conj(qc__load(x[t]));
        for (int k = 0; k < 3; k++) z[3 * t + k] = qc__store(conj_x * qc__load(edge[3 * t + k]));
    }
    return QC_OK;
}

qc_complex qc_form_product(const qc_mesh *mesh, const double *cotangent, const qc_complex *a,
                           const qc_complex *b) {
    double re = 0, im = 0;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        double face_re = 0, face_im = 0;
        for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
            face_re += cotangent[h] * (a[h].re * b[h].re + a[h].im * b[h].im);
            face_im += cotangent[h] * (a[h].re * b[h].im - a[h].im * b[h].re);
        }
        re += 0.5 * face_re;
        im += 0.5 * face_im;
    }
    return (qc_complex){re, im};
}

void qc__rotate(const qc_mesh *mesh, const double *cotangent, const qc_complex *z,
                qc_complex *out) {
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        qc_complex cz[3];
        for (int k = 0; k < 3; k++) cz[k] = qc__scale(cotangent[3 * t + k], z[3 * t + k]);
        for (int k = 0; k < 3; k++) out[3 * t + k] = qc__sub(cz[(k + 2) % 3], cz[(k + 1) % 3]);
    }
}

qc_status qc_form_rotate(qc_ctx *ctx, const qc_mesh *mesh, const double *cotangent,
                         const qc_complex *z, qc_complex *out) {
    (void)ctx;
    qc__rotate(mesh, cotangent, z, out);
    return QC_OK;
}
