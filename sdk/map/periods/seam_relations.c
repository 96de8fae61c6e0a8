/* Free variables of a map with seams: the relations between its symbols, solved over the integers
 * (see seams.h, relations.h).
 *
 * Relation at interior node n with turning R_n: sum_j i^{b_j} tau_j = (1 - i^{R_n}) p_n, every
 * translation with a unit coefficient. A spanning forest of the graph of nodes and segments, rooted
 * at the boundary where there is one, tells a good order: leaves first, each giving the translation
 * of the edge to its parent. What is left are the roots of closed components. Last, a global shift
 * sets up to two variables a component to zero. What remains are 2 (2g + b - 2) variables on a
 * closed surface with b cones, (4.1). */
#include <math.h>
#include <string.h>
#include "sdk/map/periods/seams.h"

typedef struct solver {
    qc_ctx *ctx;
    qc__seams *s;
    int32_t lattice;
    qc__relations *relations;
    int32_t *vertex_node;    /* node of an interior node vertex, -1 */
    int64_t *incident_start; /* segments at each vertex that ends one */
    int32_t *incident;
    int32_t *order, n_order; /* vertices of the forest, roots first */
    int32_t *parent_segment; /* n_vertices, -1 = root or unvisited */
    uint8_t *visited;
    int32_t *symbol; /* one relation */
    int64_t *value;
    int32_t n_values;
} solver;

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

/* --- the forest ------------------------------------------------------------------------------- */

static qc_status collect_incidence(solver *q) {
    const qc__seams *s = q->s;
    const int32_t nv = s->mesh->n_vertices;
    q->vertex_node = QC__NEW(q->ctx, int32_t, nv);
    q->incident_start = QC__ZERO(q->ctx, int64_t, nv + 2);
    q->incident = QC__NEW(q->ctx, int32_t, 2 * (int64_t)s->n_segments);
    q->order = QC__NEW(q->ctx, int32_t, nv);
    q->parent_segment = QC__NEW(q->ctx, int32_t, nv);
    q->visited = QC__ZERO(q->ctx, uint8_t, nv);
    if (!q->vertex_node || !q->incident_start || !q->incident || !q->order || !q->parent_segment ||
        !q->visited)
        return QC_ERR_NOMEM;
    memset(q->vertex_node, -1, sizeof(int32_t) * (size_t)nv);
    memset(q->parent_segment, -1, sizeof(int32_t) * (size_t)nv);
    for (int32_t n = 0; n < s->n_nodes; n++) q->vertex_node[s->node_vertex[n]] = n;
    for (int32_t i = 0; i < 2 * s->n_segments; i++) q->incident_start[s->segment_node[i] + 2]++;
    for (int32_t v = 0; v < nv; v++) q->incident_start[v + 2] += q->incident_start[v + 1];
    for (int32_t i = 0; i < 2 * s->n_segments; i++)
        q->incident[q->incident_start[s->segment_node[i] + 1]++] = i / 2;
    return QC_OK;
}

static void grow_tree(solver *q, int32_t from) {
    const qc__seams *s = q->s;
    for (int32_t at = from; at < q->n_order; at++) {
        const int32_t v = q->order[at];
        for (int64_t i = q->incident_start[v]; i < q->incident_start[v + 1]; i++) {
            const int32_t k = q->incident[i];
            const int32_t a = s->segment_node[2 * k], b = s->segment_node[2 * k + 1];
            const int32_t w = a == v ? b : a;
            if (q->visited[w]) continue;
            q->visited[w] = 1;
            q->parent_segment[w] = k;
            q->order[q->n_order++] = w;
        }
    }
}

static void plant(solver *q, int32_t v) {
    q->visited[v] = 1;
    q->order[q->n_order++] = v;
}

