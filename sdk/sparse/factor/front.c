/* Dense partial LDL^H of one front: the columns of its panel (r x w) in blocks, and after each
 * block what it contributes to the later columns and to the update matrix U <- U - L21 D L21^H.
 * Where the kernels of this processor lose against BLAS, wide fronts go through the Cholesky factor
 * L D^(1/2), for which LAPACK and BLAS-3 exist. Compiled twice, see scalar.h. */
#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include "sdk/sparse/factor/scalar.h"

typedef struct block {
    const qc__kernels *kernels;
    const qc__front *f;
    int32_t k0, k1;
    const double *B;
    bool fresh;
} block;

static void subtract_tiles(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const block *b = arg;
    const qc__front *f = b->f;
    _Alignas(64) double copy[QC__TILE_LANES * QC__FRONT_BLOCK];
    (void)worker;
    for (int64_t t = begin; t < end; t++)
        b->kernels->front_subtract(f->r, f->w, b->k0, b->k1, f->panel, f->U, b->B, b->fresh, t,
                                   copy);
}

/* Row tiles are shared among the threads when this front is worth it. */
static int32_t own_factor(qc_ctx *ctx, const qc__kernels *kernels, const qc__front *f) {
    for (int32_t k0 = 0; k0 < f->w; k0 += QC__FRONT_BLOCK) {
        const int32_t k1 = k0 + QC__FRONT_BLOCK < f->w ? k0 + QC__FRONT_BLOCK : f->w;
        if (ctx && !qc__progress(ctx, (double)k0 / f->w)) return QC__CANCELLED;
        const int32_t bad =
            kernels->front_factor_block(f->r, k0, k1, f->panel, f->D, f->floor, f->work);
        if (bad >= 0) return bad;
        if (k1 == f->r) break;
        kernels->front_pack(f->r, f->w, k0, k1, f->panel, f->D, f->work);
        block b = {kernels, f, k0, k1, f->work, f->fresh && k0 == 0};
        const int64_t tiles = kernels->front_tiles(f->r, f->w, k1);
        if (ctx && tiles > 16)
            qc__parallel_for(ctx, tiles, 4, subtract_tiles, &b);
        else
            subtract_tiles(&b, 0, tiles, 0);
    }
    return QC__DONE;
}

/* U <- beta U - B B^H, B: m x w */
static void herk(int32_t m, int32_t w, const double *B, int32_t ldb, double beta, double *U) {
#ifdef QC__REAL
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, m, w, -1, B, ldb, beta, U, m);
#else
    cblas_zherk(CblasColMajor, CblasLower, CblasNoTrans, m, w, -1, B, ldb, beta, U, m);
#endif
}

static int32_t blas_factor(const qc__front *f) {
    const int32_t r = f->r, w = f->w, m = r - w;
    double *panel = f->panel, *below = panel + NC * (int64_t)w;
#ifdef QC__REAL
    const int32_t info = (int32_t)LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', w, panel, r);
#else
    const int32_t info =
        (int32_t)LAPACKE_zpotrf_work(LAPACK_COL_MAJOR, 'L', w, (lapack_complex_double *)panel, r);
#endif
    const int32_t good = info > 0 ? info - 1 : w;
    for (int64_t k = 0; k < good; k++) {
        const double l = panel[NC * (k + k * r)];
        f->D[k] = l * l;
        if (!(f->D[k] > f->floor[k])) return (int32_t)k;
    }
    if (good < w) return good;
    if (m > 0) {
#ifdef QC__REAL
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, m, w, 1, panel,
                    r, below, r);
#else
        const double one[2] = {1, 0};
        cblas_ztrsm(CblasColMajor, CblasRight, CblasLower, CblasConjTrans, CblasNonUnit, m, w, one,
                    panel, r, below, r);
#endif
        herk(m, w, below, r, f->fresh ? 0 : 1, f->U);
    }
    for (int64_t k = 0; k < w; k++) { /* L <- L D^(-1/2) */
        double *l = panel + NC * k * r;
        const double inverse = 1 / l[NC * k];
        for (int64_t i = NC * (k + 1); i < NC * (int64_t)r; i++) l[i] *= inverse;
        l[NC * k] = 1;
        if (NC == 2) l[NC * k + 1] = 0;
    }
    return QC__DONE;
}

int32_t NAME(qc__front_factor)(qc_ctx *ctx, const qc__kernels *kernels, const qc__front *f) {
    return f->w >= kernels->blas_width ? blas_factor(f) : own_factor(ctx, kernels, f);
}

#ifndef QC__REAL
int64_t qc__front_work(int32_t r, int32_t w) {
    const int64_t K = w < QC__FRONT_BLOCK ? w : QC__FRONT_BLOCK;
    return NC * K * ((int64_t)r + 8);
}
#endif
