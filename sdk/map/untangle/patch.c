/* Minimises the untangling energy of one patch (see energy.h): L-BFGS preconditioned by the
 * Laplacian of the patch, in rounds of falling regularisation. */
#include "sdk/map/untangle/lbfgs.h"
#include "sdk/map/untangle/energy.h"
#include <math.h>
#include <string.h>

static const double eps_floor = 1e-3, eps_slope = 0.04; /* eps^2 = floor^2 + slope min(0, det)^2 */
static const double clean_det = 0.01;  /* one more round after the patch is clean  */
static const double limit_share = 0.9; /* of the way to where a face collapses */

enum {
    PATIENCE = 4
}; /* rounds without a better worst determinant before giving up               */

/* Preconditioner: the Laplacian of the patch on the coordinates which move. Quarter turns between
 * charts swap coordinates and their signs, so the matrix is real with a few entries a row. */
typedef struct preconditioner {
    qc__patch *patch;
    int32_t n;
    int32_t *unknown; /* 2 n_vertices: number of the coordinate, -1 = fixed */
    double *packed;   /* n */
    qc_symbolic *symbolic;
    qc_factor *factor;
} preconditioner;

typedef struct entry {
    int32_t row;
    double value;
} entry;

static double patch_evaluate(void *user, const double *x, double *gradient) {
    const preconditioner *p = user;
    return qc__patch_energy(p->patch, x, gradient);
}

static qc_status patch_precondition(qc_ctx *ctx, void *user, double *x) {
    const preconditioner *p = user;
    const int64_t n = 2 * (int64_t)p->patch->n_vertices;
    for (int64_t i = 0; i < n; i++)
        if (p->unknown[i] >= 0) p->packed[p->unknown[i]] = x[i];
    const qc_status status = qc_solve_real(ctx, p->factor, 1, p->packed);
    for (int64_t i = 0; i < n; i++) x[i] = p->unknown[i] >= 0 ? p->packed[p->unknown[i]] : 0.0;
    return status;
}

/* Adds an off-diagonal entry of a column, merging duplicates: rows of a column are few. */
static void add_entry(entry *column, int32_t *n, int32_t row, double value) {
    int32_t i = 0;
    while (i < *n && column[i].row < row) i++;
    if (i < *n && column[i].row == row) {
        column[i].value += value;
        return;
    }
    memmove(column + i + 1, column + i, sizeof *column * (size_t)(*n - i));
    column[i] = (entry){row, value};
    ++*n;
}

/* Column of coordinate i (0 = u, 1 = v) of vertex j, upper triangle; `column` has room for two
 * entries a face at the vertex and one more. */
