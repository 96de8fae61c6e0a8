/* Rows below a diagonal block, a tile of which keeps its part of the vectors in registers through
 * all columns of the block: update, forward solution, and the way back from the journal. */
#ifndef QC_SPARSE_UPDATE_TILE_H
#define QC_SPARSE_UPDATE_TILE_H

#include "sdk/sparse/kernels/kernels.h"
#include "sdk/sparse/kernels/vector.h"

/* TILE: vectors of a full tile; STEP: doubles of the multipliers of one column and vector; AHEAD:
 * doubles of the journal which are asked for in advance. */
enum { TILE = LANES == 8 ? 4 : 2, STEP = 6, AHEAD = 512 };

/* A number as factor of vectors: re, and (-im, im) alternating. In memory: re, -im, im. */
typedef struct multiplier {
    vec re, im;
} multiplier;

static inline void set(double *m, double re, double im) {
    m[0] = re;
    m[1] = -im;
    m[2] = im;
}

QC__INLINE multiplier load(const double *m) {
    multiplier c;
    c.re = v_set(m[0]);
    c.im = NC == 2 ? v_pair(m + 1) : v_zero();
    return c;
}

/* y - c x and y + c x */
QC__INLINE vec subtract(vec y, multiplier c, vec x) {
    if (NC == 1) return v_fnma(c.re, x, y);
    return v_fnma(c.im, v_swap(x), v_fnma(c.re, x, y));
}
QC__INLINE vec add(vec y, multiplier c, vec x) {
    if (NC == 1) return v_fma(c.re, x, y);
    return v_fma(c.im, v_swap(x), v_fma(c.re, x, y));
}

/* A tile: some rows of the columns of one block. */
typedef struct tile {
    double *x;  /* first entry */
    int64_t ld; /* doubles between columns */
    int64_t columns;
    int64_t doubles; /* in one column; a tile of TILE vectors is full */
    const double *m; /* multipliers of the first column */
    double *v[2];    /* the vectors on these rows */
    double *journal;
    double negligible;
} tile;

/* Vector t of T, the last of which may be a part. */
QC__INLINE vec get(const double *p, int t, int T, bool part, int64_t last) {
    return part && t == T - 1 ? v_load_part(p + t * LANES, last) : v_load(p + t * LANES);
}
QC__INLINE void put(double *p, vec x, int t, int T, bool part, int64_t last) {
    if (part && t == T - 1)
        v_store_part(p + t * LANES, x, last);
    else
        v_store(p + t * LANES, x);
}

/* (S.7): w_i -= p l_i, l_i += b w_i, for V vectors after each other */
QC__INLINE void update_tile(const tile *R, const int T, const bool part, const int V,
                            const bool save) {
    const int64_t last = R->doubles - (T - 1) * LANES, ld = R->ld;
    const double *m = R->m;
    double *x = R->x, *journal = R->journal;
    vec v[2][TILE];
    for (int q = 0; q < V; q++)
        for (int t = 0; t < T; t++) v[q][t] = get(R->v[q], t, T, part, last);
    for (int64_t k = R->columns; k > 0; k--) {
        multiplier p[2], b[2];
        for (int q = 0; q < V; q++) {
            p[q] = load(m + 6 * q);
            b[q] = load(m + 6 * q + 3);
        }
        for (int t = 0; t < T; t++) {
            vec l = get(x, t, T, part, last);
            v_prefetch(x, (TILE + t) * LANES);
            if (save) v_prefetch_to_write(journal, AHEAD + t * LANES);
            if (save) v_store(journal + t * LANES, l);
            for (int q = 0; q < V; q++) {
                v[q][t] = subtract(v[q][t], p[q], l);
                l = add(l, b[q], v[q][t]);
            }
            put(x, l, t, T, part, last);
        }
        x += ld;
        m += STEP * V;
        if (save) journal += T * LANES;
    }
    const vec tiny = v_set(R->negligible);
    for (int q = 0; q < V; q++)
        for (int t = 0; t < T; t++) put(R->v[q], v_flush(v[q][t], tiny), t, T, part, last);
}

