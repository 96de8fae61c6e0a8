/* One front of the sweep for A + sum sigma_q w_q w_q^H and for the forward solution which goes with
 * it (theory S.7, S.10, S.11). The columns go in blocks: the diagonal block gives the multipliers
 * of every column and vector; then the rows below are independent, and a tile of them keeps its
 * part of the vectors in registers through all columns of the block. Vectors go in pairs, so that
 * an entry of L is read and written once for two of them; further pairs find the tile in the
 * first-level cache. Old entries are copied to the journal in the order in which they are read. */
#include <float.h>
#include "sdk/sparse/kernels/update_tile.h"

enum { GROUPS = 4, BLOCK = GROUPS * LANES / NC };

/* Pivot d under the vector entry p = (re, im), (S.7): m gets p, b. A pivot which stays as it is
 * cannot fail. */
QC__INLINE bool change_pivot(double re, double im, double floor, double *d, double *a, double *m) {
    const double old = *d, changed = old + *a * (re * re + im * im), scale = *a / changed;
    set(m, re, im);
    set(m + 3, scale * re, -scale * im);
    *a = v_if_equal(changed, old, *a, *a * (old / changed));
    *d = changed;
    return (changed == old) | ((changed > floor) & (changed <= DBL_MAX));
}

/* y - c x and y + c x for c = re + i im, the two spread */
QC__INLINE vec subtract_product(vec y, vec re, vec im, vec x) {
    y = v_fnma(re, x, y);
    return NC == 1 ? y : v_fnma(im, v_times_i(x), y);
}
QC__INLINE vec add_product(vec y, vec re, vec im, vec x) {
    y = v_fma(re, x, y);
    return NC == 1 ? y : v_fma(im, v_times_i(x), y);
}

/* The diagonal block of the columns [begin, end), whose rows are G vectors, under the vector q,
 * which stays in registers; m: its multipliers, `step` apart. One vector at a time keeps the chain
 * of operations short. Old entries go to `journal` unless that is NULL. Returns -1 or the column
 * whose pivot fails: then all columns before it have changed. */
QC__INLINE int32_t update_block(const qc__update_front *f, int64_t begin, int64_t end, int32_t q,
                                double *m, int64_t step, double *journal, const int G) {
    const int64_t last = NC * (end - begin) - (G - 1) * LANES, ld = NC * f->r;
    const double *diagonal = f->diagonal, relative = f->floor;
    double *x = f->panel + NC * (begin * f->r + begin), *D = f->D;
    double a = *f->a[q];
    vec v[GROUPS];
    for (int g = 0; g < G; g++) v[g] = get(f->vector[q] + NC * begin, g, G, true, last);
    int64_t column = begin;
    for (int t = 0; t < G; t++) {
        const int64_t lanes = t == G - 1 ? last : LANES;
        for (int64_t lane = 0; lane < lanes; lane += NC, column++) {
            const vec pr = v_spread(v[t], (int)lane);
            const vec pi = NC == 2 ? v_spread(v[t], (int)lane + 1) : v_zero();
            double d = D[column];
            if (!change_pivot(v_first(pr), v_first(pi), relative * diagonal[column], &d, &a, m))
                return (int32_t)column;
            D[column] = d;
            const vec br = v_set(m[3]), bi = v_set(m[5]);
            for (int g = t; g < G; g++) {
                const vec old = get(x, g, G, true, last);
                if (journal) v_store(journal + (g - t) * LANES, old);
                const vec l = g == t ? v_join(v_zero(), old, lane + NC) : old;
                v[g] = subtract_product(v[g], pr, pi, l);
                const vec y = add_product(l, br, bi, v[g]);
                put(x, g == t ? v_join(old, y, lane + NC) : y, g, G, true, last);
            }
            if (journal) journal += (G - t) * LANES;
            x += ld;
            m += step;
        }
    }
    *f->a[q] = a;
    return -1;
}

/* f1 <- L11^{-1} f1 on the rows of the block; m: multipliers z. */
QC__INLINE void solve_block(const qc__update_front *f, int64_t begin, int64_t end, double *m,
                            const int G) {
    const int64_t last = NC * (end - begin) - (G - 1) * LANES;
    const double *x = f->panel + NC * (begin * f->r + begin);
    double *solution = f->solution + NC * begin;
    vec y[GROUPS];
    for (int g = 0; g < G; g++) y[g] = get(solution, g, G, true, last);
    for (int t = 0; t < G; t++) {
        const int64_t lanes = t == G - 1 ? last : LANES;
        for (int64_t lane = 0; lane < lanes; lane += NC) {
            const vec re = v_spread(y[t], (int)lane);
            const vec im = NC == 2 ? v_spread(y[t], (int)lane + 1) : v_zero();
            m[0] = v_first(re);
            m[1] = v_first(im);
            for (int g = t; g < G; g++) {
                const vec l = get(x, g, G, true, last);
                y[g] = subtract_product(y[g], re, im, g == t ? v_join(v_zero(), l, lane + NC) : l);
            }
            x += NC * f->r;
            m += 2;
        }
    }
    for (int g = 0; g < G; g++) put(solution, y[g], g, G, true, last);
}

/* Writes the block back; returns the end of its part of the journal. */
static const double *restore_block(double *panel, int64_t r, int64_t begin, int64_t end,
                                   const double *journal) {
    const int64_t doubles = NC * (end - begin);
    for (int64_t k = begin; k < end; k++) {
        double *x = panel + NC * (k * r + begin);
        for (int64_t i = NC * (k - begin) / LANES * LANES; i < doubles; i += LANES) {
            const int64_t left = doubles - i;
            v_store_part(x + i, v_load(journal), left < LANES ? left : LANES);
            journal += LANES;
        }
    }
    return journal;
}

