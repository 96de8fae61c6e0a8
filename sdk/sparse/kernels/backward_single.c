/* x <- L^{-H} D^{-1} x for one right-hand side, as forward_single.c, and the permutations before
 * and after both. */
#include "sdk/sparse/kernels/solve.h"

/* Partial sums of conj(L)^T x for a group of columns, in lanes: of l x and of l swap(x), from which
 *     conj(l) x = (l.re x.re + l.im x.im) + i (l.re x.im - l.im x.re). */
typedef struct dots {
    vec p[GROUP], q[GROUP];
} dots;

/* One vector of rows; n: how many doubles of it count, at most LANES. */
static inline void add_rows(const int G, int64_t n, const double *L, int64_t ld, vec x, dots *d) {
    const int64_t ahead = ahead_of(ld);
    const vec swapped = v_swap(x);
    for (int g = 0; g < G; g++) {
        const double *at = L + g * ld;
        const vec l = n == LANES ? v_load(at) : v_load_part(at, n);
        v_prefetch(at, -ahead);
        d->p[g] = v_fma(l, x, d->p[g]);
        if (NC == 2) d->q[g] = v_fma(l, swapped, d->q[g]);
    }
}

/* n doubles of x */
static inline void add_columns(const int G, int64_t n, const double *L, int64_t ld, const double *x,
                               dots *d) {
    int64_t i = 0;
    for (; i + LANES <= n; i += LANES) add_rows(G, LANES, L + i, ld, v_load(x + i), d);
    if (i < n) add_rows(G, n - i, L + i, ld, v_load_part(x + i, n - i), d);
}

/* x <- x / D - dots, then L^{-H} x for the triangle of the group */
static inline void finish_group(const int G, const double *L, int64_t ld, const double *D,
                                const dots *d, double *x) {
    double sum[2 * GROUP];
    entry y[GROUP];
    v_sum_four(d->p[0], d->p[1], d->p[2], d->p[3], sum);
    if (NC == 2) {
        const vec sign = v_alternate(-1);
        v_sum_four(v_mul(sign, d->q[0]), v_mul(sign, d->q[1]), v_mul(sign, d->q[2]),
                   v_mul(sign, d->q[3]), sum + GROUP);
    }
    for (int g = 0; g < G; g++)
        y[g] = e_scale_subtract(1 / D[g], e_load(x + NC * g), e_pair(sum + g, GROUP));
    for (int i = G - 1; i > 0; i--)
        for (int j = i - 1; j >= 0; j--)
            y[j] = e_subtract_conjugate(e_load(L + j * ld + NC * i), y[i], y[j]);
    for (int g = 0; g < G; g++) e_store(x + NC * g, y[g]);
}

static inline dots no_dots(void) {
    dots d;
    for (int g = 0; g < GROUP; g++) d.p[g] = d.q[g] = v_zero();
    return d;
}

/* Columns [k, k + G); t: values at the rows below. */
static inline void backward_group(const int G, const panel *P, int64_t k, const double *D,
                                  const double *t, double *x) {
    const double *L = P->L + k * P->ld;
    const int64_t next = k + G;
    dots d = no_dots();
    add_columns(G, NC * P->m, L + NC * P->w, P->ld, t, &d);
    if (next < P->w) add_columns(G, NC * (P->w - next), L + NC * next, P->ld, x + NC * next, &d);
    finish_group(G, L + NC * k, P->ld, D + k, &d, x + NC * k);
}

enum { STEP = LANES / NC };

static inline vec gather_full(const double *Y, const int32_t *row) {
    return NC == 2 ? v_gather_pairs(Y, row) : v_gather(Y, row);
}
/* count < STEP rows; the last one is repeated. */
static inline vec gather_rest(const double *Y, int64_t count, const int32_t *row) {
    int32_t rest[STEP];
    for (int64_t j = 0; j < STEP; j++) rest[j] = row[j < count ? j : count - 1];
    return gather_full(Y, rest);
}

