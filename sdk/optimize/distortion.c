/* E_D as a function of the matching (thesis 6.2.1): what is computed once, and the state. */
#include "sdk/optimize/internal.h"

#include <string.h>

/* Residual of L* v = r at which the updated factor is made anew. */
static const double DRIFT = 1e-11;

static bool allocate(qc_ctx *ctx, qc_distortion *d) {
    const size_t F = (size_t)d->mesh->n_faces, E = (size_t)d->mesh->n_edges;
    d->cotangent = QC__NEW(ctx, double, 3 * F);
    d->m = QC__NEW(ctx, int8_t, E);
    d->index4 = QC__NEW(ctx, int32_t, d->mesh->n_vertices);
    d->bend = QC__ZERO(ctx, double, F);
    d->alpha = QC__ZERO(ctx, double, F);
    d->x = QC__NEW(ctx, qc_complex, F);
    d->angle = QC__NEW(ctx, double, F *QC__TRIALS);
    d->turned = QC__NEW(ctx, qc_complex, F * QC__TRIALS);
    d->frozen = QC__ZERO(ctx, uint8_t, d->mesh->n_components);
    d->hard = QC__ZERO(ctx, uint8_t, d->mesh->n_vertices);
    return d->hard && d->frozen && d->cotangent && d->m && d->index4 && d->bend && d->alpha &&
           d->x && d->angle && d->turned;
}

static bool allocate_unknowns(qc_ctx *ctx, qc_distortion *d) {
    const size_t n = (size_t)d->n;
    d->side = QC__NEW(ctx, qc__side, n);
    d->r = QC__NEW(ctx, qc_complex, n);
    d->curl = QC__NEW(ctx, qc_complex, n * QC__TRIALS);
    d->reach = QC__NEW(ctx, int32_t, 2 * n);
    d->sparse = QC__NEW(ctx, qc_complex, 2 * n);
    if (d->stretch) d->odd = QC__ZERO(ctx, uint8_t, n);
    return d->side && d->r && d->curl && d->reach && d->sparse && (d->odd || !d->stretch);
}

static double length_in(const qc_sizing *sizing, int32_t t) {
    return !sizing ? 1 : sizing->length ? sizing->length[t] : sizing->edge_length;
}

static void copy_start(qc_distortion *d, const qc_sizing *sizing) {
    const qc_mesh *mesh = d->mesh;
    memcpy(d->m, d->start->m, (size_t)mesh->n_edges);
    memcpy(d->index4, d->start->index4, (size_t)mesh->n_vertices * sizeof *d->index4);
    memcpy(d->x, d->start->field->x, (size_t)mesh->n_faces * sizeof *d->x);
    d->branch_points = d->start->n_singular;
    d->whole = 0;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const double unit = d->smoother.c.area[t] / (length_in(sizing, t) * length_in(sizing, t));
        d->whole += d->stretch ? unit * cosh(2 * qc__stretch_along(d->stretch[t], d->x[t])) : unit;
    }
}

static void fill_sides(qc_distortion *d, const qc_sizing *sizing) {
    const qc_mesh *mesh = d->mesh;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t i = d->matrix->unknown[e], h = mesh->edge_halfedge[2 * e];
        const int32_t g = mesh->edge_halfedge[2 * e + 1];
        if (i < 0) continue;
        const qc__side side = {
            h / 3, g / 3, qc__z(qc__c(d->smoother.c.edge[h]) / length_in(sizing, h / 3)),
            qc_quarter_turn(qc__z(qc__c(d->smoother.c.edge[g]) / length_in(sizing, g / 3)),
                            d->m[e])};
        d->side[i] = side;
        if (d->odd) d->odd[i] = d->m[e] % 2 != 0;
    }
}

/* Where the constants are in the kernel one edge is no unknown. */
static void find_frozen(qc_distortion *d) {
    for (int32_t e = 0; e < d->mesh->n_edges; e++)
        if (d->mesh->edge_halfedge[2 * e + 1] >= 0 && d->matrix->unknown[e] < 0)
            d->frozen[d->mesh->face_component[d->mesh->edge_halfedge[2 * e] / 3]] = 1;
}

void qc__find_hard(const qc_face_field *field, uint8_t *hard) {
    for (int32_t e = 0; field->aligned && e < field->mesh->n_edges; e++)
        for (int i = 0; i < 2; i++)
            if (field->aligned[e]) hard[field->mesh->edge_vertex[2 * e + i]] = 1;
}

bool qc_distortion_can_flip(const qc_distortion *d, int32_t e) {
    const int32_t *h = d->mesh->edge_halfedge + 2 * e, *v = d->mesh->edge_vertex + 2 * e;
    return h[1] >= 0 && !d->frozen[d->mesh->face_component[h[0] / 3]] && !d->hard[v[0]] &&
           !d->hard[v[1]];
}

