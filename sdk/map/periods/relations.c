/* Elimination of integer relations (see relations.h). */
#include "sdk/map/periods/relations.h"
#include <stdlib.h>
#include <string.h>

static const int64_t largest = (int64_t)1 << 40;

typedef struct span { /* a row of `term`; n = -1: there is none */
    int64_t start;
    int32_t n;
} span;

typedef struct term {
    int32_t symbol;
    int64_t value;
} term;

struct qc__relations {
    int32_t n_given, n; /* symbols: as given, with the new ones */
    span *row;          /* of eliminated symbols; their terms are eliminated later, if at all */
    span *meaning;      /* of new symbols, by given ones */
    int32_t *time;      /* of elimination */
    int64_t row_capacity, meaning_capacity, time_capacity;
    int32_t *order, n_order; /* eliminated symbols, earliest first */
    int64_t order_capacity;
    term *term;
    int64_t n_terms, term_capacity;
    span *waiting; /* relations without a coefficient +-1 */
    int64_t n_waiting, waiting_capacity;
    int64_t *sum; /* dense accumulator ... */
    uint8_t *in_sum;
    int32_t *touched, n_touched; /* ... and the symbols in it */
    int64_t sum_capacity, in_sum_capacity, touched_capacity;
    int32_t *heap, n_heap; /* eliminated symbols in the sum, by time */
    int64_t heap_capacity;
    bool overflow;
};

void qc__relations_free(qc__relations *r) {
    if (!r) return;
    void *const blocks[] = {r->row, r->meaning, r->time,   r->order,   r->term,
                            r->sum, r->waiting, r->in_sum, r->touched, r->heap};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    qc__free(r);
}

void qc__rows_free(qc__rows *rows) {
    qc__free(rows->start);
    qc__free(rows->column);
    qc__free(rows->value);
    *rows = (qc__rows){NULL, NULL, NULL};
}

static bool grow(qc_ctx *ctx, qc__relations *r, int32_t n) {
    const bool done =
        qc__reserve(ctx, (void **)&r->row, &r->row_capacity, n, sizeof *r->row) &&
        qc__reserve(ctx, (void **)&r->meaning, &r->meaning_capacity, n, sizeof *r->meaning) &&
        qc__reserve(ctx, (void **)&r->time, &r->time_capacity, n, sizeof *r->time) &&
        qc__reserve(ctx, (void **)&r->order, &r->order_capacity, n, sizeof *r->order) &&
        qc__reserve(ctx, (void **)&r->sum, &r->sum_capacity, n, sizeof *r->sum) &&
        qc__reserve(ctx, (void **)&r->in_sum, &r->in_sum_capacity, n, sizeof *r->in_sum) &&
        qc__reserve(ctx, (void **)&r->touched, &r->touched_capacity, n, sizeof *r->touched) &&
        qc__reserve(ctx, (void **)&r->heap, &r->heap_capacity, n, sizeof *r->heap);
    if (!done) return false;
    for (; r->n < n; r->n++) {
        r->row[r->n] = r->meaning[r->n] = (span){0, -1};
        r->in_sum[r->n] = 0;
    }
    return true;
}

qc_status qc__relations_create(qc_ctx *ctx, int32_t n_symbols, qc__relations **out) {
    qc__relations *r = QC__ZERO(ctx, qc__relations, 1);
    if (!r) return QC_ERR_NOMEM;
    r->n_given = n_symbols;
    if (!grow(ctx, r, n_symbols)) {
        qc__relations_free(r);
        return QC_ERR_NOMEM;
    }
    *out = r;
    return QC_OK;
}

/* --- the accumulator -------------------------------------------------------------------------- */

static void push(qc__relations *r, int32_t symbol) {
    int32_t i = r->n_heap++;
    for (; i > 0 && r->time[r->heap[(i - 1) / 2]] > r->time[symbol]; i = (i - 1) / 2)
        r->heap[i] = r->heap[(i - 1) / 2];
    r->heap[i] = symbol;
}