/* Roots: all boundary nodes; then, in components without, a cone of odd turning, else any node. */
static void grow_forest(solver *q) {
    const qc__seams *s = q->s;
    for (int32_t i = 0; i < 2 * s->n_segments; i++) {
        const int32_t v = s->segment_node[i];
        if (q->vertex_node[v] < 0 && !q->visited[v]) plant(q, v);
    }
    grow_tree(q, 0);
    for (int32_t pass = 0; pass < 2; pass++)
        for (int32_t n = 0; n < s->n_nodes; n++) {
            const int32_t v = s->node_vertex[n], cone = s->node_cone[n];
            if (q->visited[v]) continue;
            if (pass == 0 && (cone < 0 || s->cone_turn[cone] % 2 == 0)) continue;
            const int32_t from = q->n_order;
            plant(q, v);
            grow_tree(q, from);
        }
}

/* --- relations -------------------------------------------------------------------------------- */

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
    for (int32_t at = q->n_order - 1; at >= 0 && status == QC_OK; at--) {
        const int32_t v = q->order[at], n = q->vertex_node[v], k = q->parent_segment[v];
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

/* --- the result ------------------------------------------------------------------------------- */

/* Units go into the rows: symbols are values, free variables integers. */
static void apply_units(const solver *q) {
    qc__seams *s = q->s;
    for (int32_t j = 0; j < qc__seams_symbols(s); j++)
        for (int64_t i = s->symbol_row.start[j]; i < s->symbol_row.start[j + 1]; i++)
            s->symbol_row.value[i] *= 0.5 * (double)twice_unit(s, q->lattice, j);
    for (int64_t i = 0; i < s->free_row.start[s->n_free]; i++)
        s->free_row.value[i] *= 2 / (double)twice_unit(s, q->lattice, s->free_row.column[i]);
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
static qc_status choose_fixed(solver *q, uint8_t *fixed) {
    const qc__seams *s = q->s;
    const int32_t n = s->mesh->n_components;
    int32_t *chosen = QC__NEW(q->ctx, int32_t, n);
    double *least = QC__NEW(q->ctx, double, n);
    double _Complex *first = QC__ZERO(q->ctx, double _Complex, n);
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
static qc_status drop_fixed(solver *q, const uint8_t *fixed) {
    qc__seams *s = q->s;
    const int32_t n = s->n_free;
    int32_t *number = QC__NEW(q->ctx, int32_t, n), *old = QC__NEW(q->ctx, int32_t, n);
    const int64_t terms = s->free_row.start[n];
    qc__rows rows = {QC__NEW(q->ctx, int64_t, n + 1), QC__NEW(q->ctx, int32_t, terms),
                     QC__NEW(q->ctx, double, terms)};
    s->fixed_component = QC__NEW(q->ctx, int32_t, n);
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

static void solver_free(solver *q) {
    void *const blocks[] = {q->vertex_node,    q->incident_start, q->incident, q->order,
                            q->parent_segment, q->visited,        q->symbol,   q->value};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    qc__relations_free(q->relations);
}

qc_status qc__seams_solve(qc_ctx *ctx, qc__seams *s, int32_t lattice) {
    solver q = {.ctx = ctx, .s = s, .lattice = lattice};
    uint8_t *fixed = NULL;
    qc_status status = collect_incidence(&q);
    if (status == QC_OK) status = qc__relations_create(ctx, qc__seams_symbols(s), &q.relations);
    if (status == QC_OK) {
        grow_forest(&q);
        status = add_closings(&q);
    }
    if (status == QC_OK) status = add_level_relations(&q);
    if (status == QC_OK)
        status = qc__relations_solve(ctx, q.relations, &s->n_free, &s->symbol_row, &s->free_row);
    if (status == QC_OK) {
        apply_units(&q);
        fixed = QC__ZERO(ctx, uint8_t, s->n_free);
        status = fixed ? choose_fixed(&q, fixed) : QC_ERR_NOMEM;
    }
    if (status == QC_OK) status = drop_fixed(&q, fixed);
    qc__free(fixed);
    solver_free(&q);
    return status;
}