static qc_status factorise(qc_ctx *ctx, qc_distortion *d) {
    qc_analyze_options options = QC_ANALYZE_OPTIONS_INIT;
    options.ordering = QC_ORDER_DISSECTION;
    qc_symbolic *symbolic = NULL;
    qc_status status = qc_analyze(ctx, &d->matrix->A, &options, &symbolic);
    if (!status) status = qc_factorize(ctx, symbolic, &d->matrix->A, &d->factor);
    qc_symbolic_free(symbolic);
    return status;
}

static qc_status prepare(qc_ctx *ctx, qc_distortion *d, const qc_sizing *sizing, double lambda) {
    const qc_face_field *field = d->start->field;
    const qc_cover cover = {d->mesh, d->start->m};
    qc_status status =
        qc__smoother_create(ctx, d->mesh, field->weight, field->trusted, lambda, &d->smoother);
    if (!status)
        status = qc_mesh_geometry(ctx, d->mesh, NULL, NULL, d->cotangent, NULL, NULL, NULL);
    if (!status) status = qc_stiffness_edges(ctx, &cover, d->cotangent, &d->matrix);
    if (status) return status;
    d->n = d->matrix->A.n;
    find_frozen(d);
    qc__find_hard(d->start->field, d->hard);
    copy_start(d, sizing);
    if (d->n == 0) return QC_OK;
    if (!allocate_unknowns(ctx, d)) return QC_ERR_NOMEM;
    fill_sides(d, sizing);
    return factorise(ctx, d);
}

static qc_status first_energy(qc_ctx *ctx, qc_distortion *d) {
    const qc_flip_step none = {-1, 0};
    if (d->n == 0) return QC_OK;
    qc__weak_curl(d, d->x, none, d->r);
    memcpy(d->curl, d->r, (size_t)d->n * sizeof *d->r);
    const qc_status status = qc_solve_forward(ctx, d->factor, 1, d->curl);
    double square = 0;
    for (int32_t i = 0; i < d->n; i++)
        square += d->curl[i].re * d->curl[i].re + d->curl[i].im * d->curl[i].im;
    d->energy = 0.5 * square;
    d->evaluations++;
    return status;
}

qc_status qc_distortion_create(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                               double lambda, qc_distortion **out) {
    if (sizing && sizing->mesh != matching->field->mesh)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the sizing belongs to another mesh");
    if (!(lambda >= 0 && lambda <= 1))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "lambda = %g is not in [0, 1]", lambda);
    qc_distortion *d = QC__ZERO(ctx, qc_distortion, 1);
    if (!d) return QC_ERR_NOMEM;
    d->start = qc_object_retain(matching);
    d->mesh = matching->field->mesh;
    if (sizing) {
        d->sizing = qc_object_retain(sizing);
        d->stretch = sizing->stretch;
    }
    qc_status status = allocate(ctx, d) ? prepare(ctx, d, sizing, lambda) : QC_ERR_NOMEM;
    if (!status) status = first_energy(ctx, d);
    if (status) {
        qc_distortion_free(d);
        return status;
    }
    qc__sample_state(ctx, d);
    *out = d;
    return QC_OK;
}

void qc__sample_state(qc_ctx *ctx, const qc_distortion *d) {
    const double x = (double)d->evaluations;
    qc_ctx_sample(ctx, "E_D_rel", x, d->whole > 0 ? 100 * d->energy / d->whole : 0);
    qc_ctx_sample(ctx, "branch_points", x, d->branch_points);
}

void qc_distortion_free(qc_distortion *d) {
    if (!d) return;
    void *const blocks[] = {d->cotangent, d->side,   d->m,      d->index4, d->bend, d->alpha,
                            d->x,         d->angle,  d->turned, d->r,      d->curl, d->reach,
                            d->sparse,    d->frozen, d->hard,   d->known,  d->odd};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    qc__smoother_free(&d->smoother);
    qc_stiffness_free(d->matrix);
    qc_factor_free(d->factor);
    qc_object_release(d->start);
    qc_object_release(d->sizing);
    qc__free(d);
}

void qc_distortion_get_state(const qc_distortion *d, qc_distortion_state *state) {
    const qc_distortion_state s = {d->energy,  d->whole, d->branch_points, d->evaluations,
                                   d->changes, d->m,     d->index4};
    *state = s;
}

qc_status qc__refresh_factor(qc_ctx *ctx, qc_distortion *d) {
    if (!d->stale) return QC_OK;
    const qc_status status = qc_refactorize(ctx, d->factor, &d->matrix->A);
    if (status) return status;
    d->stale = false;
    d->updates = 0;
    return QC_OK;
}

