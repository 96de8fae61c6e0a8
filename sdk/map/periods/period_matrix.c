/* The period matrix by the Sigma trick (thesis 6.3.2) and harmonic maps with given periods. */
#include "sdk/map/periods/period_matrix.h"
#include <string.h>

enum { BLOCK = 32 }; /* right-hand sides solved together */

void qc__periods_free(qc__periods *p) {
    if (!p) return;
    qc__map_stiffness_free(p->stiffness);
    qc__free(p->seam_face);
    qc__free(p->column_start);
    qc__free(p->column_symbol);
    qc__free(p->column_value);
    qc__free(p);
}

static bool at_seam(const qc__seams *s, int32_t corner) {
    const int32_t w = s->corner_wedge[corner];
    return s->wedge_start[w] < s->wedge_start[w + 1] ||
           s->vertex_given[s->mesh->face_vertex[corner]] >= 0;
}

static qc_status find_seam_faces(qc_ctx *ctx, qc__periods *p) {
    const qc__seams *s = p->seams;
    for (int32_t pass = 0; pass < 2; pass++) {
        int32_t n = 0;
        for (int32_t t = 0; t < s->mesh->n_faces; t++) {
            if (!at_seam(s, 3 * t) && !at_seam(s, 3 * t + 1) && !at_seam(s, 3 * t + 2)) continue;
            if (pass == 1) p->seam_face[n] = t;
            n++;
        }
        if (pass == 0) {
            p->seam_face = QC__NEW(ctx, int32_t, n);
            if (!p->seam_face) return QC_ERR_NOMEM;
        }
        p->n_seam_faces = n;
    }
    return QC_OK;
}

/* The rows of the symbols by columns. */
static qc_status transpose_rows(qc_ctx *ctx, qc__periods *p) {
    const qc__rows *rows = &p->seams->symbol_row;
    const int32_t n_symbols = qc__seams_symbols(p->seams), n_free = p->seams->n_free;
    const int64_t n = rows->start[n_symbols];
    p->n_columns = n_free;
    p->column_start = QC__ZERO(ctx, int64_t, n_free + 2);
    p->column_symbol = QC__NEW(ctx, int32_t, n);
    p->column_value = QC__NEW(ctx, double, n);
    if (!p->column_start || !p->column_symbol || !p->column_value) return QC_ERR_NOMEM;
    for (int64_t i = 0; i < n; i++) p->column_start[rows->column[i] + 2]++;
    for (int32_t j = 0; j < n_free; j++) p->column_start[j + 2] += p->column_start[j + 1];
    for (int32_t symbol = 0; symbol < n_symbols; symbol++)
        for (int64_t i = rows->start[symbol]; i < rows->start[symbol + 1]; i++) {
            const int64_t at = p->column_start[rows->column[i] + 1]++;
            p->column_symbol[at] = symbol;
            p->column_value[at] = rows->value[i];
        }
    return QC_OK;
}

qc_status qc__periods_create(qc_ctx *ctx, const qc__seams *seams, const double *cotangent,
                             const qc_solver *solver, qc__periods **out) {
    qc__periods *p = QC__ZERO(ctx, qc__periods, 1);
    if (!p) return QC_ERR_NOMEM;
    p->seams = seams;
    qc_status status = find_seam_faces(ctx, p);
    if (status == QC_OK) status = transpose_rows(ctx, p);
    if (status == QC_OK)
        status = qc__map_stiffness_create(ctx, seams, cotangent, solver, &p->stiffness);
    if (status != QC_OK) {
        qc__periods_free(p);
        return status;
    }
    *out = p;
    return QC_OK;
}

/* Scratch of one column of the period matrix. */
typedef struct column {
    double *symbol;            /* n_symbols: values of the symbols, later their duals */
    double _Complex *wedge;    /* n_wedges: values of the wedges  */
    double _Complex *residual; /* n_wedges: K f' summed over the wedge */
    double _Complex *F;        /* n_vertices */
} column;

