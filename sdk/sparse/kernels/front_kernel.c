/* Partial LDL^H of dense fronts by register tiles. C <- C - L D L^H is summed for a tile of
 * TILE_VECTORS vectors of rows times TILE_COLUMNS columns which stays in registers. Of the complex
 * products x c the sums over x Re(c) and x Im(c) are kept apart and joined once at the end, so that
 * interleaved numbers cost no shuffle inside the loop. */
#include <math.h>
#include "sdk/sparse/kernels/kernels.h"
#include "sdk/sparse/kernels/vector.h"

/* As many sums as there are registers for: 32 with AVX-512, else 16. */
enum {
    TILE_VECTORS = LANES == 2 ? 2 : 3,
    TILE_COLUMNS = LANES == 8 || NC == 1 ? 4 : 2,
    VECTOR_ROWS = LANES / NC,
    TILE_ROWS = TILE_VECTORS * VECTOR_ROWS,
    TILE_LANES = TILE_VECTORS * LANES,
    LONG_SUM = 12 /* columns from which on copying a tile of L to contiguous memory pays */
};

typedef struct tile_job {
    int64_t columns; /* of L to subtract */
    const double *A; /* rows of L: lda doubles from column to column */
    int64_t lda;
    const double *B;   /* packed multipliers */
    double *C;         /* ldc doubles from column to column */
    int64_t ldc, last; /* lanes of the last vector which exist */
    bool fresh;        /* C counts as zero */
    const double *T;   /* the finished diagonal block, see solve_tile */
} tile_job;

typedef struct tile {
    vec at[4][3]; /* column, vector */
} tile;

/* C - A B */
QC__INLINE tile product(const int V, const int Q, const bool full, const tile_job *job) {
    const double *A = job->A, *B = job->B, *C = job->C;
    tile re, im;
    QC__UNROLL for (int q = 0; q < Q; q++) QC__UNROLL for (int v = 0; v < V; v++) re.at[q][v] =
        im.at[q][v] = v_zero();
    for (int64_t k = job->columns; k > 0; k--, A += job->lda, B += NC * TILE_COLUMNS) {
        vec a[3];
        QC__UNROLL for (int v = 0; v < V; v++) a[v] =
            !full && v == V - 1 ? v_load_part(A + LANES * v, job->last) : v_load(A + LANES * v);
        QC__UNROLL for (int q = 0; q < Q; q++) {
            const vec c = v_set(B[NC * q]), d = v_set(B[NC * q + NC - 1]);
            QC__UNROLL for (int v = 0; v < V; v++) {
                re.at[q][v] = v_fma(a[v], c, re.at[q][v]);
                if (NC == 2) im.at[q][v] = v_fma(a[v], d, im.at[q][v]);
            }
        }
    }
    const vec one = v_set(1), sign = v_alternate(1);
    QC__UNROLL for (int q = 0; q < Q; q++, C += job->ldc) QC__UNROLL for (int v = 0; v < V; v++) {
        vec c = v_zero();
        if (!job->fresh)
            c = !full && v == V - 1 ? v_load_part(C + LANES * v, job->last) : v_load(C + LANES * v);
        c = v_fnma(one, re.at[q][v], c);
        re.at[q][v] = NC == 1 ? c : v_fnma(sign, v_swap(im.at[q][v]), c);
    }
    return re;
}

/* Columns below a finished diagonal block L1 D1 L1^H: X = C L1^{-H} D1^{-1}, column by column. T
 * holds, with stride NC TILE_COLUMNS, conj(L1(q,p)) for p < q and 1 / D1(q) for p = q. */
