/* Triangular solves with a block of right-hand sides. Row i of the block holds the real parts and
 * then the imaginary parts of all its columns; an entry of L is broadcast against a row of the
 * block, and a tile of several rows (forward) or columns (backward) of L stays in registers. */
#include <string.h>
#include "sdk/sparse/kernels/solve.h"

enum {
    PART = QC__BLOCK / LANES, /* vectors of the real parts of one row */
    V = NC * PART,            /* vectors of one row */
    ROW = NC * QC__BLOCK,     /* doubles of one row */
    TILE = LANES == 8   ? (V == 2   ? 8
                           : V == 1 ? 8
                                    : 4)
           : LANES == 4 ? 2
                        : 1
};

/* y -= l x for one row, or y -= conj(l) x. The terms with the imaginary part of x come first, as in
 * e_subtract. */
static inline void subtract_row(const bool conjugate, const double *l, const vec *x, vec *y) {
    const vec re = v_set(l[0]);
    if (NC == 2) {
        const vec im = v_set(l[NC - 1]);
        for (int v = 0; v < PART; v++) {
            y[v] = conjugate ? v_fnma(im, x[PART + v], y[v]) : v_fma(im, x[PART + v], y[v]);
            y[PART + v] = v_fnma(re, x[PART + v], y[PART + v]);
        }
        for (int v = 0; v < PART; v++)
            y[PART + v] = conjugate ? v_fma(im, x[v], y[PART + v]) : v_fnma(im, x[v], y[PART + v]);
    }
    for (int v = 0; v < PART; v++) y[v] = v_fnma(re, x[v], y[v]);
}

static inline void load_row(const double *p, vec *x) {
    for (int v = 0; v < V; v++) x[v] = v_load(p + LANES * v);
}
static inline void store_row(double *p, const vec *x) {
    for (int v = 0; v < V; v++) v_store(p + LANES * v, x[v]);
}

/* T rows of y -= the same rows of K columns of L times x; fresh: y is taken as zero. */
static inline void forward_tile(const int T, bool fresh, int64_t K, const double *L, int64_t ld,
                                const double *x, double *y) {
    vec sum[TILE][V];
    for (int i = 0; i < T; i++) {
        if (fresh)
            for (int v = 0; v < V; v++) sum[i][v] = v_zero();
        else
            load_row(y + ROW * i, sum[i]);
    }
    for (int64_t k = 0; k < K; k++) {
        vec xk[V];
        load_row(x + ROW * k, xk);
        for (int i = 0; i < T; i++) subtract_row(false, L + k * ld + NC * i, xk, sum[i]);
    }
    for (int i = 0; i < T; i++) store_row(y + ROW * i, sum[i]);
}

static inline void forward_rows(bool fresh, int64_t n, int64_t K, const double *L, int64_t ld,
                                const double *x, double *y) {
    int64_t i = 0;
    for (; i + TILE <= n; i += TILE) forward_tile(TILE, fresh, K, L + NC * i, ld, x, y + ROW * i);
    if (TILE > 4 && i + 4 <= n) {
        forward_tile(TILE > 4 ? 4 : 1, fresh, K, L + NC * i, ld, x, y + ROW * i);
        i += 4;
    }
    if (TILE > 2 && i + 2 <= n) {
        forward_tile(TILE > 2 ? 2 : 1, fresh, K, L + NC * i, ld, x, y + ROW * i);
        i += 2;
    }
    for (; i < n; i++) forward_tile(1, fresh, K, L + NC * i, ld, x, y + ROW * i);
}

/* Own triangle: by tiles of rows, first the columns left of the tile, then its own triangle. */
static inline void forward_triangle(const panel *P, double *x) {
    for (int64_t i = 1; i < P->w; i += TILE) {
        const int64_t end = i + TILE < P->w ? i + TILE : P->w;
        forward_rows(false, end - i, i, P->L + NC * i, P->ld, x, x + ROW * i);
        for (int64_t j = i + 1; j < end; j++)
            forward_tile(1, false, j - i, P->L + NC * j + i * P->ld, P->ld, x + ROW * i,
                         x + ROW * j);
    }
}

/* y <- a y + (b + c), a = 0 or 1 */
static inline void add_rows(bool fresh, const double *b, const double *c, double *y) {
    for (int v = 0; v < V * LANES; v += LANES) {
        const vec sum = v_add(v_load(b + v), v_load(c + v));
        v_store(y + v, fresh ? sum : v_add(v_load(y + v), sum));
    }
}

static inline void add_row(const double *x, double *y) {
    for (int v = 0; v < V * LANES; v += LANES) v_store(y + v, v_add(v_load(y + v), v_load(x + v)));
}

