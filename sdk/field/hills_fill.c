/* Replaces hills by a function with the mean value property, which has no extremum inside (see
 * hills.h). */
#include <math.h>

#include "hills.h"

typedef struct local_system {
    int32_t n, *local; /* n_vertices: number of the free ones, -1 */
    int64_t *colptr;
    int32_t *row;
    double *value, *x;
} local_system;

/* What vertex v of a hill sees at w outside of it. */
static double outside(const qc__hills *s, int32_t v, int32_t w) {
    const qc__hill *h = &s->hill[s->hill_of[v]];
    if (w == h->saddle) return s->g[w];
    return s->sign > 0 ? fmin(s->g[w], h->floor) : fmax(s->g[w], h->floor);
}

static int64_t add_column(const qc__hills *s, const double *weight, local_system *a, int32_t v,
                          int64_t begin) {
    int64_t end = begin;
    double diagonal = 0, right = 0;
    int32_t c = -1, w, e;
    while ((w = qc__next_neighbour(s->mesh, v, &c, &e)) >= 0) {
        const int32_t j = a->local[w];
        diagonal += weight[e];
        if (j < 0) right += weight[e] * outside(s, v, w);
        if (j < 0 || j > a->local[v]) continue;
        int64_t at = end++;
        for (; at > begin && a->row[at - 1] > j; at--) {
            a->row[at] = a->row[at - 1];
            a->value[at] = a->value[at - 1];
        }
        a->row[at] = j;
        a->value[at] = -weight[e];
    }
    a->row[end] = a->local[v];
    a->value[end] = diagonal;
    a->x[a->local[v]] = right;
    return end + 1;
}

static qc_status solve(qc_ctx *ctx, const qc__hills *s, const double *weight, local_system *a) {
    const qc_mesh *mesh = s->mesh;
    qc_symbolic *symbolic = NULL;
    qc_factor *factor = NULL;
    a->colptr = QC__NEW(ctx, int64_t, a->n + 1);
    a->row = QC__NEW(ctx, int32_t, a->n + mesh->n_edges);
    a->value = QC__NEW(ctx, double, a->n + mesh->n_edges);
    a->x = QC__NEW(ctx, double, a->n);
    if (!a->colptr || !a->row || !a->value || !a->x) return QC_ERR_NOMEM;
    int64_t k = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (a->local[v] < 0) continue;
        a->colptr[a->local[v]] = k;
        k = add_column(s, weight, a, v, k);
    }
    a->colptr[a->n] = k;
    const qc_symmetric A = {a->n, a->colptr, a->row, a->value};
    qc_status status = qc_analyze_real(ctx, &A, NULL, &symbolic);
    if (!status) status = qc_factorize_real(ctx, symbolic, &A, &factor);
    if (!status) status = qc_solve_real(ctx, factor, 1, a->x);
    for (int32_t v = 0; !status && v < mesh->n_vertices; v++)
        if (a->local[v] >= 0) s->g[v] = a->x[a->local[v]];
    qc_symbolic_free(symbolic);
    qc_factor_free(factor);
    return status;
}

qc_status qc__hills_fill(qc_ctx *ctx, const qc__hills *s, const double *weight) {
    local_system a = {.local = QC__NEW(ctx, int32_t, s->mesh->n_vertices)};
    qc_status status = a.local ? QC_OK : QC_ERR_NOMEM;
    for (int32_t v = 0; !status && v < s->mesh->n_vertices; v++)
        a.local[v] = s->hill_of[v] >= 0 ? a.n++ : -1;
    if (!status) status = solve(ctx, s, weight, &a);
    void *const blocks[] = {a.local, a.colptr, a.row, a.value, a.x};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
