/* Lattice problems like those of cones on a sphere, for the tests of sdk/sparse/lattice. */
#ifndef QC_TESTS_LATTICE_PROBLEM_H
#define QC_TESTS_LATTICE_PROBLEM_H

#include "sdk/sparse/lattice/internal.h"
#include "support.h"

/* P = B^T K B: K couples random points of the plane like a Green's function, B is unimodular with
 * dense columns, as bases along a cut graph are. */
static inline void cone_problem(int32_t n, double *P, double *t) {
    const size_t square = (size_t)n * (size_t)n * sizeof(double);
    double *K = malloc(square), *B = calloc(1, square), *place = malloc(2 * (size_t)n * sizeof *K);
    for (int32_t i = 0; i < 2 * n; i++) place[i] = uniform();
    for (int64_t i = 0; i < n; i++) {
        for (int64_t j = 0; j < n; j++)
            K[i + j * n] =
                exp(-2 * hypot(place[2 * i] - place[2 * j], place[2 * i + 1] - place[2 * j + 1])) +
                (i == j ? 0.02 : 0);
        B[i + i * n] = 1;
        for (int64_t j = i + 1; j < n && j < i + 6; j++) B[i + j * n] = uniform() > 0 ? 1 : 0;
        t[i] = 5 * uniform();
    }
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++) {
            double sum = 0;
            for (int64_t k = 0; k < n; k++)
                for (int64_t l = 0; l < n && B[k + i * n] != 0; l++)
                    sum += B[k + i * n] * K[k + l * n] * B[l + j * n];
            P[i + j * n] = sum;
        }
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < i; j++) P[i + j * n] = P[j + i * n];
    free(K);
    free(B);
    free(place);
}

#endif
