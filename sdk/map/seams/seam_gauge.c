/* The gauge of a map with seams: a global shift of each component sets up to two of its variables
 * to zero (see seams.h). */
#include <math.h>
#include "sdk/map/seams/seam_solve.h"

int32_t qc__seams_component(const qc__seams *s, int32_t symbol) {
    const int32_t j = symbol / 2, level = symbol - qc__level_symbol(s, 0);
    const int32_t v = level >= 0          ? s->level_coordinate[level] / 2
                      : j < s->n_segments ? s->segment_node[2 * (int64_t)j]
                                          : s->cone_vertex[j - s->n_segments];
    return s->mesh->face_component[s->mesh->vertex_corner[v] / 3];
}

double qc__seams_shift(const qc__seams *s, int32_t symbol, double _Complex w) {
    const int32_t j = symbol / 2, level = symbol - qc__level_symbol(s, 0);
    if (level >= 0) return s->level_coordinate[level] % 2 ? cimag(w) : creal(w);
    if (j >= s->n_segments + s->n_cones) return 0; /* a pole */
    const double _Complex change = j < s->n_segments ? w - qc__turn(w, s->segment_turn[j]) : w;
    return symbol % 2 ? cimag(change) : creal(change);
}

double _Complex qc__seams_response(const qc__seams *s, int32_t y) {
    double _Complex sum = 0;
    for (int64_t i = s->free_row.start[y]; i < s->free_row.start[y + 1]; i++) {
        const int32_t j = s->free_row.column[i];
        sum += s->free_row.value[i] * (qc__seams_shift(s, j, 1) + qc__seams_shift(s, j, I) * I);
    }
    return sum;
}

/* Up to two variables a component which a global shift can set to zero, with independent responses:
 * those whose lattice is coarsest in units of the response. */
static qc_status choose_fixed(qc_ctx *ctx, const qc__seams *s, uint8_t *fixed) {
    const int32_t n = s->mesh->n_components;
    int32_t *chosen = QC__NEW(ctx, int32_t, n);
    double *least = QC__NEW(ctx, double, n);
    double _Complex *first = QC__ZERO(ctx, double _Complex, n);
    const bool done = chosen && least && first;
    for (int32_t pass = 0; pass < 2 && done; pass++) {
        for (int32_t c = 0; c < n; c++) {
            chosen[c] = -1;
            least[c] = INFINITY;
        }
        for (int32_t y = s->n_free - 1; y >= 0; y--) {
            const int32_t c = qc__seams_component(s, s->free_row.column[s->free_row.start[y]]);
            const double _Complex r = qc__seams_response(s, y);
            /* passes: length; area with the first */
            const double size = pass == 0 ? cabs(r) : fabs(cimag(conj(first[c]) * r));
            if (fixed[y] || size == 0 || size >= least[c]) continue;
            least[c] = size;
            chosen[c] = y;
        }
        for (int32_t c = 0; c < n; c++)
            if (chosen[c] >= 0) {
                fixed[chosen[c]] = 1;
                first[c] = qc__seams_response(s, chosen[c]);
            }
    }
    qc__free(chosen);
    qc__free(least);
    qc__free(first);
    return done ? QC_OK : QC_ERR_NOMEM;
}

/* Moves the fixed variables to the end and out of the rows of the symbols. */
static qc_status drop_fixed(qc_ctx *ctx, qc__seams *s, const uint8_t *fixed) {
    const int32_t n = s->n_free;
    int32_t *number = QC__NEW(ctx, int32_t, n), *old = QC__NEW(ctx, int32_t, n);
    const int64_t terms = s->free_row.start[n];
    qc__rows rows = {QC__NEW(ctx, int64_t, n + 1), QC__NEW(ctx, int32_t, terms),
                     QC__NEW(ctx, double, terms)};
    s->fixed_component = QC__NEW(ctx, int32_t, n);
    if (!number || !old || !rows.start || !rows.column || !rows.value || !s->fixed_component) {
        qc__free(number);
        qc__free(old);
        qc__rows_free(&rows);
        return QC_ERR_NOMEM;
    }
    int32_t k = 0;
    for (int32_t pass = 0; pass < 2; pass++) {
        for (int32_t y = 0; y < n; y++)
            if (fixed[y] == pass) {
                old[k] = y;
                number[y] = k++;
            }
        if (pass == 0) s->n_free = k;
    }
    s->n_fixed = n - s->n_free;
    rows.start[0] = 0;
    for (int32_t y = 0; y < n; y++) {
        int64_t at = rows.start[y];
        for (int64_t i = s->free_row.start[old[y]]; i < s->free_row.start[old[y] + 1]; i++) {
            rows.column[at] = s->free_row.column[i];
            rows.value[at++] = s->free_row.value[i];
        }
        rows.start[y + 1] = at;
        if (y >= s->n_free)
            s->fixed_component[y - s->n_free] = qc__seams_component(s, rows.column[rows.start[y]]);
    }
    qc__rows_free(&s->free_row);
    s->free_row = rows;
    int64_t kept = 0, from = 0;
    for (int32_t j = 0; j < qc__seams_symbols(s); j++) {
        const int64_t to = s->symbol_row.start[j + 1];
        for (int64_t i = from; i < to; i++) {
            const int32_t y = number[s->symbol_row.column[i]];
            if (y >= s->n_free) continue;
            s->symbol_row.column[kept] = y;
            s->symbol_row.value[kept++] = s->symbol_row.value[i];
        }
        from = to;
        s->symbol_row.start[j + 1] = kept;
    }
    qc__free(number);
    qc__free(old);
    return QC_OK;
}

qc_status qc__seams_fix_gauge(qc_ctx *ctx, qc__seams *s) {
    uint8_t *fixed = QC__ZERO(ctx, uint8_t, s->n_free);
    qc_status status = fixed ? choose_fixed(ctx, s, fixed) : QC_ERR_NOMEM;
    if (status == QC_OK) status = drop_fixed(ctx, s, fixed);
    qc__free(fixed);
    return status;
}
