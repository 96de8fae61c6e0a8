/* The inner loops of small fronts: several columns times several multipliers, subtracted. Complex
 * callers pass each column twice, as x and i x, which makes the loop the same as for real numbers.
 */
#include "sdk/sparse/internal.h"

static void subtract4x4(int64_t n, const double *X, int64_t ldx, const double *c, double *y,
                        int64_t ldy) {
    const double *restrict x0 = X, *restrict x1 = X + ldx, *restrict x2 = X + 2 * ldx,
                           *restrict x3 = X + 3 * ldx;
    double *restrict y0 = y, *restrict y1 = y + ldy, *restrict y2 = y + 2 * ldy,
                     *restrict y3 = y + 3 * ldy;
    for (int64_t i = 0; i < n; i++) {
        const double a = x0[i], b = x1[i], e = x2[i], f = x3[i];
        y0[i] -= a * c[0] + b * c[4] + e * c[8] + f * c[12];
        y1[i] -= a * c[1] + b * c[5] + e * c[9] + f * c[13];
        y2[i] -= a * c[2] + b * c[6] + e * c[10] + f * c[14];
        y3[i] -= a * c[3] + b * c[7] + e * c[11] + f * c[15];
    }
}

static void subtract4x1(int64_t n, const double *restrict x, const double *c, double *y,
                        int64_t ldy) {
    double *restrict y0 = y, *restrict y1 = y + ldy, *restrict y2 = y + 2 * ldy,
                     *restrict y3 = y + 3 * ldy;
    for (int64_t i = 0; i < n; i++) {
        y0[i] -= x[i] * c[0];
        y1[i] -= x[i] * c[1];
        y2[i] -= x[i] * c[2];
        y3[i] -= x[i] * c[3];
    }
}

void qc__subtract4(int64_t n, int64_t K, const double *X, int64_t ldx, const double *c, double *y,
                   int64_t ldy) {
    double local[16];
    int64_t k = 0;
    for (; k + 4 <= K; k += 4) {
        for (int q = 0; q < 16; q++)
            local[q] = c[k * 4 + q]; /* no alias with y: stays in registers */
        subtract4x4(n, X + k * ldx, ldx, local, y, ldy);
    }
    for (; k < K; k++) {
        for (int q = 0; q < 4; q++) local[q] = c[k * 4 + q];
        subtract4x1(n, X + k * ldx, local, y, ldy);
    }
}

void qc__subtract1(int64_t n, int64_t K, const double *X, int64_t ldx, const double *c, double *y) {
    double *restrict out = y;
    int64_t k = 0;
    for (; k + 4 <= K; k += 4) {
        const double *restrict x0 = X + k * ldx, *restrict x1 = x0 + ldx, *restrict x2 = x1 + ldx,
                               *restrict x3 = x2 + ldx;
        const double c0 = c[k], c1 = c[k + 1], c2 = c[k + 2], c3 = c[k + 3];
        for (int64_t i = 0; i < n; i++) out[i] -= x0[i] * c0 + x1[i] * c1 + x2[i] * c2 + x3[i] * c3;
    }
    for (; k < K; k++) {
        const double *restrict x = X + k * ldx;
        const double ck = c[k];
        for (int64_t i = 0; i < n; i++) out[i] -= x[i] * ck;
    }
}
