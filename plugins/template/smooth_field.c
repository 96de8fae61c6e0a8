/* A complete QuadCover plugin with one stage: copy this folder, rename it, change `relax`.
 *
 * The stage relaxes a cross field: every cross moves towards the mean of its neighbours, carried
 * over the shared edges. Crosses are compared by their fourth powers, which do not see quarter
 * turns. */
#include <complex.h>
#include <stdlib.h>
#include <qc/dec.h>
#include <qc/field.h>
#include <qc/plugin.h>

typedef double complex cplx; /* same layout as qc_complex */

typedef struct options { /* filled and range-checked by the host */
    int64_t rounds;
    double strength;
    bool keep_trusted;
} options;
static const qc_param params[] = {
    QC_PARAM_INT(options, rounds, 20, 0, 10000, "", "how often all crosses are moved"),
    QC_PARAM_REAL(options, strength, 0.5, 0, 1, "", "0 leaves the field alone, 1 takes the mean"),
    QC_PARAM_BOOL(options, keep_trusted, true, "trusted directions stay as they are"),
};
static const qc_port in[] = {{"field", QC_TYPE_FACE_FIELD, 0, "any cross field"}};
static const qc_port out[] = {{"field", QC_TYPE_FACE_FIELD, 0, "the smoother field"}};

static cplx fourth(cplx z) {
    return z * z * z * z;
}

/* y = x^4; one round of y_t <- (1 - k) y_t + k mean_s (rho^4 y_s), normalised. */
static void relax(const qc_face_field *f, const cplx *rho, const options *o, cplx *y, cplx *mean) {
    const qc_mesh *mesh = f->mesh;
    for (int32_t t = 0; t < mesh->n_faces; t++) mean[t] = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (mesh->edge_halfedge[2 * e + 1] < 0) continue; /* boundary */
        const int32_t s = mesh->edge_halfedge[2 * e] / 3, t = mesh->edge_halfedge[2 * e + 1] / 3;
        mean[t] += fourth(rho[e]) * y[s] / 3;
        mean[s] += fourth(conj(rho[e])) * y[t] / 3;
    }
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        if (o->keep_trusted && f->trusted && f->trusted[t]) continue;
        const cplx z = (1 - o->strength) * y[t] + o->strength * mean[t];
        if (cabs(z) > 1e-12) y[t] = z / cabs(z);
    }
}

static qc_status run(const qc_run *r, const void *p) {
    const options *o = p;
    const qc_face_field *f = r->input(r, "field");
    const size_t n_faces = (size_t)f->mesh->n_faces, n_edges = (size_t)f->mesh->n_edges;
    cplx *x = malloc(2 * n_faces * sizeof *x), *rho = malloc((n_edges + 3 * n_faces) * sizeof *rho);
    qc_complex *edge = (qc_complex *)(rho ? rho + n_edges : NULL);
    qc_status status = x && rho ? QC_OK : r->fail(r, QC_ERR_NOMEM, -1, "out of memory");
    if (status == QC_OK) status = qc_tangent_edges(r->ctx, f->mesh, edge);
    if (status == QC_OK) status = qc_tangent_transport(r->ctx, f->mesh, edge, (qc_complex *)rho);
    for (size_t t = 0; status == QC_OK && t < n_faces; t++) x[t] = fourth(((const cplx *)f->x)[t]);
    for (int64_t i = 0; status == QC_OK && i < o->rounds; i++) {
        relax(f, rho, o, x, x + n_faces);
        if (!r->progress(r, (double)(i + 1) / (double)o->rounds)) status = QC_ERR_CANCELLED;
    }
    for (size_t t = 0; status == QC_OK && t < n_faces; t++) x[t] = cexp(I * carg(x[t]) / 4);
    qc_face_field *smooth = NULL;
    if (status == QC_OK)
        status =
            qc_face_field_create(r->ctx, f->mesh, (qc_complex *)x, f->weight, f->trusted, &smooth);
    free(x);
    free(rho);
    return status == QC_OK ? r->output(r, "field", smooth) : status;
}

static const qc_stage stage = {
    QC_STAGE_SIZES,
    .id = "org.example.smooth_field",
    .version = "1.0",
    .brief = "Relaxes a cross field towards its neighbours",
    .doc = "Averages fourth powers of crosses carried over the edges.",
    .in = in,
    .out = out,
    .n_in = 1,
    .n_out = 1,
    .params = params,
    .n_params = sizeof params / sizeof *params,
    .params_size = sizeof(options),
    .run = run,
};
static const qc_stage *const list[] = {&stage, NULL};
static const qc_stage *const *stages(void) {
    return list;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {
    sizeof(qc_plugin), QC_ABI_MAJOR,     QC_ABI_MINOR,     .id = "org.example.smooth_field",
    .version = "1.0",  .license = "MIT", .stages = stages,
};
