/* The aligned map nearest to a seamless map (see align.h). */
#include "sdk/map/periods/align.h"
#include "sdk/map/periods/period_factor.h"
#include <math.h>
#include <string.h>

static double dot(int64_t n, const double *a, const double *b) {
    double sum = 0;
    for (int64_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

enum { ITERATIONS = 50 }; /* of the refinement, at most; a few are enough */

/* y -= P^-1 slope by conjugate gradients, preconditioned by the factor of P with a shift: P is
 * semidefinite where a period moves nothing. r, d, Pd, s: n each; r enters as the slope. */
static qc_status descend(qc_ctx *ctx, int32_t n, const double *P, double *r, double *d, double *Pd,
                         double *s, double *y) {
    qc__period_factor factor;
    qc_status status = qc__period_factor_create(ctx, n, P, &factor);
    if (status != QC_OK) return status;
    double rho = 0, first = 0;
    for (int k = 0; k < ITERATIONS; k++) {
        memcpy(s, r, sizeof *s * (size_t)n);
        status = qc_solve_real(ctx, factor.factor, 1, s);
        const double next = dot(n, r, s);
        if (k == 0) first = next;
        if (status != QC_OK || !(next > 1e-28 * first)) break;
        for (int64_t i = 0; i < n; i++) d[i] = s[i] + (k > 0 ? next / rho * d[i] : 0);
        rho = next;
        for (int64_t i = 0; i < n; i++) Pd[i] = dot(n, P + i * n, d);
        const double curvature = dot(n, d, Pd);
        if (!(curvature > 0)) break;
        const double step = rho / curvature;
        for (int64_t i = 0; i < n; i++) {
            y[i] -= step * d[i];
            r[i] -= step * Pd[i];
        }
    }
    qc__period_factor_free(&factor);
    return status;
}

typedef struct work {
    double *slope, *direction, *image, *s; /* n_free */
    double *symbol;                        /* n_symbols */
    qc_complex *deviation;                 /* 3 n_faces: df - z */
    double _Complex *load, *given, *wedge; /* n_wedges */
    double _Complex *F, *change;           /* n_vertices */
} work;

/* What f lacks to be the best map with periods y, in the wedges and in F. */
static qc_status solve(qc_ctx *ctx, const qc__periods *p, const double *y, work *w) {
    qc__seams_symbol_values(p->seams, y, w->symbol);
    qc__seams_wedge_values(p->seams, w->symbol, w->wedge);
    for (int32_t i = 0; i < p->seams->n_wedges; i++) w->wedge[i] -= w->given[i];
    return qc__periods_extend(ctx, p, w->wedge, w->load, w->change);
}

static qc_status align(qc_ctx *ctx, const qc__periods *p, const double *P, const qc_complex *z,
                       qc_complex *f, double *y, work *w) {
    const qc__seams *s = p->seams;
    for (int32_t c = 0; c < 3 * s->mesh->n_faces; c++) {
        const qc_complex a = f[qc_next(c)], b = f[qc_prev(c)];
        const qc_complex d = {b.re - a.re - z[c].re, b.im - a.im - z[c].im};
        w->deviation[c] = d;
    }
    qc__periods_load(s, p->stiffness->cotangent, w->deviation, w->load);
    qc__periods_split(s, f, w->given, w->F);
    qc_status status = QC_OK;
    if (P) {
        status = solve(ctx, p, y, w);
        if (status == QC_OK)
            status = qc__periods_slope(ctx, p, w->wedge, w->load, w->change, w->slope);
        if (status == QC_OK)
            status = descend(ctx, s->n_free, P, w->slope, w->direction, w->image, w->s, y);
        if (status != QC_OK) return status;
    }
    status = solve(ctx, p, y, w);
    if (status != QC_OK) return status;
    for (int32_t i = 0; i < s->n_wedges; i++) w->wedge[i] += w->given[i];
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) w->F[v] += w->change[v];
    qc__periods_corners(s, w->wedge, w->F, f);
    return QC_OK;
}

qc_status qc__align(qc_ctx *ctx, const qc__periods *periods, const double *P, const qc_complex *z,
                    qc_complex *f, double *y) {
    const qc__seams *s = periods->seams;
    const int64_t n_corners = 3 * (int64_t)s->mesh->n_faces;
    work w = {QC__NEW(ctx, double, s->n_free),
              QC__NEW(ctx, double, s->n_free),
              QC__NEW(ctx, double, s->n_free),
              QC__NEW(ctx, double, s->n_free),
              QC__NEW(ctx, double, qc__seams_symbols(s)),
              QC__NEW(ctx, qc_complex, n_corners),
              QC__NEW(ctx, double _Complex, s->n_wedges),
              QC__NEW(ctx, double _Complex, s->n_wedges),
              QC__NEW(ctx, double _Complex, s->n_wedges),
              QC__NEW(ctx, double _Complex, s->mesh->n_vertices),
              QC__NEW(ctx, double _Complex, s->mesh->n_vertices)};
    qc_status status = QC_ERR_NOMEM;
    if (w.slope && w.direction && w.image && w.s && w.symbol && w.deviation && w.load && w.given &&
        w.wedge && w.F && w.change)
        status = align(ctx, periods, P, z, f, y, &w);
    void *const blocks[] = {w.slope, w.direction, w.image, w.s, w.symbol, w.deviation,
                            w.load,  w.given,     w.wedge, w.F, w.change};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