/* Sum of the update vectors which the children left in their slots. */
static void collect(const qc__rhs_block *B, int32_t s, double *sum) {
    const qc_symbolic *S = B->F->S;
    memset(sum, 0, (size_t)(ROW * (S->rowptr[s + 1] - S->rowptr[s])) * sizeof *sum);
    for (int32_t c = S->child[s]; c != -1; c = S->sibling[c]) {
        const qc__solve_node *N = &S->solve.node[c];
        const int32_t *local = S->relative + N->below;
        for (int64_t i = 0; i < N->m; i++)
            add_row(B->area + ROW * (N->to + i), sum + ROW * local[i]);
    }
}

/* u: room for one supernode */
static void forward_supernode(const qc__rhs_block *B, const qc__solve_node *N, double *sum,
                              double *to, double *u) {
    const panel P = panel_of(B->F, N);
    const int32_t *local = B->F->S->relative + N->below;
    double *x = B->Y + ROW * (int64_t)N->first;
    for (int64_t k = 0; k < P.w; k++) add_row(sum + ROW * k, x + ROW * k);
    forward_triangle(&P, x);
    forward_rows(true, P.m, P.w, P.L + NC * P.w, P.ld, x, u);
    for (int64_t i = 0; i < P.m; i++)
        add_rows(N->leaves, u + ROW * i, sum + ROW * (P.w + i),
                 to + ROW * (N->leaves ? i : local[i]));
    memset(sum, 0, (size_t)(ROW * (P.w + P.m)) * sizeof *sum);
}

void KERNEL(qc__forward_block)(const qc__rhs_block *B, double *work, int32_t first, int32_t last) {
    const qc_symbolic *S = B->F->S;
    const int64_t step = ROW * S->solve.work;
    double *u = work, *top = work + 2 * step, *stack = work + 3 * step;
    for (int32_t s = first; s <= last; s++) {
        const qc__solve_node *N = &S->solve.node[s];
        double *sum = N->top ? top : stack + ROW * N->sum;
        if (N->top) collect(B, s, sum);
        forward_supernode(B, N, sum, (N->leaves ? B->area : stack) + ROW * N->to, u);
    }
}

/* Rows of y, by T columns of L, -= sums over the rows of Y: conj(L)^T Y. row = NULL: rows 0..n-1 */
static inline void backward_tile(const int T, int64_t n, const double *L, int64_t ld,
                                 const double *Y, const int32_t *row, double *y) {
    vec sum[TILE][V];
    for (int j = 0; j < T; j++) load_row(y + ROW * j, sum[j]);
    for (int64_t i = 0; i < n; i++) {
        vec x[V];
        load_row(Y + ROW * (row ? row[i] : i), x);
        for (int j = 0; j < T; j++) subtract_row(true, L + j * ld + NC * i, x, sum[j]);
    }
    for (int j = 0; j < T; j++) store_row(y + ROW * j, sum[j]);
}

/* Columns [k, k + T): rows below, own rows after the group, its own triangle. */
static inline void backward_group(const int T, const panel *P, int64_t k, const double *Y,
                                  const int32_t *below, double *x) {
    const double *L = P->L + k * P->ld;
    const int64_t next = k + T;
    backward_tile(T, P->m, L + NC * P->w, P->ld, Y, below, x + ROW * k);
    if (next < P->w)
        backward_tile(T, P->w - next, L + NC * next, P->ld, x + ROW * next, NULL, x + ROW * k);
    for (int64_t j = T - 1; j-- > 0;)
        backward_tile(1, T - 1 - j, L + j * P->ld + NC * (k + j + 1), P->ld, x + ROW * (k + j + 1),
                      NULL, x + ROW * (k + j));
}

static void backward_supernode(const qc__rhs_block *B, const qc__solve_node *N) {
    const panel P = panel_of(B->F, N);
    const int32_t *below = B->F->S->rows + N->below;
    double *x = B->Y + ROW * (int64_t)N->first;
    for (int64_t k = 0; k < P.w; k++) {
        const vec scale = v_set(1 / B->F->D[N->first + k]);
        for (int v = 0; v < V; v++)
            v_store(x + ROW * k + LANES * v, v_mul(scale, v_load(x + ROW * k + LANES * v)));
    }
    int64_t k = P.w;
    for (; k >= TILE; k -= TILE) backward_group(TILE, &P, k - TILE, B->Y, below, x);
    if (TILE > 4 && k >= 4) backward_group(TILE > 4 ? 4 : 1, &P, k -= 4, B->Y, below, x);
    if (TILE > 2 && k >= 2) backward_group(TILE > 2 ? 2 : 1, &P, k -= 2, B->Y, below, x);
    for (; k > 0; k--) backward_group(1, &P, k - 1, B->Y, below, x);
}

void KERNEL(qc__backward_block)(const qc__rhs_block *B, double *work, int32_t first, int32_t last) {
    const qc_symbolic *S = B->F->S;
    (void)work;
    for (int32_t s = last; s >= first; s--) backward_supernode(B, &S->solve.node[s]);
}

