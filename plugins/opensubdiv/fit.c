/* Control points whose limit surface fits the input, by least squares: limit positions are linear
 * in the control points, x = A p (Halstead, Kass, DeRose 1993). Samples are the limit positions of
 * the vertices, edge midpoints and face centres of the cage. Those of the vertices are to be where
 * the cage vertices were, on the input; the others at the point of the input closest to
 * where they are on the cage, in later rounds on the limit surface. A small term mu |p - p_last|^2
 * keeps the normal matrix A^T A + mu definite. */
#include "parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MU 1e-4

typedef struct normal_matrix {
    int64_t *colptr;
    int32_t *row;
    double *val;
} normal_matrix;

/* The samples each control point takes part in: the transpose of the pattern of A. */
typedef struct users {
    int64_t *offset, *place; /* place: index of the entry in A */
    int32_t *sample;
} users;

static bool make_users(const qo_rows *A, int32_t n, users *u) {
    const int64_t terms = A->offset[A->n];
    u->offset = calloc((size_t)n + 2, sizeof *u->offset);
    u->place = malloc((size_t)(terms + 1) * sizeof *u->place);
    u->sample = malloc((size_t)(terms + 1) * sizeof *u->sample);
    if (!u->offset || !u->place || !u->sample) return false;
    for (int64_t k = 0; k < terms; k++) u->offset[A->column[k] + 2]++;
    for (int32_t j = 1; j <= n; j++) u->offset[j + 1] += u->offset[j];
    for (int32_t i = 0; i < A->n; i++)
        for (int64_t k = A->offset[i]; k < A->offset[i + 1]; k++) {
            const int64_t at = u->offset[A->column[k] + 1]++;
            u->place[at] = k;
            u->sample[at] = i;
        }
    return true;
}

