/* Minimises the untangling energy of one patch (see energy.h): L-BFGS preconditioned by the
 * Laplacian of the patch, in rounds of falling regularisation. */
#include "sdk/map/untangle/lbfgs.h"
#include "sdk/map/untangle/energy.h"
#include <math.h>
#include <string.h>

static const double eps_floor = 1e-3, eps_slope = 0.04; /* eps^2 = floor^2 + slope min(0, det)^2 */
static const double clean_det = 0.01; /* one more round after the patch is clean  */

enum {
    PATIENCE = 4
}; /* rounds without a better worst determinant before giving up               */

/* Preconditioner: the Laplacian of the patch in the charts of its vertices, complex Hermitian. */
typedef struct preconditioner {
    qc__patch *patch;
    qc_symbolic *symbolic;
    qc_factor *factor;
} preconditioner;

typedef struct entry {
    int32_t row;
    qc_complex value;
} entry;

static double patch_evaluate(void *user, const double *x, double *gradient) {
    const preconditioner *p = user;
    return qc__patch_energy(p->patch, x, gradient);
}

static qc_status patch_precondition(qc_ctx *ctx, void *user, double *x) {
    const preconditioner *p = user;
    return qc_solve(ctx, p->factor, 1, (qc_complex *)(void *)x);
}

/* Adds an off-diagonal entry of column j, merging duplicates: rows of a column are few. */
static void add_entry(entry *column, int32_t *n, int32_t row, qc_complex value) {
    int32_t i = 0;
    while (i < *n && column[i].row < row) i++;
    if (i < *n && column[i].row == row) {
        column[i].value.re += value.re;
        column[i].value.im += value.im;
        return;
    }
    memmove(column + i + 1, column + i, sizeof *column * (size_t)(*n - i));
    column[i] = (entry){row, value};
    ++*n;
}

/* Column j of the upper triangle; `column` has room for two entries a face at the vertex and one
 * more. */
static int32_t laplacian_column(const qc__patch *p, int32_t j, entry *column) {
    const qc_mesh *mesh = p->map->mesh;
    const int32_t start = mesh->vertex_corner[p->vertex[j]];
    int32_t n = 0, c = start;
    double diagonal = 0;
    do {
        const int32_t t = c / 3;
        const qc_complex *hat = p->hat + 3 * (int64_t)t;
        for (int32_t k = 0; k < 3; k++) {
            const int32_t b = 3 * t + k, i = p->local[mesh->face_vertex[b]];
            const double K = p->area[t] * (hat[c % 3].re * hat[k].re + hat[c % 3].im * hat[k].im);
            if (b == c) diagonal += K;
            if (b == c || i < 0 || i > j) continue;
            const qc_complex value = {K, 0}; /* conj(i^turn_i) K i^turn_j */
            add_entry(column, &n, i, qc_quarter_turn(value, p->map->turn[c] - p->map->turn[b]));
        }
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
    const qc_complex shifted = {diagonal * (1 + 1e-6), 0};
    add_entry(column, &n, j, shifted);
    return n;
}

static int32_t valence(const qc_mesh *mesh, int32_t v) {
    const int32_t start = mesh->vertex_corner[v];
    int32_t n = 0, c = start;
    do {
        n++;
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
    return n;
}

static qc_status factor_patch(qc_ctx *ctx, preconditioner *pre) {
    const qc__patch *p = pre->patch;
    const int32_t n = p->n_vertices;
    int64_t room = 0, largest = 0;
    for (int32_t j = 0; j < n; j++) {
        const int64_t need = 2 * (int64_t)valence(p->map->mesh, p->vertex[j]) + 2;
        room += need;
        if (need > largest) largest = need;
    }
    int64_t *colptr = QC__NEW(ctx, int64_t, n + 1);
    int32_t *row = QC__NEW(ctx, int32_t, room);
    qc_complex *value = QC__NEW(ctx, qc_complex, room);
    entry *column = QC__NEW(ctx, entry, largest);
    qc_status status = colptr && row && value && column ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        int64_t at = 0;
        for (int32_t j = 0; j < n; j++) {
            colptr[j] = at;
            const int32_t entries = laplacian_column(p, j, column);
            for (int32_t i = 0; i < entries; i++, at++) {
                row[at] = column[i].row;
                value[at] = column[i].value;
            }
        }
        colptr[n] = at;
        const qc_hermitian A = {n, colptr, row, value};
        status = qc_analyze(ctx, &A, NULL, &pre->symbolic);
        if (status == QC_OK) status = qc_factorize(ctx, pre->symbolic, &A, &pre->factor);
    }
    qc__free(colptr);
    qc__free(row);
    qc__free(value);
    qc__free(column);
    return status;
}

qc_status qc__patch_minimise(qc_ctx *ctx, qc__patch *p, const qc_untangle_options *options,
                             double *x) {
    preconditioner pre = {p, NULL, NULL};
    qc_status status = factor_patch(ctx, &pre);
    const qc__lbfgs_problem problem = {2 * (int64_t)p->n_vertices, &pre, patch_evaluate,
                                       patch_precondition};
    double best = -INFINITY;
    int32_t waiting = 0;
    bool polished = false;
    for (int32_t round = 0; round < options->max_rounds && status == QC_OK; round++) {
        const double least = qc__patch_min_det(p, x), below = least < 0 ? least : 0;
        if (polished) break;
        polished = least > clean_det;
        waiting = least > best + 1e-3 * fabs(best) || round == 0 ? 0 : waiting + 1;
        if (least > best) best = least;
        if (waiting > PATIENCE) break;
        p->eps = sqrt(eps_floor * eps_floor + eps_slope * below * below);
        status = qc__lbfgs(ctx, &problem, options->max_iterations, 1e-7, x, NULL, NULL);
    }
    qc_factor_free(pre.factor);
    qc_symbolic_free(pre.symbolic);
    return status;
}
