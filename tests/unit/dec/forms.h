/* Shorthands for the tests of forms. */
#ifndef QC_TEST_FORMS_H
#define QC_TEST_FORMS_H

#include <complex.h>

#include <qc/dec.h>

#include "unit/cover/surfaces.h"

static inline double *cotangents(qc_ctx *ctx, const qc_mesh *m) {
    double *c = NEW_ARRAY(double, 3 * m->n_faces);
    assert_int_equal(qc_mesh_geometry(ctx, m, NULL, NULL, c, NULL, NULL, NULL), QC_OK);
    return c;
}

static inline double _Complex number(qc_complex a) {
    double _Complex z = 0;
    memcpy(&z, &a, sizeof(z));
    return z;
}

/* A form with random values: the three of a face sum to zero. */
static inline qc_complex *random_form(const qc_mesh *m) {
    qc_complex *z = random_numbers(3 * m->n_faces);
    for (int32_t t = 0; t < m->n_faces; t++) {
        z[3 * t].re = -z[3 * t + 1].re - z[3 * t + 2].re;
        z[3 * t].im = -z[3 * t + 1].im - z[3 * t + 2].im;
    }
    return z;
}

static inline double norm(const qc_mesh *m, const double *cot, const qc_complex *z) {
    return sqrt(qc_form_product(m, cot, z, z).re);
}

/* |<a,b>| / (|a| |b|), 0 when one of them is (up to rounding against `size`) zero. */
static inline double cosine(const qc_mesh *m, const double *cot, const qc_complex *a,
                            const qc_complex *b, double size) {
    const double na = norm(m, cot, a), nb = norm(m, cot, b);
    if (na < 1e-11 * size || nb < 1e-11 * size) return 0;
    return cabs(number(qc_form_product(m, cot, a, b))) / (na * nb);
}

static inline double largest(int32_t n, const qc_complex *z) {
    double max = 0;
    for (int32_t i = 0; i < n; i++) max = fmax(max, hypot(z[i].re, z[i].im));
    return max;
}

/* Dense copy of a Hermitian matrix, column-major. */
static inline double _Complex *dense(const qc_hermitian *A) {
    const size_t n = (size_t)A->n;
    double _Complex *D = NEW_ARRAY(double _Complex, n *n);
    for (int32_t j = 0; j < A->n; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            D[A->row[p] + j * A->n] = number(A->val[p]);
            D[j + A->row[p] * A->n] = conj(number(A->val[p]));
        }
    return D;
}

/* Values of a function with zeros where qc_stiffness has no unknown. */
static inline qc_complex *random_function(const qc_stiffness *s, int32_t n) {
    qc_complex *f = random_numbers(n);
    for (int32_t i = 0; i < n; i++)
        if (s->unknown[i] < 0) f[i] = (qc_complex){0, 0};
    return f;
}

#endif
