/* Dense partial LDL^H of one front: the columns of its panel (r x w), then the update matrix
 * U <- U - L21 D L21^H. Narrow fronts use own loops, since the overhead of a BLAS call is larger
 * than their work; wide ones go through the Cholesky factor L D^(1/2), for which LAPACK and BLAS-3
 * exist. Compiled twice, see scalar.h. */
#include "sdk/sparse/scalar.h"
#include <cblas.h>
#include <lapacke.h>
#include <math.h>

#ifndef QC__REAL
bool qc__front_uses_blas(int32_t r, int32_t w) {
    return w >= 32 || (w >= 8 && (int64_t)w * r >= 2048);
}

int64_t qc__front_work(int32_t r, int32_t w) {
    if (w >= 32) return 0;
    const int64_t own = 4 * (int64_t)r * w + 8 * (int64_t)w; /* columns x, i x and multipliers */
    const int64_t scaled = 2 * (int64_t)r * w + w;
    return own > scaled ? own : scaled;
}
#endif

/* Multipliers d_k conj(L(j,k)) of the columns k < K for row j, as seen by qc__subtract: stride 4 or
 * 1, two numbers per column in the complex case. */
static void multipliers(int32_t K, const double *panel, int64_t r, int64_t j, const double *D,
                        double *c, int64_t stride) {
    for (int64_t k = 0; k < K; k++) {
        const double *l = panel + NC * (j + k * r);
        c[NC * k * stride] = D[k] * l[0];
        if (NC == 2) c[(NC * k + 1) * stride] = -D[k] * l[1];
    }
}

/* Columns x, i x of the finished column k from row `from` on; X has leading dimension NC r. */
static void copy_column(const double *panel, int64_t r, int64_t k, int64_t from, double *X) {
    const double *l = panel + NC * k * r;
    double *x = X + NC * NC * k * r;
    for (int64_t i = NC * from; i < NC * r; i++) x[i] = l[i];
    if (NC == 1) return;
    double *ix = x + NC * r;
    for (int64_t i = from; i < r; i++) {
        ix[2 * i] = -l[2 * i + 1];
        ix[2 * i + 1] = l[2 * i];
    }
}

/* Subtracts the columns [0, K) of the panel from the lower triangle of y, columns [begin, end); the
 * entry (i, j) of y belongs to the rows row + i, row + j of the panel. */
static void subtract_columns(int32_t K, const double *panel, int64_t r, const double *D,
                             const double *X, double *c, int64_t begin, int64_t end, int64_t row,
                             double *y, int64_t ld) {
    for (int64_t j = begin; j < end;) {
        const int64_t i = row + j, n = NC * (r - i), width = end - j >= 4 ? 4 : 1;
        double *column = y + NC * (j + j * ld);
        for (int64_t q = 0; q < width; q++) multipliers(K, panel, r, i + q, D, c + q, width);
        if (width == 4)
            qc__subtract4(n, NC * K, X + NC * i, NC * r, c, column, NC * ld);
        else
            qc__subtract1(n, NC * K, X + NC * i, NC * r, c, column);
        j += width;
    }
}

/* Right-looking elimination of the columns [k0, k1), whose earlier columns are subtracted. */
static int32_t eliminate_block(int64_t r, int32_t k0, int32_t k1, double *panel, double *D,
                               const double *floor) {
    for (int64_t k = k0; k < k1; k++) {
        double *x = panel + NC * k * r;
        const double d = x[NC * k];
        if (!(d > floor[k])) return (int32_t)k;
        D[k] = d;
        const double inverse = 1 / d;
        for (int64_t i = NC * (k + 1); i < NC * r; i++) x[i] *= inverse;
        for (int64_t j = k + 1; j < k1; j++) {
            double *restrict y = panel + NC * j * r;
            const double cr = d * x[NC * j], ci = NC == 2 ? -d * x[NC * j + NC - 1] : 0;
            for (int64_t i = j; i < r; i++) {
                if (NC == 1) {
                    y[i] -= x[i] * cr;
                } else {
                    y[2 * i] -= x[2 * i] * cr - x[2 * i + 1] * ci;
                    y[2 * i + 1] -= x[2 * i] * ci + x[2 * i + 1] * cr;
                }
            }
        }
        x[NC * k] = 1;
        if (NC == 2) x[NC * k + 1] = 0;
    }
    return -1;
}

/* U <- U - B B^H, B: m x w */
static void herk(int32_t m, int32_t w, const double *B, int32_t ldb, double *U) {
#ifdef QC__REAL
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, m, w, -1, B, ldb, 1, U, m);
#else
    cblas_zherk(CblasColMajor, CblasLower, CblasNoTrans, m, w, -1, B, ldb, 1, U, m);
#endif
}

static int32_t own_factor(int32_t r, int32_t w, double *panel, double *U, double *D,
                          const double *floor, double *work) {
    const int64_t m = r - w;
    double *X = work, *c = work + NC * NC * (int64_t)r * w;
    for (int32_t k = 0; k < w; k += 4) {
        const int32_t end = k + 4 < w ? k + 4 : w;
        if (k > 0) subtract_columns(k, panel, r, D, X, c, k, end, 0, panel, r);
        const int32_t bad = eliminate_block(r, k, end, panel, D, floor);
        if (bad >= 0) return bad;
        for (int32_t j = k; j < end; j++) copy_column(panel, r, j, end, X);
    }
    if (m == 0) return -1;
    if (!qc__front_uses_blas(r, w)) {
        subtract_columns(w, panel, r, D, X, c, 0, m, w, U, m);
        return -1;
    }
    for (int64_t k = 0; k < w; k++) { /* B = L21 D^(1/2) */
        const double *l = panel + NC * (k * r + w);
        const double scale = sqrt(D[k]);
        for (int64_t i = 0; i < NC * m; i++) X[NC * k * m + i] = scale * l[i];
    }
    herk((int32_t)m, w, X, (int32_t)m, U);
    return -1;
}

static int32_t blas_factor(int32_t r, int32_t w, double *panel, double *U, double *D,
                           const double *floor) {
    const int32_t m = r - w;
    double *below = panel + NC * (int64_t)w;
#ifdef QC__REAL
    const int32_t info = (int32_t)LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', w, panel, r);
#else
    const int32_t info =
        (int32_t)LAPACKE_zpotrf_work(LAPACK_COL_MAJOR, 'L', w, (lapack_complex_double *)panel, r);
#endif
    const int32_t good = info > 0 ? info - 1 : w;
    for (int64_t k = 0; k < good; k++) {
        const double l = panel[NC * (k + k * r)];
        D[k] = l * l;
        if (!(D[k] > floor[k])) return (int32_t)k;
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
        herk(m, w, below, r, U);
    }
    for (int64_t k = 0; k < w; k++) { /* L <- L D^(-1/2) */
        double *l = panel + NC * k * r;
        const double inverse = 1 / l[NC * k];
        for (int64_t i = NC * (k + 1); i < NC * (int64_t)r; i++) l[i] *= inverse;
        l[NC * k] = 1;
        if (NC == 2) l[NC * k + 1] = 0;
    }
    return -1;
}

int32_t NAME(qc__front_factor)(int32_t r, int32_t w, double *panel, double *U, double *D,
                               const double *floor, double *work) {
    if (w >= 32) return blas_factor(r, w, panel, U, D, floor);
    return own_factor(r, w, panel, U, D, floor, work);
}