/* The columns from `bad` on, which a failed pivot has left alone, into the journal of the block. */
static void save_rest(const qc__update_front *f, int64_t begin, int64_t bad, int64_t end,
                      double *journal) {
    const int64_t doubles = NC * (end - begin);
    for (int64_t k = begin; k < end; k++) {
        const double *x = f->panel + NC * (k * f->r + begin);
        for (int64_t i = NC * (k - begin) / LANES * LANES; i < doubles; i += LANES) {
            const int64_t left = doubles - i;
            if (k >= bad) v_store(journal, v_load_part(x + i, left < LANES ? left : LANES));
            journal += LANES;
        }
    }
}

/* Doubles of the journal of a block. */
static inline int64_t block_journal(int64_t columns) {
    int64_t sum = 0;
    for (int64_t top = 0; top < NC * columns; top += NC)
        sum += (NC * columns + LANES - 1) / LANES * LANES - top / LANES * LANES;
    return sum;
}

static int32_t update_any(const qc__update_front *f, int64_t k, int64_t end, int32_t q, double *m,
                          int64_t step, double *journal) {
    switch ((int)((NC * (end - k) + LANES - 1) / LANES)) {
    case 1:
        return update_block(f, k, end, q, m, step, journal, 1);
    case 2:
        return update_block(f, k, end, q, m, step, journal, 2);
    case 3:
        return update_block(f, k, end, q, m, step, journal, 3);
    default:
        return update_block(f, k, end, q, m, step, journal, 4);
    }
}
static void solve_any(const qc__update_front *f, int64_t k, int64_t end, double *m) {
    switch ((int)((NC * (end - k) + LANES - 1) / LANES)) {
    case 1:
        solve_block(f, k, end, m, 1);
        break;
    case 2:
        solve_block(f, k, end, m, 2);
        break;
    case 3:
        solve_block(f, k, end, m, 3);
        break;
    default:
        solve_block(f, k, end, m, 4);
    }
}

/* All rows below the block [begin, end), of which the columns from `changed` on are updated. */
static void rows_below(qc__update_front *f, int64_t begin, int64_t changed, int64_t end,
                       int32_t vectors, const double *z) {
    const int64_t below = NC * (f->r - end), ld = NC * f->r;
    for (int64_t i = 0; i < below;) {
        const int64_t doubles = tile_size(below - i), row = NC * end + i;
        tile R = {.x = vectors > 0 ? f->panel + changed * ld + row : NULL,
                  .ld = ld,
                  .columns = end - changed,
                  .doubles = doubles,
                  .m = f->multipliers,
                  .journal = f->journal,
                  .negligible = f->negligible};
        for (int32_t q = 0; q < vectors; q += 2) {
            const int V = q + 1 < vectors ? 2 : 1;
            for (int j = 0; j < V; j++) R.v[j] = f->vector[q + j] + row;
            update_rows(&R, V, q == 0);
            R.m += STEP * V * BLOCK;
        }
        if (vectors > 0) f->journal += tile_journal(doubles, end - changed);
        if (f->solution) {
            R.x = f->panel + begin * ld + row;
            R.columns = end - begin;
            R.v[0] = f->solution + row;
            R.m = z;
            solve_rows(&R);
        }
        i += doubles;
    }
}

/* The blocks begin at multiples of BLOCK whatever the first changed column is, so that the forward
 * solution always takes the same operations. */
static inline int64_t block_end(int64_t k, int64_t w) {
    const int64_t end = (k / BLOCK + 1) * BLOCK;
    return end < w ? end : w;
}

int32_t KERNEL(qc__update_front)(qc__update_front *f) {
    double z[2 * BLOCK];
    for (int64_t k = f->solution ? 0 : f->k0 / BLOCK * BLOCK; k < f->w;) {
        const int64_t end = block_end(k, f->w), changed = k < f->k0 ? f->k0 : k;
        const int32_t vectors = changed < end ? f->vectors : 0;
        double *old = f->journal;
        if (vectors > 0) f->journal += block_journal(end - changed);
        for (int32_t q = 0; q < vectors; q++) {
            const int32_t pair = q / 2 * 2, V = pair + 1 < vectors ? 2 : 1;
            double *m = f->multipliers + STEP * (BLOCK * pair + q % 2);
            const int32_t bad = update_any(f, changed, end, q, m, STEP * V, q ? NULL : old);
            if (bad >= 0 && q == 0) save_rest(f, changed, bad, end, old);
            if (bad >= 0) return bad;
        }
        if (f->solution) solve_any(f, k, end, z);
        rows_below(f, k, changed, end, vectors, z);
        k = end;
    }
    return -1;
}

void KERNEL(qc__restore_front)(int64_t r, int64_t w, int64_t k0, double *panel,
                               const double *journal, const double *stop) {
    for (int64_t k = k0; k < w && journal < stop;) {
        const int64_t end = block_end(k, w);
        journal = restore_block(panel, r, k, end, journal);
        for (int64_t i = NC * end; i < NC * r && journal < stop;) {
            const int64_t n = tile_size(NC * r - i);
            const tile R = {
                .x = panel + NC * k * r + i, .ld = NC * r, .columns = end - k, .doubles = n};
            restore_rows(&R, journal);
            journal += tile_journal(n, end - k);
            i += n;
        }
        k = end;
    }
}
