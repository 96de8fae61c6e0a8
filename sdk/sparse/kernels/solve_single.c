/* Triangular solves with one right-hand side: every entry of L is read once, four columns of a
 * panel at a time, so the speed is that of memory. */
#include "sdk/sparse/kernels/solve.h"

enum { GROUP = 4, AHEAD = 512 };

/* y (n doubles up to a full vector) -= L x for G columns of L; fresh: y is taken as zero. Past the
 * end of a column the next one is read, past the end of the factor its padding. */
static inline void subtract_columns(const int G, bool fresh, int64_t n, const double *L, int64_t ld,
                                    const vec *re, const vec *im, double *y) {
    for (int64_t i = 0; i < n; i += LANES) {
        vec sum = fresh ? v_zero() : v_load(y + i);
        for (int g = 0; g < G; g++) {
            const vec l = v_load(L + g * ld + i);
            v_prefetch(L + g * ld + i + AHEAD);
            if (NC == 2) sum = v_fnma(im[g], v_swap(l), sum);
            sum = v_fnma(re[g], l, sum);
        }
        v_store(y + i, sum);
    }
}

/* x <- L^{-1} x for the triangle of G columns; re, im: what subtract_columns wants of it */
static inline void forward_triangle(const int G, const double *L, int64_t ld, entry *x, vec *re,
                                    vec *im) {
    for (int j = 0; j < G; j++)
        for (int i = j + 1; i < G; i++) x[i] = e_subtract(e_load(L + j * ld + NC * i), x[j], x[i]);
    for (int g = 0; g < G; g++) {
        re[g] = v_set(e_re(x[g]));
        im[g] = v_alternate(e_im(x[g]));
    }
}

/* Columns [k, k + G): own triangle, own rows after the group, rows below. */
static inline void forward_group(const int G, bool fresh, const panel *P, int64_t k, double *x,
                                 double *u) {
    const double *L = P->L + k * P->ld;
    const int64_t next = k + G;
    entry t[GROUP];
    vec re[GROUP], im[GROUP];
    for (int g = 0; g < G; g++) t[g] = e_load(x + NC * (k + g));
    forward_triangle(G, L + NC * k, P->ld, t, re, im);
    for (int g = 0; g < G; g++) e_store(x + NC * (k + g), t[g]);
    if (next < P->w)
        subtract_columns(G, false, NC * (P->w - next), L + NC * next, P->ld, re, im, x + NC * next);
    subtract_columns(G, fresh, NC * P->m, L + NC * P->w, P->ld, re, im, u);
}

static inline void forward_panel(const panel *P, double *x, double *u) {
    int64_t k = 0;
    for (; k + GROUP <= P->w; k += GROUP) forward_group(GROUP, k == 0, P, k, x, u);
    switch (P->w - k) {
    case 3:
        forward_group(3, k == 0, P, k, x, u);
        break;
    case 2:
        forward_group(2, k == 0, P, k, x, u);
        break;
    case 1:
        forward_group(1, k == 0, P, k, x, u);
        break;
    default:
        break;
    }
}

void KERNEL(qc__forward_panel)(const qc_factor *F, int32_t s, double *x, double *u) {
    const panel P = panel_of(F, &F->S->solve.node[s]);
    forward_panel(&P, x, u);
}

static inline void add_to(double *y, entry x) {
    e_store(y, e_add(e_load(y), x));
}

static void clear(int64_t n, double *x) {
    for (int64_t i = 0; i < n; i += LANES) v_store(x + i, v_zero());
}

/* Sum of the update vectors which the children left in their slots. */
static void collect(const qc__rhs_block *B, int32_t s, double *sum) {
    const qc_symbolic *S = B->F->S;
    clear(NC * (S->rowptr[s + 1] - S->rowptr[s]), sum);
    for (int32_t c = S->child[s]; c != -1; c = S->sibling[c]) {
        const qc__solve_node *N = &S->solve.node[c];
        const int32_t *local = S->relative + N->below;
        for (int64_t i = 0; i < N->m; i++)
            add_to(sum + NC * local[i], e_load(B->area + NC * (N->to + i)));
    }
}

/* x, u: room for one supernode */
static void forward_supernode(const qc__rhs_block *B, const qc__solve_node *N, double *sum,
                              double *to, double *x, double *u) {
    const panel P = panel_of(B->F, N);
    const int32_t *local = B->F->S->relative + N->below;
    double *Y = B->Y + NC * (int64_t)N->first;
    for (int64_t k = 0; k < NC * P.w; k += NC)
        e_store(x + k, e_add(e_load(Y + k), e_load(sum + k)));
    forward_panel(&P, x, u);
    for (int64_t k = 0; k < NC * P.w; k += NC) e_store(Y + k, e_load(x + k));
    const double *below = sum + NC * P.w;
    if (N->leaves)
        for (int64_t i = 0; i < NC * P.m; i += NC)
            e_store(to + i, e_add(e_load(u + i), e_load(below + i)));
    else
        for (int64_t i = 0; i < P.m; i++)
            add_to(to + NC * local[i], e_add(e_load(u + NC * i), e_load(below + NC * i)));
    clear(NC * (P.w + P.m + 1), sum);
}

/* A supernode of G columns, most of all: one loop over the rows below for everything. Vectors past
 * the end of the rows are pushed too, to the spare row of the parent. */