QC__INLINE void solve_columns(const int V, const int Q, const double *T, tile *t) {
    QC__UNROLL for (int q = 1; q < Q; q++) QC__UNROLL for (int p = 0; p < q; p++) {
        const double *c = T + NC * (q * TILE_COLUMNS + p);
        const vec re = v_set(c[0]), im = v_alternate(c[NC - 1]);
        QC__UNROLL for (int v = 0; v < V; v++) {
            if (NC == 2) t->at[q][v] = v_fnma(im, v_swap(t->at[p][v]), t->at[q][v]);
            t->at[q][v] = v_fnma(re, t->at[p][v], t->at[q][v]);
        }
    }
    QC__UNROLL for (int q = 0; q < Q; q++) {
        const vec inverse = v_set(T[NC * (q * TILE_COLUMNS + q)]);
        QC__UNROLL for (int v = 0; v < V; v++) t->at[q][v] = v_mul(t->at[q][v], inverse);
    }
}

QC__INLINE void run_tile(const int vectors, const int columns, const bool full, const bool solve,
                         const tile_job *job) {
    const int V = vectors < TILE_VECTORS ? vectors : TILE_VECTORS;
    const int Q = columns < TILE_COLUMNS ? columns : TILE_COLUMNS;
    tile t = product(V, Q, full, job);
    if (solve) solve_columns(V, Q, job->T, &t);
    double *C = job->C;
    QC__UNROLL for (int q = 0; q < Q; q++, C += job->ldc) QC__UNROLL for (int v = 0; v < V; v++) {
        if (!full && v == V - 1)
            v_store_part(C + LANES * v, t.at[q][v], job->last);
        else
            v_store(C + LANES * v, t.at[q][v]);
    }
}

/* One instance per number of vectors and columns, so that the loops above are unrolled. */
#define TILE(V, Q)                                                                                 \
    static void product_##V##_##Q(const tile_job *job) {                                           \
        run_tile(V, Q, false, false, job);                                                         \
    }                                                                                              \
    static void solve_##V##_##Q(const tile_job *job) {                                             \
        run_tile(V, Q, false, true, job);                                                          \
    }                                                                                              \
    _Static_assert((V) <= 3 && (Q) <= 4, "size of a tile")
TILE(1, 1);
TILE(1, 2);
TILE(1, 3);
TILE(1, 4);
TILE(2, 1);
TILE(2, 2);
TILE(2, 3);
TILE(2, 4);
TILE(3, 1);
TILE(3, 2);
TILE(3, 3);
TILE(3, 4);

typedef void tile_function(const tile_job *);
static tile_function *const products[3][4] = {{product_1_1, product_1_2, product_1_3, product_1_4},
                                              {product_2_1, product_2_2, product_2_3, product_2_4},
                                              {product_3_1, product_3_2, product_3_3, product_3_4}};
static tile_function *const solves[3][4] = {{solve_1_1, solve_1_2, solve_1_3, solve_1_4},
                                            {solve_2_1, solve_2_2, solve_2_3, solve_2_4},
                                            {solve_3_1, solve_3_2, solve_3_3, solve_3_4}};

/* `rows` <= TILE_ROWS rows of a tile with `columns` columns. */
static void run_product(int64_t rows, int64_t columns, tile_job *job) {
    const int64_t vectors = (rows + VECTOR_ROWS - 1) / VECTOR_ROWS;
    job->last = NC * rows - LANES * (vectors - 1);
    if (rows == TILE_ROWS && columns == TILE_COLUMNS)
        run_tile(TILE_VECTORS, TILE_COLUMNS, true, false, job);
    else
        products[vectors - 1][columns - 1](job);
}

/* B(k,q) = d_k conj(L(j+q,k)) of the rows [j, j + rows), rows <= TILE_COLUMNS, and the columns
 * [k0, k1). Places beyond `rows` are zero. */
