/* The period matrix by the Sigma trick (thesis 6.3.2) and harmonic maps with given periods. */
#include "sdk/map/periods/period_matrix.h"
#include <string.h>

enum { BLOCK = 16 }; /* right-hand sides solved together */

void qc__periods_free(qc__periods *p) {
    if (!p) return;
    qc_stiffness_free(p->stiffness);
    if (p->factor) p->solver->destroy(p->factor);
    qc__free(p->gauge);
    qc__free(p->seam_face);
    qc__free(p->column_start);
    qc__free(p->column_symbol);
    qc__free(p->column_value);
    qc__free(p);
}

/* F here lives in the combed gauge of the first wedge, that of qc_stiffness_vertices in the face of
 * vertex_corner: f'_c = i^{face_turn} f_c = i^{face_turn + corner_turn} F~ at a corner c of that
 * wedge. */
static qc_status find_gauge(qc_ctx *ctx, const qc_cover *cover, const int8_t *face_turn,
                            const qc__seams *seams, int8_t *gauge) {
    const qc_mesh *mesh = cover->mesh;
    const int64_t n_corners = 3 * (int64_t)mesh->n_faces;
    int8_t *corner_turn = QC__NEW(ctx, int8_t, n_corners);
    if (!corner_turn) return QC_ERR_NOMEM;
    const qc_status status = qc_cover_corner_turns(ctx, cover, corner_turn);
    if (status == QC_OK)
        for (int64_t c = 0; c < n_corners; c++) {
            const int32_t v = mesh->face_vertex[c];
            if (seams->corner_wedge[c] == seams->vertex_wedge[v])
                gauge[v] = (int8_t)((face_turn[c / 3] + corner_turn[c]) & 3);
        }
    qc__free(corner_turn);
    return status;
}

static qc_status factorise(qc_ctx *ctx, const qc_cover *cover, qc__periods *p) {
    const qc__seams *s = p->seams;
    uint8_t *pinned = QC__ZERO(ctx, uint8_t, cover->mesh->n_vertices);
    if (!pinned) return QC_ERR_NOMEM;
    for (int32_t i = 0; i < s->n_cones; i++) pinned[s->cone_vertex[i]] = 1;
    qc_status status = qc_stiffness_vertices(ctx, cover, p->cotangent, pinned, &p->stiffness);
    qc__free(pinned);
    if (status != QC_OK || p->stiffness->A.n == 0) return status;
    status = qc_solver_check(ctx, p->solver);
    if (status == QC_OK)
        status = p->solver->analyze(p->solver, ctx, &p->stiffness->A, NULL, &p->factor);
    if (status == QC_OK) status = p->solver->factorize(ctx, p->factor, &p->stiffness->A);
    return status;
}

static qc_status find_seam_faces(qc_ctx *ctx, qc__periods *p) {
    const qc__seams *s = p->seams;
    for (int32_t pass = 0; pass < 2; pass++) {
        int32_t n = 0;
        for (int32_t t = 0; t < s->mesh->n_faces; t++)
            for (int32_t k = 0; k < 3; k++) {
                const int32_t w = s->corner_wedge[3 * t + k];
                if (s->wedge_start[w] == s->wedge_start[w + 1]) continue;
                if (pass == 1) p->seam_face[n] = t;
                n++;
                break;
            }
        if (pass == 0) {
            p->seam_face = QC__NEW(ctx, int32_t, n);
            if (!p->seam_face) return QC_ERR_NOMEM;
        }
        p->n_seam_faces = n;
    }
    return QC_OK;
}

/* The rows of seams.h by columns. */
static qc_status transpose_rows(qc_ctx *ctx, qc__periods *p) {
    const qc__seams *s = p->seams;
    const int32_t n_symbols = qc__seams_symbols(s);
    const int64_t n = s->row_start[n_symbols];
    p->n_columns = s->n_free;
    p->column_start = QC__ZERO(ctx, int64_t, s->n_free + 2);
    p->column_symbol = QC__NEW(ctx, int32_t, n);
    p->column_value = QC__NEW(ctx, double _Complex, n);
    if (!p->column_start || !p->column_symbol || !p->column_value) return QC_ERR_NOMEM;
    for (int64_t i = 0; i < n; i++) p->column_start[s->row_free[i] + 2]++;
    for (int32_t j = 0; j < s->n_free; j++) p->column_start[j + 2] += p->column_start[j + 1];
    for (int32_t symbol = 0; symbol < n_symbols; symbol++)
        for (int64_t i = s->row_start[symbol]; i < s->row_start[symbol + 1]; i++) {
            const int64_t at = p->column_start[s->row_free[i] + 1]++;
            p->column_symbol[at] = symbol;
            p->column_value[at] = s->row_value[i];
        }
    return QC_OK;
}

