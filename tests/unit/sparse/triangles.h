/* Matrices made of triangles, as those of meshes are, and flips of their matching. */
#ifndef QC_TEST_SPARSE_TRIANGLES_H
#define QC_TEST_SPARSE_TRIANGLES_H

#include "support.h"

/* Strip of triangles (t, t+1, t+2) and some random ones; every triangle is a clique. */
static inline test_matrix triangles(int32_t n, int32_t extra, int32_t (*triangle)[3],
                                    int32_t *count) {
    int32_t(*edge)[2] = malloc((size_t)(n + extra) * 3 * sizeof *edge);
    int64_t ne = 0;
    *count = 0;
    for (int32_t t = 0; t < n - 2 + extra; t++) {
        int32_t a = t, b = t + 1, c = t + 2;
        if (t >= n - 2) a = pick(n), b = pick(n), c = pick(n);
        if (a == b || b == c || a == c) continue;
        triangle[*count][0] = a, triangle[*count][1] = b, triangle[(*count)++][2] = c;
        edge[ne][0] = a, edge[ne++][1] = b;
        edge[ne][0] = b, edge[ne++][1] = c;
        edge[ne][0] = c, edge[ne++][1] = a;
    }
    test_matrix M = from_edges(n, ne, (const int32_t(*)[2])edge, 1.0);
    free(edge);
    return M;
}

static inline qc_complex *entry(test_matrix *M, int32_t row, int32_t column) {
    int64_t p = M->colptr[column];
    while (M->row[p] != row) p++;
    return &M->val[p];
}

/* D(k,l) += d and the conjugate */
static inline void add(test_matrix *M, int32_t k, int32_t l, qc_complex d) {
    qc_complex *a = k < l ? entry(M, k, l) : entry(M, l, k);
    a->re += d.re;
    a->im += k < l ? d.im : -d.im;
}

/* Turns A(k,l) by i^r, as a flip of the matching does. */
static inline qc_complex turn(test_matrix *M, int32_t k, int32_t l, int r) {
    const qc_complex *a = k < l ? entry(M, k, l) : entry(M, l, k);
    const cplx x = a->re + I * (k < l ? a->im : -a->im);
    const cplx powers[4] = {1, I, -1, -I}, d = x * powers[r] - x;
    return (qc_complex){creal(d), cimag(d)};
}

/* A random flip: rows and changes. */
typedef struct flip {
    int32_t k, l, m;
    qc_complex dl, dm;
} flip;

static inline flip random_flip(test_matrix *M, int32_t (*triangle)[3], int32_t count) {
    const int32_t *t = triangle[pick(count)], at = pick(3);
    flip f = {t[at], t[(at + 1) % 3], t[(at + 2) % 3], {0, 0}, {0, 0}};
    const int r = 1 + pick(3);
    f.dl = turn(M, f.k, f.l, r);
    f.dm = turn(M, f.k, f.m, r);
    return f;
}
static inline qc_status apply_flip(qc_ctx *ctx, qc_factor *F, flip f) {
    return qc_flip(ctx, F, f.k, f.l, f.dl, f.m, f.dm);
}
static inline void add_flip(test_matrix *M, flip f) {
    add(M, f.k, f.l, f.dl);
    add(M, f.k, f.m, f.dm);
}

#endif
