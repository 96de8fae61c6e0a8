/* Free variables of a map with seams: integer elimination of the node relations (see seams.h).
 *
 * Relation at interior node n with turning R_n: sum_j i^{b_j} tau_j = (1 - i^{R_n}) p_n, every
 * translation with a unit coefficient. A spanning forest of the graph of nodes and segments, rooted
 * at the boundary where there is one, solves all relations but one a closed component: the
 * translation of the edge to the parent follows from those of the children, the other segments and
 * p_n without division. In the root's relation all coefficients are units times powers of (1 + i),
 * so the variable with the smallest power is an integer combination of the others. Last, a global
 * shift sets one variable to zero. What remains are 2g + b - 2 complex variables on a closed
 * surface with b cones, (4.1). */
#include "sdk/map/periods/seams.h"
#include <math.h>
#include <string.h>

typedef struct term {
    int32_t symbol;
    double _Complex value;
} term;

typedef struct row {
    int64_t start;
    int32_t n;
} row;

typedef struct solver {
    qc_ctx *ctx;
    qc__seams *s;
    int32_t n_symbols;
    int32_t *vertex_node;    /* node of an interior node vertex, -1 */
    int64_t *incident_start; /* segments at each vertex that ends one */
    int32_t *incident;
    int32_t *order, n_order; /* vertices of the forest, roots first */
    int32_t *parent_segment; /* n_vertices, -1 = root or unvisited */
    uint8_t *visited;
    row *rows; /* of dependent translations; n = -1: independent */
    term *terms;
    int64_t n_terms, capacity;
    double _Complex *sum; /* dense accumulator over the symbols ... */
    uint8_t *in_sum;
    int32_t *touched, n_touched;
    int32_t *dependent; /* n_components: symbol given by the root's relation, -1 */
} solver;

int32_t qc__seams_component(const qc__seams *s, int32_t symbol) {
    const int32_t v = symbol < s->n_segments ? s->segment_node[2 * symbol]
                                             : s->cone_vertex[symbol - s->n_segments];
    return s->mesh->face_component[s->mesh->vertex_corner[v] / 3];
}

/* --- sums of rows ----------------------------------------------------------------------------- */

static void sum_add(solver *q, int32_t symbol, double _Complex value) {
    if (!q->in_sum[symbol]) {
        q->in_sum[symbol] = 1;
        q->sum[symbol] = 0;
        q->touched[q->n_touched++] = symbol;
    }
    q->sum[symbol] += value;
}

static void sum_add_symbol(solver *q, int32_t symbol, double _Complex value) {
    const row r = q->rows[symbol];
    if (r.n < 0) {
        sum_add(q, symbol, value);
        return;
    }
    for (int32_t i = 0; i < r.n; i++)
        sum_add(q, q->terms[r.start + i].symbol, value * q->terms[r.start + i].value);
}

static void sum_clear(solver *q) {
    for (int32_t i = 0; i < q->n_touched; i++) q->in_sum[q->touched[i]] = 0;
    q->n_touched = 0;
}

/* Stores factor * sum, without `skip`, as the row of `symbol`. Coefficients are Gaussian
 * (half-)integers of small size, so sums which vanish do so exactly. */
static bool sum_store(solver *q, int32_t symbol, double _Complex factor, int32_t skip) {
    if (!qc__reserve(q->ctx, (void **)&q->terms, &q->capacity, q->n_terms + q->n_touched,
                     sizeof(term)))
        return false;
    row r = {q->n_terms, 0};
    for (int32_t i = 0; i < q->n_touched; i++) {
        const int32_t j = q->touched[i];
        const double _Complex value = q->sum[j];
        if (j == skip || (creal(value) == 0 && cimag(value) == 0)) continue;
        q->terms[q->n_terms++] = (term){j, factor * value};
        r.n++;
    }
    q->rows[symbol] = r;
    sum_clear(q);
    return true;
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
            const int32_t v = s->node_vertex[n], cone = s->vertex_cone[v];
            if (q->visited[v]) continue;
            if (pass == 0 && (cone < 0 || s->cone_turn[cone] % 2 == 0)) continue;
            const int32_t from = q->n_order;
            plant(q, v);
            grow_tree(q, from);
        }
}