static int by_number(const void *a, const void *b) {
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Column j of the upper triangle of A^T A: the rows met, unsorted, into found; sums into sum. */
static int32_t column(const qo_rows *A, const users *u, int32_t j, int32_t *mark, double *sum,
                      int32_t *found) {
    int32_t count = 0;
    for (int64_t q = u->offset[j]; q < u->offset[j + 1]; q++) {
        const double w = A->weight[u->place[q]];
        const int32_t i = u->sample[q];
        for (int64_t k = A->offset[i]; k < A->offset[i + 1] && A->column[k] <= j; k++) {
            const int32_t r = A->column[k];
            if (mark[r] != j) {
                mark[r] = j;
                sum[r] = 0;
                found[count++] = r;
            }
            sum[r] += w * A->weight[k];
        }
    }
    if (count == 0 || mark[j] != j) { /* a vertex without faces */
        sum[j] = 0;
        found[count++] = j;
    }
    qsort(found, (size_t)count, sizeof *found, by_number);
    return count;
}

/* Two passes: the first counts. */
static bool fill(const qo_rows *A, const users *u, int32_t n, normal_matrix *out) {
    int32_t *mark = malloc(((size_t)n + 1) * sizeof *mark);
    int32_t *found = malloc(((size_t)n + 1) * sizeof *found);
    double *sum = malloc(((size_t)n + 1) * sizeof *sum);
    bool good = mark && found && sum;
    for (int pass = 0; pass < 2 && good; pass++) {
        for (int32_t j = 0; j < n; j++) mark[j] = -1;
        for (int32_t j = 0; j < n; j++) {
            const int32_t count = column(A, u, j, mark, sum, found);
            out->colptr[j + 1] = out->colptr[j] + count;
            for (int32_t k = 0; pass == 1 && k < count; k++) {
                out->row[out->colptr[j] + k] = found[k];
                out->val[out->colptr[j] + k] = sum[found[k]] + (found[k] == j ? MU : 0);
            }
        }
        if (pass == 1) break;
        out->row = malloc((size_t)(out->colptr[n] + 1) * sizeof *out->row);
        out->val = malloc((size_t)(out->colptr[n] + 1) * sizeof *out->val);
        good = out->row && out->val;
    }
    free(mark);
    free(found);
    free(sum);
    return good;
}

static bool make_normal(const qo_rows *A, int32_t n, normal_matrix *out) {
    users u = {NULL, NULL, NULL};
    out->colptr = calloc((size_t)n + 1, sizeof *out->colptr);
    const bool good = out->colptr && make_users(A, n, &u) && fill(A, &u, n, out);
    free(u.offset);
    free(u.place);
    free(u.sample);
    return good;
}

/* --- rounds ----------------------------------------------------------------------------------- */

typedef struct fit {
    const qc_run *run;
    const qo_target *target;
    const qc_solver *solver;
    qc_solver_state *state;
    const double *place; /* of the cage vertices */
    int32_t n;
    qo_rows A;
    double *rhs;    /* 3 columns of n             */
    double *sample; /* where the samples are, 3 each */
} fit;

static void closest_point(const qo_target *t, const double *x, int32_t *nearest, double *out) {
    double weight[3];
    t->closest->query(t->tree, x, nearest, weight);
    for (int k = 0; k < 3; k++) {
        out[k] = 0;
        for (int c = 0; c < 3; c++) {
            const int32_t v = t->mesh->face_vertex[3 * (size_t)*nearest + (size_t)c];
            out[k] += weight[c] * t->mesh->position[3 * (size_t)v + (size_t)k];
        }
    }
}

/* One round: where the samples should be, then the normal equations. */
static qc_status improve(const fit *f, double *control) {
    const size_t n = (size_t)f->n;
    int32_t nearest = 0;
    for (size_t v = 0; v < n; v++)
        for (size_t k = 0; k < 3; k++) f->rhs[k * n + v] = MU * control[3 * v + k];
    for (int32_t i = 0; i < f->A.n; i++) {
        double goal[3];
        if (i < f->n)
            memcpy(goal, f->place + 3 * (size_t)i, sizeof goal);
        else
            closest_point(f->target, f->sample + 3 * (size_t)i, &nearest, goal);
        for (int64_t q = f->A.offset[i]; q < f->A.offset[i + 1]; q++)
            for (size_t k = 0; k < 3; k++)
                f->rhs[k * n + (size_t)f->A.column[q]] += f->A.weight[q] * goal[k];
    }
    const qc_status status = f->solver->solve_real(f->run->ctx, f->state, 3, f->rhs);
    for (size_t v = 0; status == QC_OK && v < n; v++)
        for (size_t k = 0; k < 3; k++) control[3 * v + k] = f->rhs[k * n + v];
    for (int32_t i = 0; status == QC_OK && i < f->A.n; i++)
        for (size_t k = 0; k < 3; k++) {
            double *x = f->sample + 3 * (size_t)i + k;
            *x = 0;
            for (int64_t q = f->A.offset[i]; q < f->A.offset[i + 1]; q++)
                *x += f->A.weight[q] * control[3 * (size_t)f->A.column[q] + k];
        }
    return status;
}

static qc_status factorize(fit *f) {
    normal_matrix N = {NULL, NULL, NULL};
    qc_solver_options options = QC_SOLVER_OPTIONS_INIT;
    options.real = 1;
    qc_status status = make_normal(&f->A, f->n, &N) ? QC_OK : qo_nomem(f->run);
    const qc_hermitian pattern = {f->n, N.colptr, N.row, NULL};
    const qc_symmetric values = {f->n, N.colptr, N.row, N.val};
    if (status == QC_OK)
        status = f->solver->analyze(f->solver, f->run->ctx, &pattern, &options, &f->state);
    if (status == QC_OK) status = f->solver->factorize_real(f->run->ctx, f->state, &values);
    free(N.colptr);
    free(N.row);
    free(N.val);
    return status;
}

qc_status qo_fit(const qc_run *run, const qc_polygon_mesh *cage, const qo_target *target,
                 const qc_solver *solver, int32_t rounds, double *control) {
    fit f = {.run = run,
             .target = target,
             .solver = solver,
             .place = cage->position,
             .n = cage->n_vertices};
    qo_surface *once = NULL;
    if (!(solver->head.flags & QC_SOLVER_REAL))
        return (run->fail)(run, QC_ERR_UNSUPPORTED, -1,
                           "the fit needs a solver for real matrices; take builtin");
    f.rhs = malloc((3 * (size_t)f.n + 1) * sizeof *f.rhs);
    qc_status status = f.rhs ? qo_surface_create(run->ctx, cage, 1, &once) : qo_nomem(run);
    if (status == QC_OK) status = qo_surface_rows(run->ctx, once, &f.A);
    if (status == QC_OK) {
        f.sample = malloc((3 * (size_t)f.A.n + 1) * sizeof *f.sample);
        status = f.sample ? qo_surface_midpoints(run->ctx, once, control, f.sample) : qo_nomem(run);
    }
    if (status == QC_OK) status = factorize(&f);
    for (int32_t i = 0; status == QC_OK && i < rounds; i++) {
        status = run->progress(run, 0.2 + 0.4 * i / rounds) ? QC_OK : QC_ERR_CANCELLED;
        if (status == QC_OK) status = improve(&f, control);
    }
    if (f.state) solver->destroy(f.state);
    qo_rows_free(&f.A);
    qo_surface_destroy(once);
    free(f.rhs);
    free(f.sample);
    return status;
}