static qc_status refactorise(qc_ctx *ctx, qc_distortion *d) {
    const size_t n = (size_t)d->n;
    d->stale = true;
    qc_status status = qc__refresh_factor(ctx, d);
    if (status) return status;
    memcpy(d->curl, d->r, n * sizeof *d->r);
    status = qc_solve_forward(ctx, d->factor, 1, d->curl);
    double square = 0;
    for (size_t i = 0; i < n; i++)
        square += d->curl[i].re * d->curl[i].re + d->curl[i].im * d->curl[i].im;
    if (!status) d->energy = 0.5 * square;
    return status;
}

/* max |r - L* v| / (max |L*| max |v| + max |r|); left: n. */
static double residual(const qc_distortion *d, const qc_complex *v, qc_complex *left) {
    const qc_hermitian *A = &d->matrix->A;
    double most_a = 0, most_v = 0, most_r = 0, most = 0;
    memcpy(left, d->r, (size_t)d->n * sizeof *left);
    for (int32_t j = 0; j < A->n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t i = A->row[p];
            const double _Complex a = qc__c(A->val[p]);
            most_a = fmax(most_a, fabs(creal(a)) + fabs(cimag(a)));
            left[i] = qc__z(qc__c(left[i]) - a * qc__c(v[j]));
            if (i != j) left[j] = qc__z(qc__c(left[j]) - conj(a) * qc__c(v[i]));
        }
    for (int32_t i = 0; i < d->n; i++) {
        most_v = fmax(most_v, fabs(v[i].re) + fabs(v[i].im));
        most_r = fmax(most_r, fabs(d->r[i].re) + fabs(d->r[i].im));
        most = fmax(most, fabs(left[i].re) + fabs(left[i].im));
    }
    return most > 0 ? most / (most_a * most_v + most_r) : 0;
}

/* curl holds v = L*^{-1} r afterwards. */
static qc_status copotential(qc_ctx *ctx, qc_distortion *d) {
    const size_t n = (size_t)d->n;
    for (int pass = 0;; pass++) {
        memcpy(d->curl, d->r, n * sizeof *d->r);
        qc_status status = qc_solve(ctx, d->factor, 1, d->curl);
        if (status || pass > 0 || d->updates == 0) return status;
        if (residual(d, d->curl, d->curl + n) <= DRIFT) return QC_OK;
        status = refactorise(ctx, d);
        if (status) return status;
    }
}

static double present_theta(const qc_distortion *d, int32_t e) {
    const int32_t *h = d->mesh->edge_halfedge + 2 * e;
    return d->start->theta[e] - (d->m[e] - d->start->m[e]) * QC__PI / 2 - d->alpha[h[0] / 3] +
           d->alpha[h[1] / 3];
}

qc_status qc_distortion_shares(qc_ctx *ctx, qc_distortion *d, double *share, double *theta) {
    const qc_mesh *mesh = d->mesh;
    qc_status status = share ? qc__refresh_factor(ctx, d) : QC_OK;
    if (!status && share && d->n > 0) status = copotential(ctx, d);
    if (status) return status;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t i = d->matrix->unknown[e];
        if (share)
            share[e] =
                i < 0 ? 0 : 0.5 * fabs(d->curl[i].re * d->r[i].re + d->curl[i].im * d->r[i].im);
        if (theta) theta[e] = mesh->edge_halfedge[2 * e + 1] < 0 ? 0 : present_theta(d, e);
    }
    return QC_OK;
}

/* The angle between two crosses is known up to full turns only; m takes up those which the tracked
 * theta does not have. */
static void match_turns(const qc_distortion *d, int8_t *m) {
    const qc_mesh *mesh = d->mesh;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        m[e] = d->m[e];
        if (mesh->edge_halfedge[2 * e + 1] < 0) continue;
        const int32_t s = mesh->edge_halfedge[2 * e] / 3, t = mesh->edge_halfedge[2 * e + 1] / 3;
        const double a =
            qc__arg(qc__c(d->x[t]) * conj(qc__c(d->smoother.c.rho[e]) * qc__c(d->x[s])));
        m[e] = (int8_t)lround((a - present_theta(d, e)) * 2 / QC__PI);
    }
}

qc_status qc_distortion_matching(qc_ctx *ctx, const qc_distortion *d, qc_matching **out) {
    const qc_face_field *old = d->start->field;
    qc_face_field *field = NULL;
    int8_t *m = QC__NEW(ctx, int8_t, d->mesh->n_edges);
    if (!m) return QC_ERR_NOMEM;
    match_turns(d, m);
    qc_status status = qc_face_field_create(ctx, d->mesh, d->x, old->weight, old->trusted, &field);
    if (!status && old->aligned)
        status = qc_face_field_set_aligned(ctx, field, old->aligned, old->bend);
    if (!status) status = qc_matching_create(ctx, field, m, out);
    qc_object_release(field);
    qc__free(m);
    return status;
}