static inline void gather_rows(const double *Y, int64_t m, const int32_t *row, double *t) {
    int64_t i = 0;
    for (; i + STEP <= m; i += STEP) v_store(t + NC * i, gather_full(Y, row + i));
    if (i < m) v_store(t + NC * i, gather_rest(Y, m - i, row + i));
}

/* A supernode of G columns, most of all: the rows below go from Y to the sums. The same operations
 * as backward_group. */
static inline void backward_few(const int G, const qc__rhs_block *B, const qc__solve_node *N) {
    const panel P = panel_of(B->F, N);
    const int32_t *row = B->F->S->rows + N->below;
    const double *L = P.L + NC * G;
    dots d = no_dots();
    int64_t i = 0;
    for (; i + STEP <= P.m; i += STEP)
        add_rows(G, LANES, L + NC * i, P.ld, gather_full(B->Y, row + i), &d);
    if (i < P.m)
        add_rows(G, NC * (P.m - i), L + NC * i, P.ld, gather_rest(B->Y, P.m - i, row + i), &d);
    finish_group(G, P.L, P.ld, B->F->D + N->first, &d, B->Y + NC * (int64_t)N->first);
}

static inline void backward_panel(const panel *P, const double *D, const double *t, double *x) {
    int64_t k = P->w;
    for (; k >= GROUP; k -= GROUP) backward_group(GROUP, P, k - GROUP, D, t, x);
    switch (k) {
    case 3:
        backward_group(3, P, 0, D, t, x);
        break;
    case 2:
        backward_group(2, P, 0, D, t, x);
        break;
    case 1:
        backward_group(1, P, 0, D, t, x);
        break;
    default:
        break;
    }
}

void KERNEL(qc__backward_panel)(const qc_factor *F, int32_t s, const double *t, double *x) {
    const qc__solve_node *N = &F->S->solve.node[s];
    const panel P = panel_of(F, N);
    backward_panel(&P, F->D + N->first, t, x);
}

void KERNEL(qc__backward_single)(const qc__rhs_block *B, double *work, int32_t first,
                                 int32_t last) {
    const qc_symbolic *S = B->F->S;
    for (int32_t s = last; s >= first; s--) {
        const qc__solve_node *N = &S->solve.node[s];
        const panel P = panel_of(B->F, N);
        switch (N->w) {
        case 1:
            backward_few(1, B, N);
            break;
        case 2:
            backward_few(2, B, N);
            break;
        case 3:
            backward_few(3, B, N);
            break;
        case 4:
            backward_few(4, B, N);
            break;
        default:
            gather_rows(B->Y, P.m, S->rows + N->below, work);
            backward_panel(&P, B->F->D + N->first, work, B->Y + NC * (int64_t)N->first);
            break;
        }
    }
}

static inline void gather(int64_t begin, int64_t end, const int32_t *from, const double *x,
                          double *y) {
    for (int64_t k = begin; k < end; k++)
        for (int c = 0; c < NC; c++) y[NC * k + c] = x[NC * (int64_t)from[k] + c];
}

void KERNEL(qc__load_single)(const qc__rhs_block *B, int64_t begin, int64_t end) {
    gather(begin, end, B->F->S->perm, B->x, B->Y);
}

void KERNEL(qc__store_single)(const qc__rhs_block *B, int64_t begin, int64_t end) {
    gather(begin, end, B->F->S->inverse, B->Y, B->x);
}

/* x <- D^{-1/2} Y in elimination order, columns [begin, end) */
void KERNEL(qc__store_scaled_single)(const qc__rhs_block *B, int64_t begin, int64_t end) {
    double scale[LANES];
    for (int64_t k = begin; k < end; k += LANES) {
        const int64_t count = end - k < LANES ? end - k : LANES;
        inverse_roots(count, B->F->D + k, scale);
        for (int64_t i = 0; i < count; i++)
            for (int c = 0; c < NC; c++) B->x[NC * (k + i) + c] = scale[i] * B->Y[NC * (k + i) + c];
    }
}