/* f_i -= l_i z; the products with real and with imaginary parts of z go into sums of their own. m:
 * re, im by column. */
QC__INLINE void solve_tile(const tile *R, const int T, const bool part) {
    const int64_t last = R->doubles - (T - 1) * LANES, ld = R->ld;
    const double *x = R->x, *m = R->m;
    vec f[TILE], g[TILE];
    for (int t = 0; t < T; t++) {
        f[t] = get(R->v[0], t, T, part, last);
        g[t] = v_zero();
    }
    for (int64_t k = R->columns; k > 0; k--) {
        const vec re = v_set(m[0]), im = v_set(m[1]);
        for (int t = 0; t < T; t++) {
            const vec l = get(x, t, T, part, last);
            f[t] = v_fnma(re, l, f[t]);
            if (NC == 2) g[t] = v_fma(im, l, g[t]);
        }
        x += ld;
        m += 2;
    }
    for (int t = 0; t < T; t++) {
        if (NC == 2) f[t] = v_fnma(v_set(1), v_times_i(g[t]), f[t]);
        put(R->v[0], f[t], t, T, part, last);
    }
}

QC__INLINE void restore_tile(const tile *R, const double *journal, const int T, const bool part) {
    const int64_t last = R->doubles - (T - 1) * LANES, ld = R->ld;
    double *x = R->x;
    for (int64_t k = R->columns; k > 0; k--) {
        for (int t = 0; t < T; t++) {
            v_prefetch_to_write(x, (TILE + t) * LANES);
            v_prefetch(journal, AHEAD + t * LANES);
            put(x, v_load(journal + t * LANES), t, T, part, last);
        }
        x += ld;
        journal += T * LANES;
    }
}

/* The statement for a tile of T vectors, `part` of the last. */
#define FOR_SIZE(R, call)                                                                          \
    do {                                                                                           \
        if ((R)->doubles == TILE * LANES) {                                                        \
            call(TILE, false);                                                                     \
        } else {                                                                                   \
            switch ((int)(((R)->doubles + LANES - 1) / LANES)) {                                   \
            case 1:                                                                                \
                call(1, true);                                                                     \
                break;                                                                             \
            case 2:                                                                                \
                call(2, true);                                                                     \
                break;                                                                             \
            case 3:                                                                                \
                call(TILE < 3 ? TILE : 3, true);                                                   \
                break;                                                                             \
            default:                                                                               \
                call(TILE, true);                                                                  \
            }                                                                                      \
        }                                                                                          \
    } while (0)

static void update_rows(const tile *R, int V, bool save) {
#define PAIR_SAVE(T, part) update_tile(R, T, part, 2, true)
#define PAIR(T, part)      update_tile(R, T, part, 2, false)
#define ONE_SAVE(T, part)  update_tile(R, T, part, 1, true)
#define ONE(T, part)       update_tile(R, T, part, 1, false)
    if (V == 2 && save)
        FOR_SIZE(R, PAIR_SAVE);
    else if (V == 2)
        FOR_SIZE(R, PAIR);
    else if (save)
        FOR_SIZE(R, ONE_SAVE);
    else
        FOR_SIZE(R, ONE);
}

static void solve_rows(const tile *R) {
#define SOLVE(T, part) solve_tile(R, T, part)
    FOR_SIZE(R, SOLVE);
}

static void restore_rows(const tile *R, const double *journal) {
#define RESTORE(T, part) restore_tile(R, journal, T, part)
    FOR_SIZE(R, RESTORE);
}

/* Doubles of the next tile when n are left. */
static inline int64_t tile_size(int64_t n) {
    return n < TILE * LANES ? n : TILE * LANES;
}
static inline int64_t tile_journal(int64_t doubles, int64_t columns) {
    return (doubles + LANES - 1) / LANES * LANES * columns;
}

#endif