static void pack_multipliers(const double *panel, int64_t r, int64_t j, int64_t rows, int64_t k0,
                             int64_t k1, const double *D, double *B) {
    const double *l = panel + NC * (j + k0 * r);
    for (int64_t k = k0; k < k1; k++, l += NC * r, B += NC * TILE_COLUMNS) {
        const vec d = NC == 2 ? v_alternate(-D[k]) : v_set(D[k]);
        for (int v = 0; v < NC * TILE_COLUMNS; v += LANES) {
            const int64_t left = NC * rows - v;
            if (NC * TILE_COLUMNS - v < LANES)
                v_store_part(B + v, v_mul(v_load_part(l + v, left), d), NC * TILE_COLUMNS - v);
            else if (left >= LANES)
                v_store(B + v, v_mul(v_load(l + v), d));
            else
                v_store(B + v, v_mul(v_load_part(l + v, left > 0 ? left : 0), d));
        }
    }
}

/* L D L^H of a diagonal block of Q columns in place; fills T of solve_columns. Returns the column
 * whose pivot fails, or -1. */
static int32_t factor_diagonal(int64_t Q, double *C, int64_t ldc, double *D, const double *floor,
                               double *T) {
    for (int64_t a = 0; a < Q; a++) {
        double *x = C + a * ldc;
        const double d = x[NC * a], inverse = 1 / d;
        if (!(d > floor[a]) || !isfinite(d)) return (int32_t)a;
        D[a] = d;
        T[NC * (a * TILE_COLUMNS + a)] = inverse;
        for (int64_t b = a + 1; b < Q; b++) {
            double *t = T + NC * (b * TILE_COLUMNS + a);
            t[0] = x[NC * b] * inverse;
            if (NC == 2) t[NC - 1] = -x[NC * b + NC - 1] * inverse;
            double *y = C + b * ldc;
            for (int64_t i = b; i < Q; i++) { /* y -= x conj(l_b) */
                if (NC == 1) {
                    y[i] -= x[i] * t[0];
                } else {
                    const double re = x[NC * i], im = x[NC * i + NC - 1];
                    y[NC * i] -= re * t[0] - im * t[NC - 1];
                    y[NC * i + NC - 1] -= re * t[NC - 1] + im * t[0];
                }
            }
        }
        for (int64_t i = NC * (a + 1); i < NC * Q; i++) x[i] *= inverse;
        x[NC * a] = 1;
        if (NC == 2) x[NC * a + NC - 1] = 0;
    }
    return -1;
}

/* Left-looking within the block: TILE_COLUMNS columns at a time. B: work for their multipliers. */
int32_t KERNEL(qc__front_factor_block)(int64_t r, int64_t k0, int64_t k1, double *panel, double *D,
                                       const double *floor, double *B) {
    double T[NC * TILE_COLUMNS * TILE_COLUMNS];
    for (int64_t j = k0; j < k1; j += TILE_COLUMNS) {
        const int64_t Q = k1 - j < TILE_COLUMNS ? k1 - j : TILE_COLUMNS;
        const double *A = panel + NC * k0 * r;
        double *C = panel + NC * j * r;
        tile_job job = {j - k0, A + NC * j, NC * r, B, C + NC * j, NC * r, 0, false, T};
        pack_multipliers(panel, r, j, Q, k0, j, D, B);
        if (j > k0) run_product(Q, Q, &job);
        const int32_t bad = factor_diagonal(Q, C + NC * j, NC * r, D + j, floor + j, T);
        if (bad >= 0) return (int32_t)j + bad;
        for (int64_t i = j + Q; i < r; i += TILE_ROWS) {
            const int64_t rows = r - i < TILE_ROWS ? r - i : TILE_ROWS;
            const int64_t vectors = (rows + VECTOR_ROWS - 1) / VECTOR_ROWS;
            job.A = A + NC * i;
            job.C = C + NC * i;
            job.last = NC * rows - LANES * (vectors - 1);
            if (rows == TILE_ROWS && Q == TILE_COLUMNS)
                run_tile(TILE_VECTORS, TILE_COLUMNS, true, true, &job);
            else
                solves[vectors - 1][Q - 1](&job);
        }
    }
    return -1;
}

static int64_t groups(int64_t columns) {
    return (columns + TILE_COLUMNS - 1) / TILE_COLUMNS;
}