static bool column_create(qc_ctx *ctx, const qc__periods *p, column *out) {
    out->symbol = QC__NEW(ctx, double, qc__seams_symbols(p->seams));
    out->wedge = QC__NEW(ctx, double _Complex, p->seams->n_wedges);
    out->residual = QC__NEW(ctx, double _Complex, p->seams->n_wedges);
    out->F = QC__NEW(ctx, double _Complex, p->seams->mesh->n_vertices);
    return out->symbol && out->wedge && out->residual && out->F;
}
static void column_free(column *c) {
    qc__free(c->symbol);
    qc__free(c->wedge);
    qc__free(c->residual);
    qc__free(c->F);
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

void qc__periods_load(const qc__seams *s, const double *cotangent, const qc_complex *d,
                      double _Complex *load) {
    for (int32_t w = 0; w < s->n_wedges; w++) load[w] = 0;
    for (int32_t c = 0; c < 3 * s->mesh->n_faces; c++) {
        const double _Complex g = 0.5 * cotangent[c] * qc__complex(d[c]);
        load[s->corner_wedge[qc_prev(c)]] += g;
        load[s->corner_wedge[qc_next(c)]] -= g;
    }
}

/* rhs += factor W^T load. */
static void add_load(const qc__periods *p, double factor, const double _Complex *load,
                     double *rhs) {
    const qc__seams *s = p->seams;
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
        const int32_t *unknown = p->stiffness->unknown + 2 * (int64_t)v;
        for (int32_t w = s->vertex_wedge[v]; w < s->vertex_wedge[v + 1]; w++) {
            const double _Complex r = qc__turn(load[w], -s->wedge_turn[w]);
            if (unknown[0] >= 0) rhs[unknown[0]] += factor * creal(r);
            if (unknown[1] >= 0) rhs[unknown[1]] += factor * cimag(r);
        }
    }
}

/* Right-hand side -W^T K (wedge values) of L. */
static void assemble_rhs(const qc__periods *p, const double _Complex *wedge, double *rhs) {
    const qc__seams *s = p->seams;
    memset(rhs, 0, sizeof *rhs * (size_t)p->stiffness->n);
    for (int32_t i = 0; i < p->n_seam_faces; i++) {
        const int32_t t = p->seam_face[i];
        double _Complex y[3], g[3];
        for (int32_t k = 0; k < 3; k++) y[k] = wedge[s->corner_wedge[3 * t + k]];
        face_residual(p->stiffness->cotangent + 3 * (int64_t)t, y, g);
        for (int32_t k = 0; k < 3; k++) {
            const int32_t *unknown =
                p->stiffness->unknown + 2 * (int64_t)s->mesh->face_vertex[3 * t + k];
            const double _Complex r = qc__turn(g[k], -s->wedge_turn[s->corner_wedge[3 * t + k]]);
            if (unknown[0] >= 0) rhs[unknown[0]] -= creal(r);
            if (unknown[1] >= 0) rhs[unknown[1]] -= cimag(r);
        }
    }
}

/* The solution x as complex values at the vertices. */
void qc__periods_spread(const qc__periods *p, const double *x, double _Complex *F) {
    const qc__map_stiffness *m = p->stiffness;
    for (int32_t v = 0; v < m->seams->mesh->n_vertices; v++) {
        const int32_t *unknown = m->unknown + 2 * (int64_t)v;
        F[v] = (unknown[0] >= 0 ? x[unknown[0]] : 0) + (unknown[1] >= 0 ? x[unknown[1]] : 0) * I;
    }
}

/* K f' over the faces at the seams, summed over the wedges. */
static void seam_residual(const qc__periods *p, const double _Complex *wedge,
                          const double _Complex *F, double _Complex *residual) {
    const qc__seams *s = p->seams;
    memset(residual, 0, sizeof *residual * (size_t)s->n_wedges);
    for (int32_t i = 0; i < p->n_seam_faces; i++) {
        const int32_t t = p->seam_face[i];
        double _Complex y[3], g[3];
        for (int32_t k = 0; k < 3; k++) {
            const int32_t w = s->corner_wedge[3 * t + k];
            y[k] = wedge[w] + qc__turn(F[s->mesh->face_vertex[3 * t + k]], s->wedge_turn[w]);
        }
        face_residual(p->stiffness->cotangent + 3 * (int64_t)t, y, g);
        for (int32_t k = 0; k < 3; k++) residual[s->corner_wedge[3 * t + k]] += g[k];
    }
}

/* O^T of the residual: dual (n_free). symbol is overwritten. */
static void project(const qc__periods *p, const double _Complex *residual, double *symbol,
                    double *dual) {
    qc__seams_wedge_duals(p->seams, residual, symbol);
    for (int32_t j = 0; j < p->seams->n_free; j++) {
        double sum = 0;
        for (int64_t i = p->column_start[j]; i < p->column_start[j + 1]; i++)
            sum += p->column_value[i] * symbol[p->column_symbol[i]];
        dual[j] = sum;
    }
}

void qc__periods_pull_back(const qc__periods *p, const double _Complex *load, double *symbol,
                           double *dF, double *dy) {
    memset(dF, 0, sizeof *dF * (size_t)p->stiffness->n);
    add_load(p, 1, load, dF);
    project(p, load, symbol, dy);
}

static void load_column(const qc__periods *p, int64_t j, column *scratch) {
    const qc__seams *s = p->seams;
    memset(scratch->symbol, 0, sizeof *scratch->symbol * (size_t)qc__seams_symbols(s));
    for (int64_t i = p->column_start[j]; i < p->column_start[j + 1]; i++)
        scratch->symbol[p->column_symbol[i]] = p->column_value[i];
    qc__seams_wedge_values(s, scratch->symbol, scratch->wedge);
}