static inline void forward_few(const int G, const qc__rhs_block *B, const qc__solve_node *N,
                               double *sum, double *to) {
    const panel P = panel_of(B->F, N);
    const int32_t *target = B->F->S->solve.target + N->push;
    double *Y = B->Y + NC * (int64_t)N->first, *below = sum + NC * G;
    entry x[GROUP];
    vec re[GROUP], im[GROUP];
    for (int g = 0; g < G; g++) x[g] = e_add(e_load(Y + NC * g), e_load(sum + NC * g));
    forward_triangle(G, P.L, P.ld, x, re, im);
    for (int g = 0; g < G; g++) e_store(Y + NC * g, x[g]);
    for (int64_t i = 0; i < NC * P.m; i += LANES) {
        double u[LANES];
        subtract_columns(G, true, LANES, P.L + NC * G + i, P.ld, re, im, u);
        for (int k = 0; k < LANES; k += NC)
            add_to(to + NC * *target++, e_add(e_load(u + k), e_load(below + i + k)));
    }
    clear(NC * (G + P.m + 1), sum);
}

void KERNEL(qc__forward_single)(const qc__rhs_block *B, double *work, int32_t first, int32_t last) {
    const qc_symbolic *S = B->F->S;
    const int64_t step = NC * S->solve.work;
    double *x = work, *u = work + step, *top = work + 2 * step, *stack = work + 3 * step;
    for (int32_t s = first; s <= last; s++) {
        const qc__solve_node *N = &S->solve.node[s];
        double *sum = N->top ? top : stack + NC * N->sum;
        double *to = (N->leaves ? B->area : stack) + NC * N->to;
        if (N->top) collect(B, s, sum);
        switch (N->leaves ? 0 : N->w) {
        case 1:
            forward_few(1, B, N, sum, to);
            break;
        case 2:
            forward_few(2, B, N, sum, to);
            break;
        case 3:
            forward_few(3, B, N, sum, to);
            break;
        case 4:
            forward_few(4, B, N, sum, to);
            break;
        default:
            forward_supernode(B, N, sum, to, x, u);
            break;
        }
    }
}

/* Sums over n doubles, in lanes: p += l x and q += l swap(x) for G columns l of L. */
static inline void dot_columns(const int G, int64_t n, const double *L, int64_t ld, const double *x,
                               vec *p, vec *q) {
    for (int64_t i = 0; i < n; i += LANES) {
        const bool full = i + LANES <= n;
        const vec a = full ? v_load(x + i) : v_load_part(x + i, n - i), b = v_swap(a);
        for (int g = 0; g < G; g++) {
            const double *at = L + g * ld + i;
            const vec l = full ? v_load(at) : v_load_part(at, n - i);
            v_prefetch(at - AHEAD);
            p[g] = v_fma(l, a, p[g]);
            if (NC == 2) q[g] = v_fma(l, b, q[g]);
        }
    }
}

/* Columns [k, k + G); t: values at the rows below. */
static inline void backward_group(const int G, const panel *P, int64_t k, const double *D,
                                  const double *t, double *x) {
    const double *L = P->L + k * P->ld;
    const int64_t next = k + G;
    vec p[GROUP], q[GROUP];
    for (int g = 0; g < GROUP; g++) p[g] = q[g] = v_zero();
    dot_columns(G, NC * P->m, L + NC * P->w, P->ld, t, p, q);
    if (next < P->w) dot_columns(G, NC * (P->w - next), L + NC * next, P->ld, x + NC * next, p, q);
    /* conj(l) x = (l.re x.re + l.im x.im) + i (l.re x.im - l.im x.re) */
    double sum[2 * GROUP];
    entry y[GROUP];
    v_sum_four(p[0], p[1], p[2], p[3], sum);
    if (NC == 2) {
        const vec sign = v_alternate(-1);
        for (int g = 0; g < G; g++) q[g] = v_mul(sign, q[g]);
        v_sum_four(q[0], q[1], q[2], q[3], sum + GROUP);
    }
    for (int g = 0; g < G; g++)
        y[g] = e_scale_subtract(1 / D[k + g], e_load(x + NC * (k + g)), e_pair(sum + g, GROUP));
    for (int i = G - 1; i > 0; i--)
        for (int j = i - 1; j >= 0; j--)
            y[j] = e_subtract_conjugate(e_load(L + j * P->ld + NC * (k + i)), y[i], y[j]);
    for (int g = 0; g < G; g++) e_store(x + NC * (k + g), y[g]);
}

/* t_i = Y at row_i, up to the next multiple of the vector length (repeating the last row). */
static inline void gather_rows(const double *Y, int64_t m, const int32_t *row, double *t) {
    enum { STEP = LANES / NC };
    int64_t i = 0;
    for (; i + STEP <= m; i += STEP)
        v_store(t + NC * i, NC == 2 ? v_gather_pairs(Y, row + i) : v_gather(Y, row + i));
    if (i == m) return;
    int32_t rest[STEP];
    for (int64_t j = 0; j < STEP; j++) rest[j] = row[i + j < m ? i + j : m - 1];
    v_store(t + NC * i, NC == 2 ? v_gather_pairs(Y, rest) : v_gather(Y, rest));
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
        gather_rows(B->Y, P.m, S->rows + N->below, work);
        backward_panel(&P, B->F->D + N->first, work, B->Y + NC * (int64_t)N->first);
    }
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