static int32_t pop(qc__relations *r) {
    const int32_t first = r->heap[0], last = r->heap[--r->n_heap];
    int32_t i = 0;
    for (int32_t k = 1; k < r->n_heap; k = 2 * i + 1) {
        if (k + 1 < r->n_heap && r->time[r->heap[k + 1]] < r->time[r->heap[k]]) k++;
        if (r->time[r->heap[k]] >= r->time[last]) break;
        r->heap[i] = r->heap[k];
        i = k;
    }
    r->heap[i] = last;
    return first;
}

static void add(qc__relations *r, int32_t symbol, int64_t value) {
    if (!r->in_sum[symbol]) {
        r->in_sum[symbol] = 1;
        r->sum[symbol] = 0;
        r->touched[r->n_touched++] = symbol;
        if (r->row[symbol].n >= 0) push(r, symbol);
    }
    r->sum[symbol] += value;
    r->overflow |= llabs(r->sum[symbol]) > largest;
}

static void add_row(qc__relations *r, span row, int64_t factor) {
    for (int64_t i = row.start; i < row.start + row.n; i++) {
        if (llabs(factor) * (llabs(r->term[i].value) >> 20) > largest >> 20) r->overflow = true;
        if (!r->overflow) add(r, r->term[i].symbol, factor * r->term[i].value);
    }
}

/* Replaces eliminated symbols, the earliest first: a row holds only symbols eliminated later. */
static void substitute(qc__relations *r) {
    while (r->n_heap > 0) {
        const int32_t symbol = pop(r);
        const int64_t value = r->sum[symbol];
        r->sum[symbol] = 0;
        if (value != 0) add_row(r, r->row[symbol], value);
    }
}

static void clear(qc__relations *r) {
    for (int32_t i = 0; i < r->n_touched; i++) r->in_sum[r->touched[i]] = 0;
    r->n_touched = r->n_heap = 0;
}

static int64_t gcd(int64_t a, int64_t b) {
    while (b != 0) {
        const int64_t c = a % b;
        a = b;
        b = c;
    }
    return a;
}

/* Drops zeros, sorts and divides by the content. */
static void normalise(qc__relations *r) {
    int32_t n = 0;
    int64_t content = 0;
    for (int32_t i = 0; i < r->n_touched; i++) {
        const int32_t symbol = r->touched[i];
        if (r->sum[symbol] == 0) {
            r->in_sum[symbol] = 0;
            continue;
        }
        content = gcd(llabs(r->sum[symbol]), content);
        r->touched[n++] = symbol;
    }
    r->n_touched = n;
    for (int32_t i = 0; i < n && content > 1; i++) r->sum[r->touched[i]] /= content;
}

/* Stores factor * sum without `skip`. */
static bool store(qc_ctx *ctx, qc__relations *r, int64_t factor, int32_t skip, span *out) {
    if (!qc__reserve(ctx, (void **)&r->term, &r->term_capacity, r->n_terms + r->n_touched,
                     sizeof(term)))
        return false;
    span row = {r->n_terms, 0};
    for (int32_t i = 0; i < r->n_touched; i++) {
        const int32_t symbol = r->touched[i];
        if (symbol == skip || r->sum[symbol] == 0) continue;
        r->term[r->n_terms++] = (term){symbol, factor * r->sum[symbol]};
        row.n++;
    }
    *out = row;
    return true;
}

static void eliminate(qc__relations *r, int32_t symbol, span row) {
    r->row[symbol] = row;
    r->time[symbol] = r->n_order;
    r->order[r->n_order++] = symbol;
}

/* --- relations -------------------------------------------------------------------------------- */

static int32_t find_unit(const qc__relations *r, int32_t prefer) {
    int32_t best = -1;
    for (int32_t i = 0; i < r->n_touched; i++) {
        const int32_t symbol = r->touched[i];
        if (llabs(r->sum[symbol]) != 1) continue;
        if (symbol == prefer) return symbol;
        if (symbol > best) best = symbol;
    }
    return best;
}

static qc_status too_large(qc_ctx *ctx) {
    return qc__fail(
        ctx, QC_ERR_FAILED, -1,
        "the relations between the periods have coefficients beyond 2^40; the cut graph "
        "of this surface is too entangled");
}