/* --- elimination ------------------------------------------------------------------------------ */

/* sum := relation of node n (translations minus (1 - i^R) p), all but the given segment. Returns
 * the coefficient of that segment. */
static double _Complex sum_relation(solver *q, int32_t n, int32_t without) {
    const qc__seams *s = q->s;
    double _Complex left_out = 0;
    for (int64_t i = s->relation_start[n]; i < s->relation_start[n + 1]; i++) {
        const double _Complex unit = qc__turn(1.0, s->relation_turn[i]);
        if (s->relation_symbol[i] == without)
            left_out += unit;
        else
            sum_add_symbol(q, s->relation_symbol[i], unit);
    }
    const int32_t cone = s->vertex_cone[s->node_vertex[n]];
    if (cone >= 0) sum_add(q, s->n_segments + cone, qc__turn(1.0, s->cone_turn[cone]) - 1.0);
    return left_out;
}

static qc_status eliminate_forest(solver *q) {
    for (int32_t at = q->n_order - 1; at >= 0; at--) {
        const int32_t v = q->order[at], k = q->parent_segment[v];
        if (k < 0) continue;
        const double _Complex unit = sum_relation(q, q->vertex_node[v], k);
        if (!sum_store(q, k, -conj(unit), -1)) return QC_ERR_NOMEM;
    }
    return QC_OK;
}