static void symmetrise(double *P, int64_t size) {
    for (int64_t j = 0; j < size; j++)
        for (int64_t i = 0; i < j; i++)
            P[i + j * size] = P[j + i * size] = 0.5 * (P[i + j * size] + P[j + i * size]);
}

qc_status qc__period_matrix(qc_ctx *ctx, const qc__periods *p, double *P) {
    const int64_t n = p->seams->n_free, rows = p->stiffness->n;
    column scratch;
    double *x = QC__NEW(ctx, double, (n < BLOCK ? n : BLOCK) * rows);
    qc_status status = column_create(ctx, p, &scratch) && x ? QC_OK : QC_ERR_NOMEM;
    for (int64_t first = 0; first < n && status == QC_OK; first += BLOCK) {
        const int64_t last = first + BLOCK < n ? first + BLOCK : n;
        if (!qc__progress(ctx, (double)first / (double)n)) {
            status = QC_ERR_CANCELLED;
            break;
        }
        for (int64_t j = first; j < last; j++) {
            load_column(p, j, &scratch);
            assemble_rhs(p, scratch.wedge, x + (j - first) * rows);
        }
        status = qc__poll(ctx);
        if (status == QC_OK)
            status = qc__map_stiffness_solve(ctx, p->stiffness, (int32_t)(last - first), x);
        if (status == QC_OK) status = qc__poll(ctx);
        for (int64_t j = first; j < last && status == QC_OK; j++) {
            load_column(p, j, &scratch);
            qc__periods_spread(p, x + (j - first) * rows, scratch.F);
            seam_residual(p, scratch.wedge, scratch.F, scratch.residual);
            project(p, scratch.residual, scratch.symbol, P + j * n);
        }
    }
    if (status == QC_OK) symmetrise(P, n);
    column_free(&scratch);
    qc__free(x);
    return status;
}

qc_status qc__periods_extend(qc_ctx *ctx, const qc__periods *p, const double _Complex *wedge,
                             const double _Complex *load, double _Complex *F) {
    double *x = QC__NEW(ctx, double, p->stiffness->n);
    if (!x) return QC_ERR_NOMEM;
    assemble_rhs(p, wedge, x);
    if (load) add_load(p, -1, load, x);
    qc_status status = qc__poll(ctx);
    if (status == QC_OK) status = qc__map_stiffness_solve(ctx, p->stiffness, 1, x);
    if (status == QC_OK) qc__periods_spread(p, x, F);
    qc__free(x);
    return status;
}

qc_status qc__periods_add_extension(qc_ctx *ctx, const qc__periods *p, const double _Complex *wedge,
                                    double *x) {
    double *change = QC__NEW(ctx, double, p->stiffness->n);
    if (!change) return QC_ERR_NOMEM;
    assemble_rhs(p, wedge, change);
    const qc_status status = qc__map_stiffness_solve(ctx, p->stiffness, 1, change);
    for (int32_t i = 0; i < p->stiffness->n && status == QC_OK; i++) x[i] += change[i];
    qc__free(change);
    return status;
}

qc_status qc__periods_slope(qc_ctx *ctx, const qc__periods *p, const double _Complex *wedge,
                            const double _Complex *load, const double _Complex *F, double *slope) {
    column scratch;
    const bool done = column_create(ctx, p, &scratch);
    if (done) {
        seam_residual(p, wedge, F, scratch.residual);
        for (int32_t w = 0; w < p->seams->n_wedges && load; w++) scratch.residual[w] += load[w];
        project(p, scratch.residual, scratch.symbol, slope);
    }
    column_free(&scratch);
    return done ? QC_OK : QC_ERR_NOMEM;
}

void qc__periods_corners(const qc__seams *s, const double _Complex *wedge, const double _Complex *F,
                         qc_complex *f) {
    for (int64_t c = 0; c < 3 * (int64_t)s->mesh->n_faces; c++) {
        const int32_t w = s->corner_wedge[c];
        f[c] = qc__pair(qc__turn(F[s->mesh->face_vertex[c]], s->wedge_turn[w]) + wedge[w]);
    }
}

void qc__periods_split(const qc__seams *s, const qc_complex *f, double _Complex *wedge,
                       double _Complex *F) {
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
        const double _Complex value = qc__seams_value_at(s, f, v);
        F[v] = (qc__seams_is_given(s, v, 0) ? 0 : creal(value)) +
               (qc__seams_is_given(s, v, 1) ? 0 : cimag(value)) * I;
    }
    for (int64_t c = 0; c < 3 * (int64_t)s->mesh->n_faces; c++) {
        const int32_t w = s->corner_wedge[c];
        wedge[w] = qc__complex(f[c]) - qc__turn(F[s->mesh->face_vertex[c]], s->wedge_turn[w]);
    }
}