qc_status qc__relations_add(qc_ctx *ctx, qc__relations *r, int32_t n, const int32_t *symbol,
                            const int64_t *value, int32_t prefer, int32_t *pivot) {
    for (int32_t i = 0; i < n; i++) add(r, symbol[i], value[i]);
    substitute(r);
    normalise(r);
    const int32_t unit = find_unit(r, prefer);
    bool done = true;
    span row = {0, 0};
    if (r->overflow) {
        clear(r);
        return too_large(ctx);
    }
    if (unit >= 0) {
        done = store(ctx, r, -r->sum[unit], unit, &row);
        if (done) eliminate(r, unit, row);
    } else if (r->n_touched > 0) {
        done = qc__reserve(ctx, (void **)&r->waiting, &r->waiting_capacity, r->n_waiting + 1,
                           sizeof *r->waiting) &&
               store(ctx, r, 1, -1, &row);
        if (done) r->waiting[r->n_waiting++] = row;
    }
    clear(r);
    if (pivot) *pivot = unit;
    return done ? QC_OK : QC_ERR_NOMEM;
}

static int64_t nearest_quotient(int64_t a, int64_t b) { /* b > 0 */
    const int64_t q = a / b, rest = a % b;
    return 2 * rest > b ? q + 1 : 2 * rest < -b ? q - 1 : q;
}

/* t = s_p + sum q_j s_j by given symbols, so that its value can be measured. */
static bool store_meaning(qc_ctx *ctx, qc__relations *r, const term *definition, int32_t n,
                          int32_t symbol) {
    span row = {r->n_terms, 0};
    int64_t room = n;
    for (int32_t i = 0; i < n; i++)
        if (r->meaning[definition[i].symbol].n > 0) room += r->meaning[definition[i].symbol].n;
    if (!qc__reserve(ctx, (void **)&r->term, &r->term_capacity, r->n_terms + room, sizeof(term)))
        return false;
    for (int32_t i = 0; i < n; i++) {
        const span known = r->meaning[definition[i].symbol];
        if (known.n < 0) r->term[row.start + row.n++] = definition[i];
        for (int32_t k = 0; k < known.n; k++) {
            const term t = r->term[known.start + k];
            r->term[row.start + row.n++] = (term){t.symbol, t.value * definition[i].value};
        }
    }
    r->n_terms += row.n;
    r->meaning[symbol] = row;
    return true;
}

/* One change of variables on the relation in the sum: the remainders modulo its smallest
 * coefficient are left, that coefficient passing to a new symbol. */
static bool reduce(qc_ctx *ctx, qc__relations *r) {
    int32_t p = r->touched[0];
    for (int32_t i = 1; i < r->n_touched; i++) {
        const int32_t j = r->touched[i];
        const int64_t a = llabs(r->sum[j]), b = llabs(r->sum[p]);
        if (a < b || (a == b && j > p)) p = j;
    }
    const int32_t fresh = r->n;
    term *definition = QC__NEW(ctx, term, r->n_touched);
    bool done = definition && grow(ctx, r, fresh + 1) &&
                qc__reserve(ctx, (void **)&r->term, &r->term_capacity, r->n_terms + r->n_touched,
                            sizeof(term));
    if (done) {
        const int64_t m = llabs(r->sum[p]), sign = r->sum[p] < 0 ? -1 : 1;
        span row = {r->n_terms, 0};
        int32_t n = 0;
        r->term[row.start + row.n++] = (term){fresh, 1};
        definition[n++] = (term){p, 1};
        for (int32_t i = 0; i < r->n_touched; i++) {
            const int32_t j = r->touched[i];
            const int64_t q = j == p ? 0 : nearest_quotient(sign * r->sum[j], m);
            if (q == 0) continue;
            r->term[row.start + row.n++] = (term){j, -q};
            definition[n++] = (term){j, q};
            r->sum[j] -= sign * q * m;
        }
        r->n_terms += row.n;
        add(r, fresh, r->sum[p]);
        r->sum[p] = 0;
        eliminate(r, p, row);
        done = store_meaning(ctx, r, definition, n, fresh);
        normalise(r);
    }
    qc__free(definition);
    return done;
}

