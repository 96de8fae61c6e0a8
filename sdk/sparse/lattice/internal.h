/* Shared by the files of the lattice search (qc_lattice_round). Not installed. */
#ifndef QC_SPARSE_LATTICE_INTERNAL_H
#define QC_SPARSE_LATTICE_INTERNAL_H

#include "sdk/sparse/internal.h"

/* The closest-vector problem min 1/2 (z - t)^T P (z - t) while it is being solved. */
typedef struct qc__lattice {
    int32_t n;
    const double *P, *t; /* n x n, n */
    double *z, *g;       /* n: present integers; g = P (z - t) */
    int64_t moves, evaluations;
    int64_t work; /* entries of P read by the search with a budget */
} qc__lattice;
/* Calls of qc__progress are this much work apart. */
enum { QC__LATTICE_REPORT = 1 << 20 };

/* Choices which differ by less than this part are ties and go to the lower index, so that rounding
 * errors, which depend on the scale of the input, decide nothing; halves round up for the same
 * reason. */
static const double qc__lattice_tie = 1e-9;
static inline double qc__lattice_nearest(double x) {
    return floor(x + 0.5 + qc__lattice_tie);
}

/* round.c: g from scratch; returns the energy. */
double qc__lattice_gradient(qc__lattice *Q);
/* greedy.c: overwrites z. inverse: P^{-1}, lower triangle, destroyed. */
qc_status qc__lattice_greedy(qc_ctx *ctx, qc__lattice *Q, double *inverse);
/* search.c: lowers the energy until no change of up to `radius` entries by +-1 does. */
qc_status qc__lattice_search(qc_ctx *ctx, qc__lattice *Q, int32_t radius);

/* A basis of Z^n, the columns of U: t = U s, G = U^T P U. */
typedef struct qc__lattice_basis {
    int64_t n;
    double *U, *G, *s; /* n x n, n x n, n */
    int64_t work, budget;
} qc__lattice_basis;
/* reduce.c: from s = t to a reduced basis U, and G. work: n x n space. */
qc_status qc__lattice_reduce(qc_ctx *ctx, qc__lattice_basis *B, const double *P, double *work);

enum { QC__LATTICE_WINDOW = 30 };
/* window.c: the change (width <= QC__LATTICE_WINDOW integers) of the entries index[] of z
 * which lowers the energy most. Returns the change of energy, or 0 when none lowers it by more than
 * `gain`. Adds to *work. Reads P and g. Thread: any. */
double qc__lattice_window(const qc__lattice *Q, const int32_t *index, int32_t width, double gain,
                          double *change, int64_t *work);
/* neighbourhood.c: lowers the energy until Q->work reaches the budget or z is optimal. */
qc_status qc__lattice_neighbourhoods(qc_ctx *ctx, qc__lattice *Q, uint64_t seed, int64_t budget);

#endif