qc_status qc__periods_create(qc_ctx *ctx, const qc_cover *cover, const qc__seams *seams,
                             const double *cotangent, const int8_t *face_turn,
                             const qc_solver *solver, qc__periods **out) {
    qc__periods *p = QC__ZERO(ctx, qc__periods, 1);
    if (!p) return QC_ERR_NOMEM;
    p->seams = seams;
    p->cotangent = cotangent;
    p->solver = solver ? solver : &qc_solver_builtin;
    p->gauge = QC__ZERO(ctx, int8_t, cover->mesh->n_vertices);
    qc_status status = p->gauge ? find_gauge(ctx, cover, face_turn, seams, p->gauge) : QC_ERR_NOMEM;
    if (status == QC_OK) status = find_seam_faces(ctx, p);
    if (status == QC_OK) status = transpose_rows(ctx, p);
    if (status == QC_OK) status = factorise(ctx, cover, p);
    if (status != QC_OK) {
        qc__periods_free(p);
        return status;
    }
    *out = p;
    return QC_OK;
}

/* Scratch of one column of the period matrix. */
typedef struct column {
    double _Complex *symbol; /* n_symbols: values of the symbols, later their duals */
    double _Complex *wedge;  /* n_wedges: o_w, later the residual summed over the wedge  */
} column;

/* o_w from the values of the symbols. */
static void wedge_offsets(const qc__seams *s, const double _Complex *symbol,
                          double _Complex *wedge) {
    for (int32_t w = 0; w < s->n_wedges; w++) {
        double _Complex o = 0;
        for (int64_t i = s->wedge_start[w]; i < s->wedge_start[w + 1]; i++)
            o += qc__turn(symbol[s->term_symbol[i]], s->term_turn[i]);
        wedge[w] = o;
    }
}

/* K y in one face: K = 1/2 sum of cotangents times the edge differences. */
static void face_residual(const double *cotangent, const double _Complex y[3],
                          double _Complex g[3]) {
    const double _Complex d0 = 0.5 * cotangent[0] * (y[1] - y[2]);
    const double _Complex d1 = 0.5 * cotangent[1] * (y[2] - y[0]);
    const double _Complex d2 = 0.5 * cotangent[2] * (y[0] - y[1]);
    g[0] = d2 - d1;
    g[1] = d0 - d2;
    g[2] = d1 - d0;
}

/* Right-hand side -W^H K O of L in the gauge and numbering of the stiffness matrix. */
static void assemble_rhs(const qc__periods *p, const double _Complex *wedge, qc_complex *rhs) {
    const qc__seams *s = p->seams;
    memset(rhs, 0, sizeof *rhs * (size_t)p->stiffness->A.n);
    for (int32_t i = 0; i < p->n_seam_faces; i++) {
        const int32_t t = p->seam_face[i];
        double _Complex y[3], g[3];
        for (int32_t k = 0; k < 3; k++) y[k] = wedge[s->corner_wedge[3 * t + k]];
        face_residual(p->cotangent + 3 * (int64_t)t, y, g);
        for (int32_t k = 0; k < 3; k++) {
            const int32_t v = s->mesh->face_vertex[3 * t + k], u = p->stiffness->unknown[v];
            if (u < 0) continue;
            const int32_t turn = s->wedge_turn[s->corner_wedge[3 * t + k]] + p->gauge[v];
            const double _Complex r = qc__turn(g[k], -turn);
            rhs[u].re -= creal(r);
            rhs[u].im -= cimag(r);
        }
    }
}

/* (W F + O x) at corner c. */
static double _Complex corner_value(const qc__periods *p, const qc_complex *F,
                                    const double _Complex *wedge, int64_t c) {
    const qc__seams *s = p->seams;
    const int32_t v = s->mesh->face_vertex[c], u = p->stiffness->unknown[v];
    const int32_t w = s->corner_wedge[c];
    double _Complex value = wedge[w];
    if (u >= 0) value += qc__turn(qc__complex(F[u]), s->wedge_turn[w] + p->gauge[v]);
    return value;
}

/* Column of O^H K (O + W F), spread over the free variables: dual (n_free). */
static void project(const qc__periods *p, const qc_complex *F, column *scratch,
                    double _Complex *residual, double _Complex *dual) {
    const qc__seams *s = p->seams;
    memset(residual, 0, sizeof *residual * (size_t)s->n_wedges);
    for (int32_t i = 0; i < p->n_seam_faces; i++) {
        const int32_t t = p->seam_face[i];
        double _Complex y[3], g[3];
        for (int32_t k = 0; k < 3; k++)
            y[k] = corner_value(p, F, scratch->wedge, 3 * (int64_t)t + k);
        face_residual(p->cotangent + 3 * (int64_t)t, y, g);
        for (int32_t k = 0; k < 3; k++) residual[s->corner_wedge[3 * t + k]] += g[k];
    }
    memset(scratch->symbol, 0, sizeof *scratch->symbol * (size_t)qc__seams_symbols(s));
    for (int32_t w = 0; w < s->n_wedges; w++)
        for (int64_t i = s->wedge_start[w]; i < s->wedge_start[w + 1]; i++)
            scratch->symbol[s->term_symbol[i]] += qc__turn(residual[w], -s->term_turn[i]);
    for (int32_t j = 0; j < s->n_free; j++) {
        double _Complex sum = 0;
        for (int64_t i = p->column_start[j]; i < p->column_start[j + 1]; i++)
            sum += conj(p->column_value[i]) * scratch->symbol[p->column_symbol[i]];
        dual[j] = sum;
    }
}