static double norm2(double _Complex z) {
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* The relation left over at the root of a closed component gives one variable by the others: the
 * one whose coefficient, on the lattice, has the smallest power of 1 + i, i.e. the smallest norm.
 */
static qc_status eliminate_roots(solver *q) {
    const qc__seams *s = q->s;
    for (int32_t at = 0; at < q->n_order; at++) {
        const int32_t v = q->order[at], n = q->vertex_node[v];
        if (q->parent_segment[v] >= 0 || n < 0) continue;
        sum_relation(q, n, -1);
        int32_t best = -1;
        double smallest = 0;
        for (int32_t i = 0; i < q->n_touched; i++) {
            const int32_t j = q->touched[i];
            const double norm = norm2(q->sum[j] * s->scale[j]);
            if (norm == 0) continue;
            if (best < 0 || norm < smallest || (norm == smallest && j > best)) {
                best = j;
                smallest = norm;
            }
        }
        if (best < 0) {
            sum_clear(q);
            continue;
        }
        q->dependent[qc__seams_component(s, best)] = best;
        if (!sum_store(q, best, -1.0 / q->sum[best], best)) return QC_ERR_NOMEM;
    }
    return QC_OK;
}

/* Lattice of each symbol (4.2.2). */
static void choose_scales(qc__seams *s, int32_t lattice) {
    for (int32_t j = 0; j < qc__seams_symbols(s); j++) {
        double _Complex scale = 1.0;
        const bool is_cone = j >= s->n_segments;
        const int32_t turn = is_cone ? s->cone_turn[j - s->n_segments] : 0;
        if (lattice == QC_LATTICE_INTEGER && turn != 0) scale = 1.0 / (1.0 - qc__turn(1.0, turn));
        if (lattice == QC_LATTICE_EVEN) scale = !is_cone ? 2.0 : turn % 2 ? 1.0 + I : 1.0;
        s->scale[j] = scale;
    }
}

/* One variable a component which a global shift can set to zero: the one whose lattice is coarsest
 * in units of its response to the shift. */
static void choose_fixed(solver *q) {
    qc__seams *s = q->s;
    for (int32_t c = 0; c < s->mesh->n_components; c++) s->fixed_symbol[c] = -1;
    for (int32_t j = q->n_symbols - 1; j >= 0; j--) {
        const double response = norm2(qc__seams_shift(s, j) / s->scale[j]);
        if (q->rows[j].n >= 0 || response == 0) continue;
        int32_t *fixed = &s->fixed_symbol[qc__seams_component(s, j)];
        const double best =
            *fixed < 0 ? INFINITY : norm2(qc__seams_shift(s, *fixed) / s->scale[*fixed]);
        if (response < best) *fixed = j;
    }
}

/* Final rows: independent symbols stand for themselves, the dependent symbol of a root is expanded,
 * fixed symbols are dropped, and coefficients are multiplied by the scales. */
static qc_status write_rows(solver *q) {
    qc__seams *s = q->s;
    int32_t *number = QC__NEW(q->ctx, int32_t, q->n_symbols);
    s->free_symbol = QC__NEW(q->ctx, int32_t, q->n_symbols);
    s->row_start = QC__NEW(q->ctx, int64_t, q->n_symbols + 1);
    if (!number || !s->free_symbol || !s->row_start) {
        qc__free(number);
        return QC_ERR_NOMEM;
    }
    s->n_free = 0;
    for (int32_t j = 0; j < q->n_symbols; j++) {
        const bool is_free = q->rows[j].n < 0 && s->fixed_symbol[qc__seams_component(s, j)] != j;
        number[j] = is_free ? s->n_free : -1;
        if (is_free) s->free_symbol[s->n_free++] = j;
    }
    int64_t n = 0, free_capacity = 0, value_capacity = 0;
    qc_status status = QC_OK;
    for (int32_t j = 0; j < q->n_symbols && status == QC_OK; j++) {
        s->row_start[j] = n;
        const row r = q->rows[j];
        const int32_t dependent = q->dependent[qc__seams_component(s, j)];
        if (r.n < 0) sum_add(q, j, 1.0);
        for (int32_t i = 0; i < r.n; i++) {
            const term t = q->terms[r.start + i];
            if (t.symbol == dependent && j != dependent)
                sum_add_symbol(q, dependent, t.value);
            else
                sum_add(q, t.symbol, t.value);
        }
        if (!qc__reserve(q->ctx, (void **)&s->row_free, &free_capacity, n + q->n_touched,
                         sizeof *s->row_free) ||
            !qc__reserve(q->ctx, (void **)&s->row_value, &value_capacity, n + q->n_touched,
                         sizeof *s->row_value))
            status = QC_ERR_NOMEM;
        for (int32_t i = 0; i < q->n_touched && status == QC_OK; i++) {
            const int32_t f = q->touched[i];
            if (number[f] < 0 || norm2(q->sum[f]) == 0) continue;
            s->row_free[n] = number[f];
            s->row_value[n++] = q->sum[f] * s->scale[f];
        }
        sum_clear(q);
    }
    s->row_start[q->n_symbols] = n;
    qc__free(number);
    return status;
}

static void solver_free(solver *q) {
    void *const blocks[] = {
        q->vertex_node, q->incident_start, q->incident, q->order,  q->parent_segment, q->visited,
        q->rows,        q->terms,          q->sum,      q->in_sum, q->touched,        q->dependent};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
}

qc_status qc__seams_solve(qc_ctx *ctx, qc__seams *s, int32_t lattice) {
    solver q = {.ctx = ctx, .s = s, .n_symbols = qc__seams_symbols(s)};
    q.rows = QC__NEW(ctx, row, q.n_symbols);
    q.sum = QC__NEW(ctx, double _Complex, q.n_symbols);
    q.in_sum = QC__ZERO(ctx, uint8_t, q.n_symbols);
    q.touched = QC__NEW(ctx, int32_t, q.n_symbols);
    q.dependent = QC__NEW(ctx, int32_t, s->mesh->n_components);
    s->scale = QC__NEW(ctx, double _Complex, q.n_symbols);
    s->fixed_symbol = QC__NEW(ctx, int32_t, s->mesh->n_components);
    qc_status status = collect_incidence(&q);
    if (!q.rows || !q.sum || !q.in_sum || !q.touched || !q.dependent || !s->scale ||
        !s->fixed_symbol)
        status = QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t j = 0; j < q.n_symbols; j++) q.rows[j] = (row){0, -1};
        for (int32_t c = 0; c < s->mesh->n_components; c++) q.dependent[c] = -1;
        choose_scales(s, lattice);
        grow_forest(&q);
        status = eliminate_forest(&q);
    }
    if (status == QC_OK) status = eliminate_roots(&q);
    if (status == QC_OK) {
        choose_fixed(&q);
        status = write_rows(&q);
    }
    solver_free(&q);
    return status;
}
