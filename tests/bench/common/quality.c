/* What an ordering costs: entries of L and operations (column counts of Gilbert, Ng, Peyton 1994),
 * and the entries of L on the path of the elimination tree which a flip changes. */
#include "tests/bench/common/common.h"

#include <stdlib.h>

#include "sdk/sparse/internal.h"

/* Elimination tree of the permuted pattern and a postorder of it. */
static void tree(qc_ctx *ctx, qc__pattern A, const int32_t *inverse, int32_t *parent,
                 int32_t *work) {
    int64_t *colptr = NULL;
    int32_t *row = NULL;
    bench_check(ctx, qc__permute_upper(ctx, A, inverse, &colptr, &row));
    qc__etree((qc__pattern){A.n, colptr, row}, parent, work);
    qc__free(colptr);
    qc__free(row);
}

static void counts(qc_ctx *ctx, qc__pattern A, const int32_t *inverse, const int32_t *parent,
                   int32_t *count, int32_t *work) {
    int64_t *colptr = NULL, *lower_ptr = NULL;
    int32_t *row = NULL, *lower_row = NULL;
    bench_check(ctx, qc__permute_upper(ctx, A, inverse, &colptr, &row));
    bench_check(ctx, qc__transpose(ctx, (qc__pattern){A.n, colptr, row}, &lower_ptr, &lower_row));
    qc__column_counts((qc__pattern){A.n, lower_ptr, lower_row}, parent, count, work);
    qc__free(colptr);
    qc__free(row);
    qc__free(lower_ptr);
    qc__free(lower_row);
}

static bench_quality sum(const bench_matrix *M, const int32_t *inverse, const int32_t *parent,
                         const int32_t *count) {
    const int32_t n = M->A.n;
    bench_quality q = {0, 0, 0};
    double *path = NEW(double, n); /* entries from a column up to the root */
    int64_t paths = 0;
    for (int32_t j = n; j-- > 0;) {
        const double c = count[j] - 1;
        q.nnz += count[j];
        q.flops += 4 * (c * (c + 1) + c);
        path[j] = count[j] + (parent[j] < 0 ? 0 : path[parent[j]]);
    }
    for (int32_t i = 0; i < n; i++) {
        const int32_t *row = M->path[i];
        if (row[0] < 0) continue;
        int32_t lowest = n - 1;
        for (int k = 0; k < 3; k++)
            if (inverse[row[k]] < lowest) lowest = inverse[row[k]];
        q.touched += path[lowest];
        paths++;
    }
    q.touched /= (double)paths;
    free(path);
    return q;
}

bench_quality bench_order_quality(qc_ctx *ctx, const bench_matrix *M, const int32_t *perm) {
    const int32_t n = M->A.n;
    const qc__pattern A = {n, M->A.colptr, M->A.row};
    int32_t *inverse = NEW(int32_t, n), *parent = NEW(int32_t, n), *count = NEW(int32_t, n);
    int32_t *post = NEW(int32_t, n), *work = NEW(int32_t, 4 * (int64_t)n);
    for (int32_t k = 0; k < n; k++) inverse[perm[k]] = k;
    tree(ctx, A, inverse, parent, work);
    qc__postorder(n, parent, post, work);
    for (int32_t k = 0; k < n; k++) inverse[perm[post[k]]] = k;
    tree(ctx, A, inverse, parent, work);
    counts(ctx, A, inverse, parent, count, work);
    const bench_quality q = sum(M, inverse, parent, count);
    free(inverse);
    free(parent);
    free(count);
    free(post);
    free(work);
    return q;
}
