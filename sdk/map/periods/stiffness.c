/* Assembly and solves of the real stiffness matrix (see stiffness.h). */
#include "sdk/map/periods/stiffness.h"
#include "sdk/dec/assemble.h"
#include <string.h>

void qc__map_stiffness_free(qc__map_stiffness *m) {
    if (!m) return;
    if (m->state) m->solver->destroy(m->state);
    qc__free(m->unknown);
    qc__free(m);
}

/* --- unknowns --------------------------------------------------------------------------------- */

/* bound: 2 n_components, 1 where a constant in that coordinate is no function of the unknowns
 * alone: where a segment turns, or a symbol follows the shift. */
static void find_bound(const qc__seams *s, uint8_t *bound) {
    for (int32_t j = 0; j < qc__seams_symbols(s); j++) {
        uint8_t *b = bound + 2 * (int64_t)qc__seams_component(s, j);
        b[0] |= qc__seams_shift(s, j, 1) != 0;
        b[1] |= qc__seams_shift(s, j, I) != 0;
    }
}

static qc_status number_unknowns(qc_ctx *ctx, qc__map_stiffness *m) {
    const qc__seams *s = m->seams;
    const qc_mesh *mesh = s->mesh;
    m->unknown = QC__NEW(ctx, int32_t, 2 * (int64_t)mesh->n_vertices);
    uint8_t *bound = QC__ZERO(ctx, uint8_t, 2 * (int64_t)mesh->n_components);
    const bool done = m->unknown && bound;
    if (done) find_bound(s, bound);
    for (int32_t v = 0; v < mesh->n_vertices && done; v++) {
        uint8_t *b = bound + 2 * (int64_t)mesh->face_component[mesh->vertex_corner[v] / 3];
        for (int32_t c = 0; c < 2; c++) {
            const bool given = qc__seams_is_given(s, v, c);
            m->unknown[2 * v + c] = given || !b[c] ? -1 : m->n++;
            if (!given) b[c] = 1;
        }
    }
    qc__free(bound);
    return done ? QC_OK : QC_ERR_NOMEM;
}

/* --- assembly --------------------------------------------------------------------------------- */

/* Every face stands twice, once for the real and once for the imaginary part of its corner values;
 * a local value is the coordinate of some F_v, negated by half a turn. */
static qc_status assemble(qc_ctx *ctx, const qc__map_stiffness *m, qc_stiffness *out) {
    const qc__seams *s = m->seams;
    const int32_t n_faces = s->mesh->n_faces;
    const int64_t n_corners = 3 * (int64_t)n_faces;
    int32_t *entity = QC__NEW(ctx, int32_t, 2 * n_corners);
    int8_t *turn = QC__NEW(ctx, int8_t, 2 * n_corners);
    double *cotangent = QC__NEW(ctx, double, 2 * n_corners);
    qc_status status = entity && turn && cotangent ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t part = 0; part < 2; part++) {
            memcpy(cotangent + part * n_corners, m->cotangent,
                   sizeof *cotangent * (size_t)n_corners);
            for (int64_t c = 0; c < n_corners; c++) {
                const int32_t a = s->wedge_turn[s->corner_wedge[c]];
                entity[part * n_corners + c] = 2 * s->mesh->face_vertex[c] + ((part + a) & 1);
                turn[part * n_corners + c] = qc__part_sign(part, a) < 0 ? 2 : 0;
            }
        }
        out->unknown = m->unknown;
        status = qc__assemble(ctx, 2 * n_faces, cotangent, 0.5, entity, turn, m->n, out);
    }
    qc__free(entity);
    qc__free(turn);
    qc__free(cotangent);
    return status;
}

static qc_status factorise(qc_ctx *ctx, qc__map_stiffness *m, const qc_hermitian *A) {
    qc_solver_options options = QC_SOLVER_OPTIONS_INIT;
    options.real = m->solver->factorize_real != NULL;
    qc_status status = m->solver->analyze(m->solver, ctx, A, &options, &m->state);
    if (status != QC_OK) return status;
    if (!options.real) return m->solver->factorize(ctx, m->state, A);
    double *value = QC__NEW(ctx, double, A->colptr[A->n]);
    if (!value) return QC_ERR_NOMEM;
    for (int64_t i = 0; i < A->colptr[A->n]; i++) value[i] = A->val[i].re;
    const qc_symmetric real = {A->n, A->colptr, A->row, value};
    status = m->solver->factorize_real(ctx, m->state, &real);
    qc__free(value);
    return status;
}

qc_status qc__map_stiffness_create(qc_ctx *ctx, const qc__seams *seams, const double *cotangent,
                                   const qc_solver *solver, qc__map_stiffness **out) {
    qc__map_stiffness *m = QC__ZERO(ctx, qc__map_stiffness, 1);
    if (!m) return QC_ERR_NOMEM;
    m->seams = seams;
    m->cotangent = cotangent;
    m->solver = solver ? solver : &qc_solver_builtin;
    qc_stiffness S = {.unknown = NULL};
    qc_status status = qc_solver_check(ctx, m->solver);
    if (status == QC_OK) status = number_unknowns(ctx, m);
    if (status == QC_OK && m->n > 0) status = assemble(ctx, m, &S);
    if (status == QC_OK && m->n > 0) status = factorise(ctx, m, &S.A);
    qc__free((void *)(uintptr_t)S.A.colptr);
    qc__free((void *)(uintptr_t)S.A.row);
    qc__free((void *)(uintptr_t)S.A.val);
    if (status != QC_OK) {
        qc__map_stiffness_free(m);
        return status;
    }
    *out = m;
    return QC_OK;
}

/* --- solves ----------------------------------------------------------------------------------- */

/* Two real columns as one complex one, for a backend without real solves. */
static qc_status solve_in_pairs(qc_ctx *ctx, const qc__map_stiffness *m, int32_t nrhs, double *x) {
    const int64_t n = m->n, pairs = (nrhs + 1) / 2;
    qc_complex *z = QC__NEW(ctx, qc_complex, n * pairs);
    if (!z) return QC_ERR_NOMEM;
    for (int64_t k = 0; k < pairs; k++)
        for (int64_t i = 0; i < n; i++) {
            const double second = 2 * k + 1 < nrhs ? x[(2 * k + 1) * n + i] : 0;
            z[k * n + i] = (qc_complex){x[2 * k * n + i], second};
        }
    const qc_status status = m->solver->solve(ctx, m->state, (int32_t)pairs, z);
    for (int64_t k = 0; k < pairs && status == QC_OK; k++)
        for (int64_t i = 0; i < n; i++) {
            x[2 * k * n + i] = z[k * n + i].re;
            if (2 * k + 1 < nrhs) x[(2 * k + 1) * n + i] = z[k * n + i].im;
        }
    qc__free(z);
    return status;
}

qc_status qc__map_stiffness_solve(qc_ctx *ctx, const qc__map_stiffness *m, int32_t nrhs,
                                  double *x) {
    if (m->n == 0) return QC_OK;
    if (m->solver->factorize_real) return m->solver->solve_real(ctx, m->state, nrhs, x);
    return solve_in_pairs(ctx, m, nrhs, x);
}
