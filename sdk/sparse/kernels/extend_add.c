/* Extend-add of the multifrontal method (Duff, Reid 1983): the update matrix of a child, whose rows
 * lie at the ascending places `local` of its parent's rows, is added to the parent's front. Most of
 * these places follow each other, so the work goes by runs of consecutive places. */
#include "sdk/sparse/kernels/kernels.h"
#include "sdk/sparse/kernels/vector.h"

QC__INLINE void add_part(int64_t n, const double *x, double *y) {
    v_store_part(y, v_add(v_load_part(y, n), v_load_part(x, n)), n);
}

QC__INLINE void add(int64_t n, const double *x, double *y) {
    for (; n >= LANES; n -= LANES, x += LANES, y += LANES) v_store(y, v_add(v_load(y), v_load(x)));
    if (n > 0) add_part(n, x, y);
}

static int64_t run_end(int64_t m, const int32_t *local, int64_t i) {
    do i++;
    while (i < m && local[i] == local[i - 1] + 1);
    return i;
}

typedef struct target {
    int64_t r, w;
    double *panel, *U;
} target;

/* Row 0 of a column of the front, whose first w rows do not exist in U. */
QC__INLINE double *column_of(const target *t, int64_t column) {
    return column < t->w ? t->panel + NC * column * t->r
                         : t->U + NC * ((column - t->w) * (t->r - t->w) - t->w);
}

void KERNEL(qc__extend_add)(int64_t m, const int32_t *local, const double *child, int64_t r,
                            int64_t w, double *panel, double *U) {
    const target front = {r, w, panel, U};
    for (int64_t begin = 0; begin < m;) { /* rows begin..end of the child are one run */
        const int64_t end = run_end(m, local, begin), n = NC * (end - begin);
        const int64_t place = NC * (int64_t)local[begin];
        const double *x = child + NC * begin;
        if (n <= LANES) {
            for (int64_t j = 0; j < begin; j++, x += NC * m)
                add_part(n, x, column_of(&front, local[j]) + place);
        } else {
            for (int64_t j = 0; j < begin; j++, x += NC * m)
                add(n, x, column_of(&front, local[j]) + place);
        }
        for (int64_t j = 0; j < end - begin; j++, x += NC * m) /* its own triangle */
            add(n - NC * j, x + NC * j, column_of(&front, local[begin] + j) + place + NC * j);
        begin = end;
    }
}