/* Conversion goes in the caller's order: a row of Y lies together, the columns of x do not. One
 * step takes a vector of each column of x, that is STEP rows of Y, as pairs of vectors: the real
 * and imaginary parts of a row, or two real rows. */
enum { STEP = LANES / NC, PAIRS = LANES / 2, FAR = 8 * STEP };

static inline double *row_of(const qc__rhs_block *B, int64_t i) {
    return B->Y + ROW * (int64_t)B->F->S->inverse[i];
}
static inline double *half_of_pair(const qc__rhs_block *B, int64_t i, int pair, int half) {
    return NC == 2 ? row_of(B, i + pair) + half * QC__BLOCK : row_of(B, i + 2 * pair + half);
}
static inline void fetch_rows(const qc__rhs_block *B, int64_t i) {
    for (int64_t k = i + FAR; k < i + FAR + STEP && k < B->F->S->n; k++)
        for (int d = 0; d < ROW; d += 8) v_prefetch(row_of(B, k), d);
}

static inline void load_step(const qc__rhs_block *B, int64_t ld, int64_t i) {
    for (int v = 0; v < PART; v++) {
        vec even[PAIRS], odd[PAIRS];
        for (int p = 0; p < PAIRS; p++) {
            const int64_t q = LANES * v + 2 * p;
            even[p] = q < B->columns ? v_load(B->x + q * ld + NC * i) : v_zero();
            odd[p] = q + 1 < B->columns ? v_load(B->x + (q + 1) * ld + NC * i) : v_zero();
        }
        v_transpose_pairs(even);
        v_transpose_pairs(odd);
        for (int p = 0; p < PAIRS; p++) {
            vec a, b;
            v_interleave(even[p], odd[p], &a, &b);
            v_store(half_of_pair(B, i, p, 0) + LANES * v, a);
            v_store(half_of_pair(B, i, p, 1) + LANES * v, b);
        }
    }
}

static inline void store_step(const qc__rhs_block *B, int64_t ld, int64_t i) {
    for (int v = 0; v < PART; v++) {
        vec even[PAIRS], odd[PAIRS];
        for (int p = 0; p < PAIRS; p++)
            v_interleave(v_load(half_of_pair(B, i, p, 0) + LANES * v),
                         v_load(half_of_pair(B, i, p, 1) + LANES * v), &even[p], &odd[p]);
        v_transpose_pairs(even);
        v_transpose_pairs(odd);
        for (int p = 0; p < PAIRS; p++) {
            const int64_t q = LANES * v + 2 * p;
            if (q < B->columns) v_store(B->x + q * ld + NC * i, even[p]);
            if (q + 1 < B->columns) v_store(B->x + (q + 1) * ld + NC * i, odd[p]);
        }
    }
}

void KERNEL(qc__load_block)(const qc__rhs_block *B, int64_t begin, int64_t end) {
    const int64_t ld = NC * (int64_t)B->F->S->n;
    int64_t i = begin;
    for (; i + STEP <= end; i += STEP) {
        fetch_rows(B, i);
        load_step(B, ld, i);
    }
    for (; i < end; i++)
        for (int64_t q = 0; q < QC__BLOCK; q++)
            for (int c = 0; c < NC; c++)
                row_of(B, i)[c * QC__BLOCK + q] = q < B->columns ? B->x[q * ld + NC * i + c] : 0;
}

void KERNEL(qc__store_block)(const qc__rhs_block *B, int64_t begin, int64_t end) {
    const int64_t ld = NC * (int64_t)B->F->S->n;
    int64_t i = begin;
    for (; i + STEP <= end; i += STEP) {
        fetch_rows(B, i);
        store_step(B, ld, i);
    }
    for (; i < end; i++)
        for (int64_t q = 0; q < B->columns; q++)
            for (int c = 0; c < NC; c++)
                B->x[q * ld + NC * i + c] = row_of(B, i)[c * QC__BLOCK + q];
}

/* x <- D^{-1/2} Y in elimination order, columns [begin, end) of L */
void KERNEL(qc__store_scaled_block)(const qc__rhs_block *B, int64_t begin, int64_t end) {
    const int64_t ld = NC * (int64_t)B->F->S->n, columns = B->columns;
    double scale[LANES];
    for (int64_t k = begin; k < end; k += LANES) {
        const int64_t count = end - k < LANES ? end - k : LANES;
        inverse_roots(count, B->F->D + k, scale);
        for (int64_t q = 0; q < columns; q++)
            for (int64_t i = 0; i < count; i++)
                for (int c = 0; c < NC; c++)
                    B->x[q * ld + NC * (k + i) + c] =
                        scale[i] * B->Y[ROW * (k + i) + c * QC__BLOCK + q];
    }
}