static int32_t laplacian_column(const preconditioner *pre, int32_t j, int i, entry *column) {
    const qc__patch *p = pre->patch;
    const qc_mesh *mesh = p->map->mesh;
    const int32_t start = mesh->vertex_corner[p->vertex[j]];
    int32_t n = 0, c = start;
    double diagonal = 0;
    do {
        const int32_t t = c / 3;
        const qc_complex *hat = p->hat + 3 * (int64_t)t;
        for (int32_t k = 0; k < 3; k++) {
            const int32_t b = 3 * t + k, l = p->local[mesh->face_vertex[b]];
            const double K = p->area[t] * (hat[c % 3].re * hat[k].re + hat[c % 3].im * hat[k].im);
            if (b == c) diagonal += K;
            if (b == c || l < 0 || l > j) continue;
            /* i^-turn_l K i^turn_j on the unit vector of the coordinate */
            const qc_complex unit = {i == 0 ? K : 0, i == 0 ? 0 : K};
            const int turn = p->map->turn[c] - p->map->turn[b];
            const qc_complex value = qc_quarter_turn(unit, turn);
            const int other = (i + turn) & 1;
            const int32_t row = pre->unknown[2 * (int64_t)l + other];
            if (row >= 0) add_entry(column, &n, row, other ? value.im : value.re);
        }
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
    add_entry(column, &n, pre->unknown[2 * (int64_t)j + i], diagonal * (1 + 1e-6));
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

static void number_unknowns(preconditioner *pre) {
    const qc__patch *p = pre->patch;
    for (int32_t j = 0; j < p->n_vertices; j++)
        for (int i = 0; i < 2; i++) {
            const bool fixed = p->map->fixed[p->vertex[j]] >> i & 1;
            pre->unknown[2 * (int64_t)j + i] = fixed ? -1 : pre->n++;
        }
}

/* Entries of the upper triangle, at most: of all columns, of the longest. */
static int64_t room_for(const qc__patch *p, int64_t *longest) {
    int64_t room = 0;
    *longest = 0;
    for (int32_t j = 0; j < p->n_vertices; j++) {
        const int64_t need = 2 * (int64_t)valence(p->map->mesh, p->vertex[j]) + 2;
        room += 2 * need;
        if (need > *longest) *longest = need;
    }
    return room;
}

static qc_status factor_patch(qc_ctx *ctx, preconditioner *pre) {
    const qc__patch *p = pre->patch;
    pre->unknown = QC__NEW(ctx, int32_t, 2 * (int64_t)p->n_vertices);
    if (!pre->unknown) return QC_ERR_NOMEM;
    number_unknowns(pre);
    int64_t longest, at = 0;
    const int64_t room = room_for(p, &longest);
    pre->packed = QC__NEW(ctx, double, pre->n);
    int64_t *colptr = QC__NEW(ctx, int64_t, pre->n + 1);
    int32_t *row = QC__NEW(ctx, int32_t, room);
    double *value = QC__NEW(ctx, double, room);
    entry *column = QC__NEW(ctx, entry, longest);
    qc_status status = pre->packed && colptr && row && value && column ? QC_OK : QC_ERR_NOMEM;
    for (int32_t a = 0; status == QC_OK && a < 2 * p->n_vertices; a++) {
        if (pre->unknown[a] < 0) continue;
        colptr[pre->unknown[a]] = at;
        const int32_t entries = laplacian_column(pre, a / 2, a & 1, column);
        for (int32_t i = 0; i < entries; i++, at++) {
            row[at] = column[i].row;
            value[at] = column[i].value;
        }
    }
    if (status == QC_OK) {
        colptr[pre->n] = at;
        const qc_symmetric A = {pre->n, colptr, row, value};
        status = qc_analyze_real(ctx, &A, NULL, &pre->symbolic);
        if (status == QC_OK) status = qc_factorize_real(ctx, pre->symbolic, &A, &pre->factor);
    }
    qc__free(colptr);
    qc__free(row);
    qc__free(value);
    qc__free(column);
    return status;
}

static void release(preconditioner *pre) {
    qc_factor_free(pre->factor);
    qc_symbolic_free(pre->symbolic);
    qc__free(pre->unknown);
    qc__free(pre->packed);
}

qc_status qc__patch_minimise(qc_ctx *ctx, qc__patch *p, const qc_untangle_options *options,
                             double *x) {
    preconditioner pre = {.patch = p};
    qc_status status = factor_patch(ctx, &pre);
    const qc__lbfgs_problem problem = {2 * (int64_t)p->n_vertices, &pre, patch_evaluate,
                                       patch_precondition, NULL};
    double best = -INFINITY;
    int32_t waiting = 0;
    bool polished = false;
    for (int32_t round = 0; round < options->max_rounds && status == QC_OK; round++) {
        const double least = qc__patch_min_det(p, x), below = least < 0 ? least : 0;
        if (polished) break;
        polished = least > clean_det;
        waiting = least > best + 1e-3 * fabs(best) || round == 0 ? 0 : waiting + 1;
        if (least > best) best = least;
        if (waiting > PATIENCE || p->work >= p->work_limit) break;
        p->eps = sqrt(eps_floor * eps_floor + eps_slope * below * below);
        status = qc__lbfgs(ctx, &problem, options->max_iterations, 1e-7, x, NULL, NULL);
    }
    release(&pre);
    return status;
}

static double patch_limit(void *user, const double *x, const double *way) {
    const preconditioner *p = user;
    return limit_share * qc__patch_limit(p->patch, x, way);
}

qc_status qc__patch_relax(qc_ctx *ctx, qc__patch *p, int32_t steps, double *x) {
    preconditioner pre = {.patch = p};
    qc_status status = factor_patch(ctx, &pre);
    const qc__lbfgs_problem problem = {2 * (int64_t)p->n_vertices, &pre, patch_evaluate,
                                       patch_precondition, patch_limit};
    p->positive = true;
    if (status == QC_OK) status = qc__lbfgs(ctx, &problem, steps, 1e-5, x, NULL, NULL);
    p->positive = false;
    release(&pre);
    return status;
}