/* B: groups of TILE_COLUMNS rows, first those of the panel's columns [k1, w), then those of U. */
void KERNEL(qc__front_pack)(int64_t r, int64_t w, int64_t k0, int64_t k1, const double *panel,
                            const double *D, double *B) {
    const int64_t ends[2] = {w, r};
    int64_t j = k1;
    for (int part = 0; part < 2; part++)
        for (; j < ends[part]; j += TILE_COLUMNS, B += NC * TILE_COLUMNS * (k1 - k0)) {
            const int64_t left = ends[part] - j;
            pack_multipliers(panel, r, j, left < TILE_COLUMNS ? left : TILE_COLUMNS, k0, k1, D, B);
            if (left < TILE_COLUMNS) {
                j = ends[part];
                B += NC * TILE_COLUMNS * (k1 - k0);
                break;
            }
        }
}

/* The rows of a tile copied one after the other; lanes beyond the last row are zero. */
static void copy_rows(int64_t columns, const double *A, int64_t lda, int64_t lanes, double *out) {
    for (int64_t k = 0; k < columns; k++, A += lda, out += TILE_LANES)
        for (int v = 0; v < TILE_VECTORS; v++) {
            const int64_t left = lanes - LANES * v;
            v_store(out + LANES * v, left >= LANES ? v_load(A + LANES * v)
                                     : left > 0    ? v_load_part(A + LANES * v, left)
                                                   : v_zero());
        }
}

/* The groups of columns [0, columns) of one target, for the rows [i, i + rows) counted in the
 * target: those below or on its diagonal. */
static void subtract_from(int64_t i, int64_t rows, int64_t columns, tile_job job, double *C) {
    const double *A = job.A;
    const int64_t B_step = NC * TILE_COLUMNS * job.columns;
    for (int64_t c = 0; c < columns && c < i + rows; c += TILE_COLUMNS, job.B += B_step) {
        const int64_t Q = columns - c < TILE_COLUMNS ? columns - c : TILE_COLUMNS;
        const int64_t above = c > i ? (c - i) / VECTOR_ROWS * VECTOR_ROWS : 0;
        job.A = A + NC * above;
        job.C = C + NC * (i + above) + job.ldc * c;
        run_product(rows - above, Q, &job);
    }
}

int64_t KERNEL(qc__front_tiles)(int64_t r, int64_t w, int64_t k1) {
    return (w - k1 + TILE_ROWS - 1) / TILE_ROWS + (r - w + TILE_ROWS - 1) / TILE_ROWS;
}

/* Subtracts the columns [k0, k1) from row tile t of what follows: tiles of the rows [k1, w), then
 * of the rows [w, r), on the columns [k1, w) of the panel and on U. */
void KERNEL(qc__front_subtract)(int64_t r, int64_t w, int64_t k0, int64_t k1, double *panel,
                                double *U, const double *B, bool fresh, int64_t t, double *copy) {
    const int64_t inner = (w - k1 + TILE_ROWS - 1) / TILE_ROWS, K = k1 - k0, m = r - w;
    const int64_t i = t < inner ? k1 + t * TILE_ROWS : w + (t - inner) * TILE_ROWS;
    const int64_t end = t < inner ? w : r, rows = end - i < TILE_ROWS ? end - i : TILE_ROWS;
    tile_job job = {K, panel + NC * (i + k0 * r), NC * r, B, NULL, NC * r, 0, false, NULL};
    if (K >= LONG_SUM) {
        copy_rows(K, job.A, job.lda, NC * rows, copy);
        job.A = copy;
        job.lda = TILE_LANES;
    }
    subtract_from(i - k1, rows, w - k1, job, panel + NC * (k1 + k1 * r));
    if (t < inner) return;
    job.B += NC * TILE_COLUMNS * K * groups(w - k1);
    job.ldc = NC * m;
    job.fresh = fresh;
    subtract_from(i - w, rows, m, job, U);
}
