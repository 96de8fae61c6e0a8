/* Integer relations (see relations.h): those with a unit coefficient eliminate a symbol at once,
 * the others when all are known. */
#include "sdk/map/seams/relations.h"
#include <stdlib.h>
#include "sdk/map/seams/elimination.h"

struct qc__relations {
    int32_t n_given;   /* symbols as given; new ones follow them */
    qc__elimination e; /* of all symbols */
    qc__span *meaning; /* of new symbols, by given ones */
    int64_t meaning_capacity;
    qc__span *waiting; /* relations without a coefficient +-1 */
    int64_t n_waiting, waiting_capacity;
};

void qc__relations_free(qc__relations *r) {
    if (!r) return;
    qc__elimination_free(&r->e);
    qc__free(r->meaning);
    qc__free(r->waiting);
    qc__free(r);
}

void qc__rows_free(qc__rows *rows) {
    qc__free(rows->start);
    qc__free(rows->column);
    qc__free(rows->value);
    *rows = (qc__rows){NULL, NULL, NULL};
}

static bool grow(qc_ctx *ctx, qc__relations *r, int32_t n) {
    const int32_t before = r->e.n;
    if (!qc__reserve(ctx, (void **)&r->meaning, &r->meaning_capacity, n, sizeof *r->meaning) ||
        !qc__elimination_grow(ctx, &r->e, n))
        return false;
    for (int32_t j = before; j < n; j++) r->meaning[j] = (qc__span){0, -1};
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

static qc_status too_large(qc_ctx *ctx) {
    return qc__fail(
        ctx, QC_ERR_FAILED, -1,
        "the relations between the periods have coefficients beyond 2^40; the cut graph "
        "of this surface is too entangled");
}

qc_status qc__relations_add(qc_ctx *ctx, qc__relations *r, int32_t n, const int32_t *symbol,
                            const int64_t *value, int32_t prefer, int32_t *pivot) {
    qc__elimination *e = &r->e;
    for (int32_t i = 0; i < n; i++) qc__sum_add(e, symbol[i], value[i]);
    qc__sum_substitute(e);
    qc__sum_normalise(e);
    const int32_t unit = qc__sum_unit(e, prefer);
    bool done = true;
    if (e->overflow) {
        qc__sum_clear(e);
        return too_large(ctx);
    }
    if (unit >= 0) {
        done = qc__sum_eliminate(ctx, e, unit);
    } else if (e->n_touched > 0) {
        qc__span row;
        done = qc__reserve(ctx, (void **)&r->waiting, &r->waiting_capacity, r->n_waiting + 1,
                           sizeof *r->waiting) &&
               qc__sum_store(ctx, e, 1, -1, &row);
        if (done) r->waiting[r->n_waiting++] = row;
    }
    qc__sum_clear(e);
    if (pivot) *pivot = unit;
    return done ? QC_OK : QC_ERR_NOMEM;
}

static int64_t nearest_quotient(int64_t a, int64_t b) { /* b > 0 */
    const int64_t q = a / b, rest = a % b;
    return 2 * rest > b ? q + 1 : 2 * rest < -b ? q - 1 : q;
}

/* t = s_p + sum q_j s_j by given symbols, so that its value can be measured. */
static bool store_meaning(qc_ctx *ctx, qc__relations *r, const qc__term *definition, int32_t n,
                          int32_t symbol) {
    qc__elimination *e = &r->e;
    qc__span row = {e->n_terms, 0};
    int64_t room = n;
    for (int32_t i = 0; i < n; i++)
        if (r->meaning[definition[i].symbol].n > 0) room += r->meaning[definition[i].symbol].n;
    if (!qc__terms_reserve(ctx, e, room)) return false;
    for (int32_t i = 0; i < n; i++) {
        const qc__span known = r->meaning[definition[i].symbol];
        if (known.n < 0) e->term[row.start + row.n++] = definition[i];
        for (int32_t k = 0; k < known.n; k++) {
            const qc__term t = e->term[known.start + k];
            e->term[row.start + row.n++] = (qc__term){t.symbol, t.value * definition[i].value};
        }
    }
    e->n_terms += row.n;
    r->meaning[symbol] = row;
    return true;
}

/* One change of variables on the relation in the sum: the remainders modulo its smallest
 * coefficient are left, that coefficient passing to a new symbol. */
static bool reduce(qc_ctx *ctx, qc__relations *r) {
    qc__elimination *e = &r->e;
    int32_t p = e->touched[0];
    for (int32_t i = 1; i < e->n_touched; i++) {
        const int32_t j = e->touched[i];
        const int64_t a = llabs(e->sum[j]), b = llabs(e->sum[p]);
        if (a < b || (a == b && j > p)) p = j;
    }
    const int32_t fresh = e->n;
    qc__term *definition = QC__NEW(ctx, qc__term, e->n_touched);
    bool done = definition && grow(ctx, r, fresh + 1) && qc__terms_reserve(ctx, e, e->n_touched);
    if (done) {
        const int64_t m = llabs(e->sum[p]), sign = e->sum[p] < 0 ? -1 : 1;
        qc__span row = {e->n_terms, 0};
        int32_t n = 0;
        e->term[row.start + row.n++] = (qc__term){fresh, 1};
        definition[n++] = (qc__term){p, 1};
        for (int32_t i = 0; i < e->n_touched; i++) {
            const int32_t j = e->touched[i];
            const int64_t q = j == p ? 0 : nearest_quotient(sign * e->sum[j], m);
            if (q == 0) continue;
            e->term[row.start + row.n++] = (qc__term){j, -q};
            definition[n++] = (qc__term){j, q};
            e->sum[j] -= sign * q * m;
        }
        e->n_terms += row.n;
        qc__sum_add(e, fresh, e->sum[p]);
        e->sum[p] = 0;
        qc__eliminate(e, p, row);
        done = store_meaning(ctx, r, definition, n, fresh);
        qc__sum_normalise(e);
    }
    qc__free(definition);
    return done;
}

static qc_status solve_waiting(qc_ctx *ctx, qc__relations *r) {
    qc__elimination *e = &r->e;
    for (int64_t i = 0; i < r->n_waiting; i++) {
        qc__sum_add_row(e, r->waiting[i], 1);
        qc__sum_substitute(e);
        qc__sum_normalise(e);
        bool done = true;
        while (done && !e->overflow && e->n_touched > 0 && qc__sum_unit(e, -1) < 0)
            done = reduce(ctx, r);
        if (done && !e->overflow && e->n_touched > 0)
            done = qc__sum_eliminate(ctx, e, qc__sum_unit(e, -1));
        qc__sum_clear(e);
        if (e->overflow) return too_large(ctx);
        if (!done) return QC_ERR_NOMEM;
    }
    r->n_waiting = 0;
    return QC_OK;
}

static qc_status write_rows(qc_ctx *ctx, const qc__relations *r, const int32_t *number, bool back,
                            int32_t n_rows, qc__rows *out) {
    const qc__elimination *e = &r->e;
    int64_t n = 0;
    for (int32_t j = 0; j < e->n; j++) {
        const qc__span row = back ? r->meaning[j] : e->row[j];
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
    for (int32_t j = 0; j < e->n; j++) {
        const qc__span row = back ? r->meaning[j] : e->row[j];
        if (back ? number[j] < 0 : j >= r->n_given) continue;
        rows.start[k++] = n;
        if (row.n < 0) {
            rows.column[n] = back ? j : number[j];
            rows.value[n++] = 1;
        }
        for (int64_t i = row.start; i < row.start + row.n; i++) {
            rows.column[n] = back ? e->term[i].symbol : number[e->term[i].symbol];
            rows.value[n++] = (double)e->term[i].value;
        }
    }
    rows.start[k] = n;
    *out = rows;
    return QC_OK;
}

qc_status qc__relations_solve(qc_ctx *ctx, qc__relations *r, int32_t *n_free, qc__rows *symbol,
                              qc__rows *free_integer) {
    qc__elimination *e = &r->e;
    qc_status status = solve_waiting(ctx, r);
    if (status == QC_OK && !qc__elimination_expand(ctx, e)) status = QC_ERR_NOMEM;
    if (status == QC_OK && e->overflow) status = too_large(ctx);
    if (status != QC_OK) return status;
    int32_t *number = QC__NEW(ctx, int32_t, e->n);
    if (!number) return QC_ERR_NOMEM;
    int32_t n = 0;
    for (int32_t j = 0; j < e->n; j++) number[j] = e->row[j].n < 0 ? n++ : -1;
    status = write_rows(ctx, r, number, false, r->n_given, symbol);
    if (status == QC_OK) {
        status = write_rows(ctx, r, number, true, n, free_integer);
        if (status != QC_OK) qc__rows_free(symbol);
    }
    if (status == QC_OK) *n_free = n;
    qc__free(number);
    return status;
}
