/* Free variables of a map with seams: the relations between its symbols, solved over the integers
 * (see seams.h, relations.h).
 *
 * Relation at interior node n with turning R_n: sum_j i^{b_j} tau_j = (1 - i^{R_n}) p_n, every
 * translation with a unit coefficient. A spanning forest of the graph of nodes and segments, rooted
 * at the boundary where there is one, tells a good order: leaves first, each giving the translation
 * of the edge to its parent. What is left are the roots of closed components. Last, a global shift
 * sets up to two variables a component to zero. What remains are 2 (2g + b - 2) variables on a
 * closed surface with b cones, (4.1). */
#include "sdk/map/seams/seam_solve.h"

typedef struct solver {
    qc_ctx *ctx;
    qc__seams *s;
    int32_t lattice;
    qc__relations *relations;
    qc__seam_forest forest;
    int32_t *symbol; /* one relation */
    int64_t *value;
    int32_t n_values;
} solver;

/* Symbols are integers times 1/2, 1 or 2 (4.2.2): the position of a cone is a multiple of 1/2 where
 * translations may be any integers, and translations are even where that is asked for. Which of
 * these multiples can be is left to the relations. */
static int64_t twice_unit(const qc__seams *s, int32_t lattice, int32_t symbol) {
    const int32_t j = symbol / 2;
    if (symbol >= qc__level_symbol(s, 0)) return 2;
    if (j < s->n_segments) return lattice == QC_LATTICE_EVEN ? 4 : 2;
    return lattice == QC_LATTICE_INTEGER && s->cone_turn[j - s->n_segments] != 0 ? 1 : 2;
}

/* Part `part` of value * i^turn * the symbols 2 j, 2 j + 1. */
static void append(solver *q, int32_t j, int32_t turn, int32_t part, int64_t value) {
    const int32_t symbol = 2 * j + ((part + turn) & 1);
    const double _Complex unit = qc__turn(symbol % 2 ? I : 1.0, turn);
    const int64_t sign = (part == 0 ? creal(unit) : cimag(unit)) < 0 ? -1 : 1;
    q->symbol[q->n_values] = symbol;
    q->value[q->n_values++] = sign * value * twice_unit(q->s, q->lattice, symbol);
}

/* One part of the relation of node n. */
static qc_status add_closing(solver *q, int32_t n, int32_t part, int32_t prefer, int32_t *pivot) {
    const qc__seams *s = q->s;
    const int32_t cone = s->node_cone[n];
    q->n_values = 0;
    for (int64_t i = s->closing_start[n]; i < s->closing_start[n + 1]; i++)
        append(q, s->closing_segment[i], s->closing_turn[i], part, 1);
    if (cone >= 0) {
        append(q, s->n_segments + cone, s->cone_turn[cone], part, 1);
        append(q, s->n_segments + cone, 0, part, -1);
    }
    return qc__relations_add(q->ctx, q->relations, q->n_values, q->symbol, q->value, prefer, pivot);
}

/* Symbol of segment k which the relation of node n has in one part. */
static int32_t symbol_of_segment(const qc__seams *s, int32_t n, int32_t k, int32_t part) {
    for (int64_t i = s->closing_start[n]; i < s->closing_start[n + 1]; i++)
        if (s->closing_segment[i] == k)
            return qc__translation_symbol(k, (part + s->closing_turn[i]) & 1);
    return -1;
}

/* Leaves give the translation to their parent; roots of closed components any symbol, both parts of
 * one where that can be. */
static qc_status add_closings(solver *q) {
    const qc__seams *s = q->s;
    int64_t most = 0;
    for (int32_t n = 0; n < s->n_nodes; n++)
        if (s->closing_start[n + 1] - s->closing_start[n] > most)
            most = s->closing_start[n + 1] - s->closing_start[n];
    q->symbol = QC__NEW(q->ctx, int32_t, most + 2);
    q->value = QC__NEW(q->ctx, int64_t, most + 2);
    if (!q->symbol || !q->value) return QC_ERR_NOMEM;
    qc_status status = QC_OK;
    for (int32_t at = q->forest.n_order - 1; at >= 0 && status == QC_OK; at--) {
        const int32_t v = q->forest.order[at], n = q->forest.vertex_node[v],
                      k = q->forest.parent_segment[v];
        int32_t pivot = -1;
        for (int32_t part = 0; part < 2 && n >= 0 && status == QC_OK; part++) {
            const int32_t prefer = k >= 0       ? symbol_of_segment(s, n, k, part)
                                   : pivot >= 0 ? pivot ^ 1
                                                : -1;
            status = add_closing(q, n, part, prefer, &pivot);
        }
    }
    return status;
}

/* What features ask for: levels which end in points, come back or meet. */
static qc_status add_level_relations(solver *q) {
    const qc__seams *s = q->s;
    qc_status status = QC_OK;
    for (int32_t k = 0; k < s->n_level_relations && status == QC_OK; k++) {
        const int64_t start = s->level_relation_start[k], end = s->level_relation_start[k + 1];
        int64_t *value = QC__NEW(q->ctx, int64_t, end - start);
        if (!value) return QC_ERR_NOMEM;
        for (int64_t i = start; i < end; i++)
            value[i - start] =
                s->level_relation_value[i] * twice_unit(s, q->lattice, s->level_relation_symbol[i]);
        status = qc__relations_add(q->ctx, q->relations, (int32_t)(end - start),
                                   s->level_relation_symbol + start, value, -1, NULL);
        qc__free(value);
    }
    return status;
}

/* Units go into the rows: symbols are values, free variables integers. */
static void apply_units(const solver *q) {
    qc__seams *s = q->s;
    for (int32_t j = 0; j < qc__seams_symbols(s); j++)
        for (int64_t i = s->symbol_row.start[j]; i < s->symbol_row.start[j + 1]; i++)
            s->symbol_row.value[i] *= 0.5 * (double)twice_unit(s, q->lattice, j);
    for (int64_t i = 0; i < s->free_row.start[s->n_free]; i++)
        s->free_row.value[i] *= 2 / (double)twice_unit(s, q->lattice, s->free_row.column[i]);
}

qc_status qc__seams_solve(qc_ctx *ctx, qc__seams *s, int32_t lattice) {
    solver q = {.ctx = ctx, .s = s, .lattice = lattice};
    qc_status status = qc__seam_forest_create(ctx, s, &q.forest);
    if (status == QC_OK) status = qc__relations_create(ctx, qc__seams_symbols(s), &q.relations);
    if (status == QC_OK) status = add_closings(&q);
    if (status == QC_OK) status = add_level_relations(&q);
    if (status == QC_OK)
        status = qc__relations_solve(ctx, q.relations, &s->n_free, &s->symbol_row, &s->free_row);
    if (status == QC_OK) {
        apply_units(&q);
        status = qc__seams_fix_gauge(ctx, s);
    }
    qc__seam_forest_free(&q.forest);
    qc__relations_free(q.relations);
    qc__free(q.symbol);
    qc__free(q.value);
    return status;
}
