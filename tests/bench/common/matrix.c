/* The matrix of qc.hodge, L* of Kaelberer 2013 (3.7), and the rank-2 changes by which a matching
 * flip (6.2.1) changes it: D(k,l) = (i - 1) A(k,l), D(k,m) = (i - 1) A(k,m) for the three edges k,
 * l, m of a face. */
#include "tests/bench/common/common.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static uint64_t random_state;

static double uniform(void) { /* in [0, 1) */
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 11) / 9007199254740992.0;
}

void bench_random_vector(int64_t n, qc_complex *x) {
    random_state = 1;
    for (int64_t i = 0; i < n; i++) {
        x[i].re = 2 * uniform() - 1;
        x[i].im = 2 * uniform() - 1;
    }
}

static qc_complex times(qc_complex a, qc_complex b) {
    return (qc_complex){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
static qc_complex conjugate(qc_complex a) {
    return (qc_complex){a.re, -a.im};
}

/* A(i,j), the rows being sorted. */
static qc_complex entry(const qc_hermitian *A, int32_t i, int32_t j) {
    const int32_t row = i < j ? i : j, column = i < j ? j : i;
    for (int64_t p = A->colptr[column]; p < A->colptr[column + 1]; p++)
        if (A->row[p] == row) return i < j ? A->val[p] : conjugate(A->val[p]);
    return (qc_complex){0, 0};
}

/* The rows of an edge and of the other two edges of its second face; its midpoint. */
static void find_rows(bench_matrix *M, const qc_mesh *mesh) {
    const int32_t *unknown = M->stiffness->unknown;
    M->path = bench_alloc((size_t)M->A.n, sizeof *M->path);
    M->position = NEW(double, 3 * (int64_t)M->A.n);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[2 * e + 1];
        if (unknown[e] < 0) continue;
        int32_t *row = M->path[unknown[e]];
        for (int c = 0; c < 3; c++)
            M->position[3 * unknown[e] + c] =
                0.5 * (mesh->position[3 * mesh->edge_vertex[2 * e] + c] +
                       mesh->position[3 * mesh->edge_vertex[2 * e + 1] + c]);
        row[0] = -1;
        if (h < 0) continue;
        const int32_t l = unknown[mesh->halfedge_edge[qc_next(h)]];
        const int32_t m = unknown[mesh->halfedge_edge[qc_prev(h)]];
        if (l < 0 || m < 0 || l == m) continue;
        row[0] = unknown[e];
        row[1] = l;
        row[2] = m;
    }
}

/* With c^2 = |dl|^2 + |dm|^2 the eigenvalues are +-c, the vectors (+-c, conj dl, conj dm). */
static void fill_flip(const qc_hermitian *A, const int32_t row[3], bench_flip *f) {
    const qc_complex turn = {-1, 1};
    for (int i = 0; i < 3; i++) f->row[i] = row[i];
    f->dl = times(turn, entry(A, row[0], row[1]));
    f->dm = times(turn, entry(A, row[0], row[2]));
    const double c = hypot(hypot(f->dl.re, f->dl.im), hypot(f->dm.re, f->dm.im));
    const double scale = 1 / sqrt(2 * c);
    for (int q = 0; q < 2; q++) {
        const qc_complex dl = conjugate(f->dl), dm = conjugate(f->dm);
        f->w[q][0] = (qc_complex){(q ? -c : c) * scale, 0};
        f->w[q][1] = (qc_complex){dl.re * scale, dl.im * scale};
        f->w[q][2] = (qc_complex){dm.re * scale, dm.im * scale};
    }
}

bench_matrix *bench_make_matrix(qc_ctx *ctx, const char *name, const qc_matching *matching,
                                int32_t flips) {
    const qc_mesh *mesh = matching->field->mesh;
    const qc_cover cover = {mesh, matching->m};
    double *cotangent = NEW(double, 3 * mesh->n_faces);
    bench_matrix *M = NEW(bench_matrix, 1);
    snprintf(M->name, sizeof M->name, "%s", name);
    M->faces = mesh->n_faces;
    bench_check(ctx, qc_mesh_geometry(ctx, mesh, NULL, NULL, cotangent, NULL, NULL, NULL));
    bench_check(ctx, qc_stiffness_edges(ctx, &cover, cotangent, &M->stiffness));
    free(cotangent);
    M->A = M->stiffness->A;
    find_rows(M, mesh);
    M->flips = NEW(bench_flip, flips);
    random_state = 1;
    while (M->n_flips < flips) {
        const int32_t *row = M->path[(int32_t)(uniform() * M->A.n)];
        if (row[0] >= 0) fill_flip(&M->A, row, &M->flips[M->n_flips++]);
    }
    return M;
}

void bench_matrix_free(bench_matrix *M) {
    qc_stiffness_free(M->stiffness);
    free(M->path);
    free(M->position);
    free(M->flips);
    free(M);
}

static void subtract(qc_complex *y, qc_complex a, qc_complex x) {
    const qc_complex p = times(a, x);
    y->re -= p.re;
    y->im -= p.im;
}

static double largest(int32_t n, const qc_complex *x) {
    double most = 0;
    for (int32_t i = 0; i < n; i++) most = fmax(most, hypot(x[i].re, x[i].im));
    return most;
}

double bench_residual(const bench_matrix *M, const bench_flip *f, const qc_complex *b,
                      const qc_complex *x) {
    const qc_hermitian *A = &M->A;
    qc_complex *r = NEW(qc_complex, A->n);
    double norm = 0;
    for (int32_t i = 0; i < A->n; i++) r[i] = b[i];
    for (int32_t j = 0; j < A->n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t i = A->row[p];
            subtract(&r[i], A->val[p], x[j]);
            if (i != j) subtract(&r[j], conjugate(A->val[p]), x[i]);
            norm = fmax(norm, hypot(A->val[p].re, A->val[p].im));
        }
    if (f) {
        const int32_t k = f->row[0], l = f->row[1], m = f->row[2];
        subtract(&r[k], f->dl, x[l]);
        subtract(&r[k], f->dm, x[m]);
        subtract(&r[l], conjugate(f->dl), x[k]);
        subtract(&r[m], conjugate(f->dm), x[k]);
    }
    const double result = largest(A->n, r) / (norm * largest(A->n, x) + largest(A->n, b));
    free(r);
    return result;
}