static void load_column(const qc__periods *p, int32_t j, column *scratch) {
    const qc__seams *s = p->seams;
    memset(scratch->symbol, 0, sizeof *scratch->symbol * (size_t)qc__seams_symbols(s));
    for (int64_t i = p->column_start[j]; i < p->column_start[j + 1]; i++)
        scratch->symbol[p->column_symbol[i]] = p->column_value[i];
    wedge_offsets(s, scratch->symbol, scratch->wedge);
}

/* The Hermitian entry P_ij as a 2 x 2 block, averaged with its mirror image. */
static void store_real(double *P, int64_t n, int64_t i, int64_t j, double _Complex value) {
    const double re = creal(value), im = cimag(value);
    P[2 * i + 2 * j * 2 * n] = P[2 * i + 1 + (2 * j + 1) * 2 * n] = re;
    P[2 * i + 1 + 2 * j * 2 * n] = im;
    P[2 * i + (2 * j + 1) * 2 * n] = -im;
}

static void symmetrise(double *P, int64_t size) {
    for (int64_t j = 0; j < size; j++)
        for (int64_t i = 0; i < j; i++)
            P[i + j * size] = P[j + i * size] = 0.5 * (P[i + j * size] + P[j + i * size]);
}

qc_status qc__period_matrix(qc_ctx *ctx, const qc__periods *p, double *P) {
    const qc__seams *s = p->seams;
    const int64_t n = s->n_free, rows = p->stiffness->A.n;
    column scratch = {QC__NEW(ctx, double _Complex, qc__seams_symbols(s)),
                      QC__NEW(ctx, double _Complex, s->n_wedges)};
    double _Complex *residual = QC__NEW(ctx, double _Complex, s->n_wedges);
    double _Complex *dual = QC__NEW(ctx, double _Complex, n);
    qc_complex *F = QC__NEW(ctx, qc_complex, BLOCK * rows);
    qc_status status =
        scratch.symbol && scratch.wedge && residual && dual && F ? QC_OK : QC_ERR_NOMEM;
    for (int64_t first = 0; first < n && status == QC_OK; first += BLOCK) {
        const int64_t last = first + BLOCK < n ? first + BLOCK : n;
        if (!qc__progress(ctx, (double)first / (double)n)) {
            status = QC_ERR_CANCELLED;
            break;
        }
        for (int64_t j = first; j < last; j++) {
            load_column(p, (int32_t)j, &scratch);
            assemble_rhs(p, scratch.wedge, F + (j - first) * rows);
        }
        if (p->factor) status = p->solver->solve(ctx, p->factor, (int32_t)(last - first), F);
        for (int64_t j = first; j < last && status == QC_OK; j++) {
            load_column(p, (int32_t)j, &scratch);
            project(p, F + (j - first) * rows, &scratch, residual, dual);
            for (int64_t i = 0; i < n; i++) store_real(P, n, i, j, dual[i]);
        }
    }
    if (status == QC_OK) symmetrise(P, 2 * n);
    qc__free(scratch.symbol);
    qc__free(scratch.wedge);
    qc__free(residual);
    qc__free(dual);
    qc__free(F);
    return status;
}

qc_status qc__periods_add_map(qc_ctx *ctx, const qc__periods *p, const double _Complex *d,
                              qc_complex *f) {
    const qc__seams *s = p->seams;
    const int32_t n_symbols = qc__seams_symbols(s);
    double _Complex *symbol = QC__ZERO(ctx, double _Complex, n_symbols);
    double _Complex *wedge = QC__NEW(ctx, double _Complex, s->n_wedges);
    qc_complex *F = QC__NEW(ctx, qc_complex, p->stiffness->A.n);
    qc_status status = symbol && wedge && F ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t j = 0; j < n_symbols; j++)
            for (int64_t i = s->row_start[j]; i < s->row_start[j + 1]; i++)
                symbol[j] += s->row_value[i] * d[s->row_free[i]];
        wedge_offsets(s, symbol, wedge);
        assemble_rhs(p, wedge, F);
        if (p->factor) status = p->solver->solve(ctx, p->factor, 1, F);
    }
    if (status == QC_OK)
        for (int64_t c = 0; c < 3 * (int64_t)s->mesh->n_faces; c++) {
            const double _Complex delta = corner_value(p, F, wedge, c);
            f[c].re += creal(delta);
            f[c].im += cimag(delta);
        }
    qc__free(symbol);
    qc__free(wedge);
    qc__free(F);
    return status;
}
