/* y <- L^{-1} y for one right-hand side: every entry of L is read once, four columns of a panel at
 * a time. */
#include "sdk/sparse/kernels/solve.h"

/* y (n doubles up to a full vector) -= L x for G columns of L; fresh: y is taken as zero. Past the
 * end of a column the next one is read, past the end of the factor its padding. */
static inline void subtract_columns(const int G, bool fresh, int64_t n, const double *L, int64_t ld,
                                    const vec *re, const vec *im, double *y) {
    const int64_t ahead = ahead_of(ld);
    for (int64_t i = 0; i < n; i += LANES) {
        vec sum = fresh ? v_zero() : v_load(y + i);
        for (int g = 0; g < G; g++) {
            const vec l = v_load(L + g * ld + i);
            v_prefetch(L + g * ld + i, ahead);
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
