/* Elimination of integer symbols and the accumulator of sums (see elimination.h). */
#include "sdk/map/seams/elimination.h"
#include <stdlib.h>

static const int64_t largest = (int64_t)1 << 40;

bool qc__elimination_grow(qc_ctx *ctx, qc__elimination *e, int32_t n) {
    const bool done =
        qc__reserve(ctx, (void **)&e->row, &e->row_capacity, n, sizeof *e->row) &&
        qc__reserve(ctx, (void **)&e->time, &e->time_capacity, n, sizeof *e->time) &&
        qc__reserve(ctx, (void **)&e->order, &e->order_capacity, n, sizeof *e->order) &&
        qc__reserve(ctx, (void **)&e->sum, &e->sum_capacity, n, sizeof *e->sum) &&
        qc__reserve(ctx, (void **)&e->in_sum, &e->in_sum_capacity, n, sizeof *e->in_sum) &&
        qc__reserve(ctx, (void **)&e->touched, &e->touched_capacity, n, sizeof *e->touched) &&
        qc__reserve(ctx, (void **)&e->heap, &e->heap_capacity, n, sizeof *e->heap);
    for (; done && e->n < n; e->n++) {
        e->row[e->n] = (qc__span){0, -1};
        e->in_sum[e->n] = 0;
    }
    return done;
}

void qc__elimination_free(qc__elimination *e) {
    void *const blocks[] = {e->row, e->time,   e->order,   e->term,
                            e->sum, e->in_sum, e->touched, e->heap};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
}

/* --- the accumulator -------------------------------------------------------------------------- */

static void push(qc__elimination *e, int32_t symbol) {
    int32_t i = e->n_heap++;
    for (; i > 0 && e->time[e->heap[(i - 1) / 2]] > e->time[symbol]; i = (i - 1) / 2)
        e->heap[i] = e->heap[(i - 1) / 2];
    e->heap[i] = symbol;
}

static int32_t pop(qc__elimination *e) {
    const int32_t first = e->heap[0], last = e->heap[--e->n_heap];
    int32_t i = 0;
    for (int32_t k = 1; k < e->n_heap; k = 2 * i + 1) {
        if (k + 1 < e->n_heap && e->time[e->heap[k + 1]] < e->time[e->heap[k]]) k++;
        if (e->time[e->heap[k]] >= e->time[last]) break;
        e->heap[i] = e->heap[k];
        i = k;
    }
    e->heap[i] = last;
    return first;
}

void qc__sum_add(qc__elimination *e, int32_t symbol, int64_t value) {
    if (!e->in_sum[symbol]) {
        e->in_sum[symbol] = 1;
        e->sum[symbol] = 0;
        e->touched[e->n_touched++] = symbol;
        if (e->row[symbol].n >= 0) push(e, symbol);
    }
    e->sum[symbol] += value;
    e->overflow |= llabs(e->sum[symbol]) > largest;
}

void qc__sum_add_row(qc__elimination *e, qc__span row, int64_t factor) {
    for (int64_t i = row.start; i < row.start + row.n; i++) {
        if (llabs(factor) * (llabs(e->term[i].value) >> 20) > largest >> 20) e->overflow = true;
        if (!e->overflow) qc__sum_add(e, e->term[i].symbol, factor * e->term[i].value);
    }
}

/* Replaces eliminated symbols, the earliest first: a row holds only symbols eliminated later. */
void qc__sum_substitute(qc__elimination *e) {
    while (e->n_heap > 0) {
        const int32_t symbol = pop(e);
        const int64_t value = e->sum[symbol];
        e->sum[symbol] = 0;
        if (value != 0) qc__sum_add_row(e, e->row[symbol], value);
    }
}

void qc__sum_clear(qc__elimination *e) {
    for (int32_t i = 0; i < e->n_touched; i++) e->in_sum[e->touched[i]] = 0;
    e->n_touched = e->n_heap = 0;
}

static int64_t gcd(int64_t a, int64_t b) {
    while (b != 0) {
        const int64_t c = a % b;
        a = b;
        b = c;
    }
    return a;
}

void qc__sum_normalise(qc__elimination *e) {
    int32_t n = 0;
    int64_t content = 0;
    for (int32_t i = 0; i < e->n_touched; i++) {
        const int32_t symbol = e->touched[i];
        if (e->sum[symbol] == 0) {
            e->in_sum[symbol] = 0;
            continue;
        }
        content = gcd(llabs(e->sum[symbol]), content);
        e->touched[n++] = symbol;
    }
    e->n_touched = n;
    for (int32_t i = 0; i < n && content > 1; i++) e->sum[e->touched[i]] /= content;
}

bool qc__terms_reserve(qc_ctx *ctx, qc__elimination *e, int64_t n) {
    return qc__reserve(ctx, (void **)&e->term, &e->term_capacity, e->n_terms + n, sizeof *e->term);
}

bool qc__sum_store(qc_ctx *ctx, qc__elimination *e, int64_t factor, int32_t skip, qc__span *out) {
    if (!qc__terms_reserve(ctx, e, e->n_touched)) return false;
    qc__span row = {e->n_terms, 0};
    for (int32_t i = 0; i < e->n_touched; i++) {
        const int32_t symbol = e->touched[i];
        if (symbol == skip || e->sum[symbol] == 0) continue;
        e->term[e->n_terms++] = (qc__term){symbol, factor * e->sum[symbol]};
        row.n++;
    }
    *out = row;
    return true;
}

int32_t qc__sum_unit(const qc__elimination *e, int32_t prefer) {
    int32_t best = -1;
    for (int32_t i = 0; i < e->n_touched; i++) {
        const int32_t symbol = e->touched[i];
        if (llabs(e->sum[symbol]) != 1) continue;
        if (symbol == prefer) return symbol;
        if (symbol > best) best = symbol;
    }
    return best;
}

/* --- elimination ------------------------------------------------------------------------------ */

void qc__eliminate(qc__elimination *e, int32_t symbol, qc__span row) {
    e->row[symbol] = row;
    e->time[symbol] = e->n_done;
    e->order[e->n_done++] = symbol;
}

bool qc__sum_eliminate(qc_ctx *ctx, qc__elimination *e, int32_t unit) {
    qc__span row;
    if (!qc__sum_store(ctx, e, -e->sum[unit], unit, &row)) return false;
    qc__eliminate(e, unit, row);
    return true;
}

/* The last row first. */
bool qc__elimination_expand(qc_ctx *ctx, qc__elimination *e) {
    for (int32_t i = e->n_done - 1; i >= 0 && !e->overflow; i--) {
        const int32_t symbol = e->order[i];
        const qc__span row = e->row[symbol];
        bool known = true;
        for (int64_t k = row.start; k < row.start + row.n; k++)
            known &= e->row[e->term[k].symbol].n < 0;
        if (known) continue;
        qc__sum_add_row(e, row, 1);
        qc__sum_substitute(e);
        qc__span full;
        const bool done = qc__sum_store(ctx, e, 1, -1, &full);
        qc__sum_clear(e);
        if (!done) return false;
        e->row[symbol] = full;
    }
    return true;
}
