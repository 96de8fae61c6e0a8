/* From free variables to the values of a map at the seams, and back (see seams.h). */
#include "sdk/map/seams/seams.h"
#include <string.h>

void qc__seams_symbol_values(const qc__seams *s, const double *y, double *symbol) {
    const qc__rows *rows = &s->symbol_row;
    for (int32_t j = 0; j < qc__seams_symbols(s); j++) {
        symbol[j] = 0;
        for (int64_t i = rows->start[j]; i < rows->start[j + 1]; i++)
            symbol[j] += rows->value[i] * y[rows->column[i]];
    }
}

static double given_coordinate(const qc__seams *s, const double *symbol, int32_t row) {
    double sum = 0;
    for (int64_t i = s->given_start[row]; i < s->given_start[row + 1]; i++)
        sum += s->given_value[i] * symbol[s->given_symbol[i]];
    return sum;
}

void qc__seams_wedge_values(const qc__seams *s, const double *symbol, double _Complex *wedge) {
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
        const int32_t g = s->vertex_given[v];
        double _Complex given = 0;
        if (g >= 0)
            given = given_coordinate(s, symbol, 2 * g) + given_coordinate(s, symbol, 2 * g + 1) * I;
        for (int32_t w = s->vertex_wedge[v]; w < s->vertex_wedge[v + 1]; w++) {
            wedge[w] = g >= 0 ? qc__turn(given, s->wedge_turn[w]) : 0;
            for (int64_t i = s->wedge_start[w]; i < s->wedge_start[w + 1]; i++) {
                const double *tau = symbol + qc__translation_symbol(s->term_segment[i], 0);
                wedge[w] += qc__turn(tau[0] + tau[1] * I, s->term_turn[i]);
            }
        }
    }
}

void qc__seams_wedge_duals(const qc__seams *s, const double _Complex *wedge, double *symbol) {
    memset(symbol, 0, sizeof *symbol * (size_t)qc__seams_symbols(s));
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
        const int32_t g = s->vertex_given[v];
        double _Complex given = 0;
        for (int32_t w = s->vertex_wedge[v]; w < s->vertex_wedge[v + 1]; w++) {
            if (g >= 0) given += qc__turn(wedge[w], -s->wedge_turn[w]);
            for (int64_t i = s->wedge_start[w]; i < s->wedge_start[w + 1]; i++) {
                double *tau = symbol + qc__translation_symbol(s->term_segment[i], 0);
                const double _Complex dual = qc__turn(wedge[w], -s->term_turn[i]);
                tau[0] += creal(dual);
                tau[1] += cimag(dual);
            }
        }
        for (int32_t c = 0; c < 2 && g >= 0; c++)
            for (int64_t i = s->given_start[2 * g + c]; i < s->given_start[2 * g + c + 1]; i++)
                symbol[s->given_symbol[i]] += s->given_value[i] * (c ? cimag(given) : creal(given));
    }
}

/* --- reading a map ---------------------------------------------------------------------------- */

double _Complex qc__seams_value_at(const qc__seams *s, const qc_complex *f, int32_t v) {
    int32_t c = s->mesh->vertex_corner[v];
    while (s->corner_wedge[c] != s->vertex_wedge[v]) c = qc_corner_ccw(s->mesh, c);
    return qc__complex(f[c]);
}

/* d / (1 - i), d the shift of the chart around a pole; symbol: the translations. */
static double _Complex pole_value(const qc__seams *s, int32_t pole, const double *symbol) {
    const int32_t node = s->n_nodes - s->n_poles + pole;
    double _Complex d = 0;
    for (int64_t i = s->closing_start[node]; i < s->closing_start[node + 1]; i++) {
        const double *tau = symbol + qc__translation_symbol(s->closing_segment[i], 0);
        d += qc__turn(tau[0] + tau[1] * I, s->closing_turn[i]);
    }
    return d / (1.0 - I);
}

/* Values of the symbols in the map: positions of points, translations across segments, values of
 * poles, levels at one place. */
static void measure_symbols(const qc__seams *s, const qc_complex *f, double *symbol) {
    for (int32_t e = 0; e < s->mesh->n_edges; e++) {
        const int32_t k = s->edge_segment[e];
        if (k < 0) continue;
        const int32_t left = s->edge_left[e], right = s->mesh->twin[left];
        const double _Complex from = qc__complex(f[qc_next(left)]);
        const double _Complex tau =
            qc__complex(f[qc_prev(right)]) - qc__turn(from, s->segment_turn[k]);
        symbol[qc__translation_symbol(k, 0)] = creal(tau);
        symbol[qc__translation_symbol(k, 1)] = cimag(tau);
    }
    for (int32_t i = 0; i < s->n_cones + s->n_poles; i++) {
        const double _Complex p = i < s->n_cones ? qc__seams_value_at(s, f, s->cone_vertex[i])
                                                 : pole_value(s, i - s->n_cones, symbol);
        symbol[qc__position_symbol(s, i, 0)] = creal(p);
        symbol[qc__position_symbol(s, i, 1)] = cimag(p);
    }
    for (int32_t i = 0; i < s->n_levels; i++) {
        const int32_t x = s->level_coordinate[i];
        const double _Complex F = qc__seams_value_at(s, f, x / 2);
        symbol[qc__level_symbol(s, i)] = x % 2 ? cimag(F) : creal(F);
    }
}

static double free_value(const qc__rows *rows, int32_t y, const double *symbol) {
    double sum = 0;
    for (int64_t i = rows->start[y]; i < rows->start[y + 1]; i++)
        sum += rows->value[i] * symbol[rows->column[i]];
    return sum;
}

/* The shift w of each component (n_components, initially 0) which makes its one or two fixed
 * variables zero: Re(conj(a) w) = -y for their responses a. */
static void find_shifts(const qc__seams *s, const double *symbol, double _Complex *shift) {
    for (int32_t k = 0; k < s->n_fixed; k++) {
        const int32_t c = s->fixed_component[k], y = s->n_free + k;
        const double _Complex a = qc__seams_response(s, y), w = shift[c];
        const double missing = -free_value(&s->free_row, y, symbol) - creal(conj(a) * w);
        int32_t first = 0;
        while (s->fixed_component[first] != c) first++;
        double _Complex way = a;
        if (first < k) way = I * qc__seams_response(s, s->n_free + first);
        shift[c] = w + missing / creal(conj(a) * way) * way;
    }
}

qc_status qc__seams_read(qc_ctx *ctx, const qc__seams *s, qc_complex *f, double *y) {
    const qc_mesh *mesh = s->mesh;
    double _Complex *shift = QC__ZERO(ctx, double _Complex, mesh->n_components);
    double *symbol = QC__NEW(ctx, double, qc__seams_symbols(s));
    const bool done = shift && symbol;
    if (done) {
        measure_symbols(s, f, symbol);
        find_shifts(s, symbol, shift);
        for (int64_t c = 0; c < 3 * (int64_t)mesh->n_faces; c++)
            f[c] = qc__pair(qc__complex(f[c]) + shift[mesh->face_component[c / 3]]);
        measure_symbols(s, f, symbol);
        for (int32_t j = 0; j < s->n_free; j++) y[j] = free_value(&s->free_row, j, symbol);
    }
    qc__free(shift);
    qc__free(symbol);
    return done ? QC_OK : QC_ERR_NOMEM;
}