static qc_status solve_waiting(qc_ctx *ctx, qc__relations *r) {
    for (int64_t i = 0; i < r->n_waiting; i++) {
        add_row(r, r->waiting[i], 1);
        substitute(r);
        normalise(r);
        bool done = true;
        while (done && !r->overflow && r->n_touched > 0 && find_unit(r, -1) < 0)
            done = reduce(ctx, r);
        if (done && !r->overflow && r->n_touched > 0) {
            const int32_t unit = find_unit(r, -1);
            span row;
            done = store(ctx, r, -r->sum[unit], unit, &row);
            if (done) eliminate(r, unit, row);
        }
        clear(r);
        if (r->overflow) return too_large(ctx);
        if (!done) return QC_ERR_NOMEM;
    }
    r->n_waiting = 0;
    return QC_OK;
}

/* Rows of eliminated symbols by free ones only, the last first. */
static qc_status expand(qc_ctx *ctx, qc__relations *r) {
    for (int32_t i = r->n_order - 1; i >= 0; i--) {
        const int32_t symbol = r->order[i];
        const span row = r->row[symbol];
        bool known = true;
        for (int64_t k = row.start; k < row.start + row.n; k++)
            known &= r->row[r->term[k].symbol].n < 0;
        if (known) continue;
        add_row(r, row, 1);
        substitute(r);
        span full;
        const bool done = store(ctx, r, 1, -1, &full);
        clear(r);
        if (r->overflow) return too_large(ctx);
        if (!done) return QC_ERR_NOMEM;
        r->row[symbol] = full;
    }
    return QC_OK;
}

static qc_status write_rows(qc_ctx *ctx, const qc__relations *r, const int32_t *number, bool back,
                            int32_t n_rows, qc__rows *out) {
    int64_t n = 0;
    for (int32_t j = 0; j < r->n; j++) {
        const span row = back ? r->meaning[j] : r->row[j];
        if (back ? number[j] >= 0 : j < r->n_given) n += row.n < 0 ? 1 : row.n;
    }
    qc__rows rows = {QC__NEW(ctx, int64_t, n_rows + 1), QC__NEW(ctx, int32_t, n),
                     QC__NEW(ctx, double, n)};
    if (!rows.start || !rows.column || !rows.value) {
        qc__rows_free(&rows);
        return QC_ERR_NOMEM;
    }
    n = 0;
    int32_t k = 0;
    for (int32_t j = 0; j < r->n; j++) {
        const span row = back ? r->meaning[j] : r->row[j];
        if (back ? number[j] < 0 : j >= r->n_given) continue;
        rows.start[k++] = n;
        if (row.n < 0) {
            rows.column[n] = back ? j : number[j];
            rows.value[n++] = 1;
        }
        for (int64_t i = row.start; i < row.start + row.n; i++) {
            rows.column[n] = back ? r->term[i].symbol : number[r->term[i].symbol];
            rows.value[n++] = (double)r->term[i].value;
        }
    }
    rows.start[k] = n;
    *out = rows;
    return QC_OK;
}

qc_status qc__relations_solve(qc_ctx *ctx, qc__relations *r, int32_t *n_free, qc__rows *symbol,
                              qc__rows *free_integer) {
    qc_status status = solve_waiting(ctx, r);
    if (status == QC_OK) status = expand(ctx, r);
    if (status != QC_OK) return status;
    int32_t *number = QC__NEW(ctx, int32_t, r->n);
    if (!number) return QC_ERR_NOMEM;
    int32_t n = 0;
    for (int32_t j = 0; j < r->n; j++) number[j] = r->row[j].n < 0 ? n++ : -1;
    status = write_rows(ctx, r, number, false, r->n_given, symbol);
    if (status == QC_OK) {
        status = write_rows(ctx, r, number, true, n, free_integer);
        if (status != QC_OK) qc__rows_free(symbol);
    }
    if (status == QC_OK) *n_free = n;
    qc__free(number);
    return status;
}
