/* Writes cross fields as .rawfield (Directional) or .rosy. */
#include "internal.h"

#include <string.h>

static bool ends_with(const char *path, const char *end) {
    size_t n = strlen(path), k = strlen(end);
    return n >= k && strcmp(path + n - k, end) == 0;
}

static void print_vector(FILE *file, const double v[3], char separator) {
    char text[3][32];
    for (int i = 0; i < 3; i++) qc__print_double(text[i], sizeof text[i], v[i] == 0 ? 0 : v[i]);
    fprintf(file, "%s %s %s%c", text[0], text[1], text[2], separator);
}

static void print_faces(FILE *file, const qc_face_field *field, const double *real,
                        const double *imaginary, bool rosy) {
    for (size_t t = 0; t < (size_t)field->mesh->n_faces; t++) {
        qc_complex x = field->x[t];
        for (int k = 0; k < (rosy ? 1 : 4); k++) {
            double v[3];
            for (size_t i = 0; i < 3; i++)
                v[i] = x.re * real[3 * t + i] + x.im * imaginary[3 * t + i];
            print_vector(file, v, rosy || k == 3 ? '\n' : ' ');
            x = (qc_complex){-x.im, x.re};
        }
    }
}

qc_status qc_face_field_write(qc_ctx *ctx, const qc_face_field *field, const char *path) {
    const qc_mesh *mesh = field->mesh;
    bool rosy = ends_with(path, ".rosy");
    double *real = QC__NEW(ctx, double, 3 * (size_t)mesh->n_faces);
    double *imaginary = QC__NEW(ctx, double, 3 * (size_t)mesh->n_faces);
    qc_status status = real && imaginary ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_tangent_frames(ctx, mesh, real, imaginary);
    qc__writer writer;
    if (!status) status = qc__writer_open(ctx, path, &writer);
    if (!status) {
        fprintf(writer.file, rosy ? "%d\n%d\n" : "%d %d\n", rosy ? (int)mesh->n_faces : 4,
                rosy ? 4 : (int)mesh->n_faces);
        print_faces(writer.file, field, real, imaginary, rosy);
        status = qc__writer_commit(ctx, &writer);
    }
    qc__free(real);
    qc__free(imaginary);
    return status;
}
