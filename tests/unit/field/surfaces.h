/* Surfaces and directions for the tests of sdk/field. */
#ifndef QC_TEST_FIELD_SURFACES_H
#define QC_TEST_FIELD_SURFACES_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <qc/field.h>

#include "unit/context.h"

static const double PI = 3.14159265358979323846;

/* Uniform numbers in [0, 1), the same on every machine. */
static inline double uniform(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

enum { PLANE, CYLINDER, TORUS };

/* n x m cells split along alternating diagonals. PLANE: [0,1]^2; CYLINDER: radius 1, height 4,
 * open; TORUS: radii 3 and 1. */
static inline qc_mesh *grid(qc_ctx *ctx, int kind, int n, int m, double scale) {
    int nv = n + (kind == PLANE), mv = m + (kind != TORUS), f = 0;
    double *p = malloc(sizeof *p * 3 * (size_t)(nv * mv));
    int32_t *t = malloc(sizeof *t * 6 * (size_t)(n * m));
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < mv; j++) {
            double *q = p + 3 * (i * mv + j), a = 2 * PI * i / n, b = 2 * PI * j / m;
            double r = kind == TORUS ? 3 + cos(b) : 1;
            q[0] = scale * (kind == PLANE ? (double)i / n : r * cos(a));
            q[1] = scale * (kind == PLANE ? (double)j / m : r * sin(a));
            q[2] = scale * (kind == PLANE ? 0 : kind == TORUS ? sin(b) : 4.0 * j / m);
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < m; j++) {
            int a = i * mv + j, b = (i + 1) % nv * mv + j;
            int c = (i + 1) % nv * mv + (j + 1) % mv, d = i * mv + (j + 1) % mv;
            int32_t even[6] = {a, b, c, a, c, d}, odd[6] = {a, b, d, b, c, d};
            memcpy(t + 6 * f++, (i + j) % 2 ? odd : even, sizeof even);
        }
    }
    qc_mesh *out = NULL;
    assert_int_equal(qc_mesh_create(ctx, nv * mv, p, 2 * n * m, t, &out), QC_OK);
    free(p);
    free(t);
    return out;
}

/* Ellipsoid x = a cos u cos v, y = b sin u cos v, z = c sin v with two polar caps; 2 n (m - 1)
 * faces. */
static inline qc_mesh *ellipsoid(qc_ctx *ctx, int n, int m, double a, double b, double c) {
    int V = n * (m - 1) + 2, F = 2 * n * (m - 1), f = 0;
    double *p = malloc(sizeof *p * 3 * (size_t)V);
    int32_t *t = malloc(sizeof *t * 3 * (size_t)F);
    for (int j = 1; j < m; j++) {
        for (int i = 0; i < n; i++) {
            double u = 2 * PI * (i + (j % 2) * 0.5) / n, v = PI * j / m - PI / 2;
            double q[3] = {a * cos(u) * cos(v), b * sin(u) * cos(v), c * sin(v)};
            memcpy(p + 3 * ((j - 1) * n + i), q, sizeof q);
        }
    }
    double poles[6] = {0, 0, -c, 0, 0, c};
    memcpy(p + 3 * (V - 2), poles, sizeof poles);
    for (int j = 0; j < m; j++) {
        for (int i = 0; i < n; i++) {
            int k = (i + 1) % n, low = (j - 1) * n, high = j * n;
            if (j == 0) {
                int32_t s[3] = {high + k, high + i, V - 2};
                memcpy(t + 3 * f++, s, sizeof s);
            } else if (j == m - 1) {
                int32_t s[3] = {low + i, low + k, V - 1};
                memcpy(t + 3 * f++, s, sizeof s);
            } else { /* row j is shifted by half a cell when j is even (rows count from 1) */
                bool shifted = j % 2;
                int32_t s[6] = {low + i,
                                low + k,
                                shifted ? high + k : high + i,
                                low + i,
                                shifted ? high + k : high + i,
                                high + i};
                int32_t o[6] = {low + i, low + k, high + i, low + k, high + k, high + i};
                memcpy(t + 3 * f, shifted ? s : o, sizeof s);
                f += 2;
            }
        }
    }
    qc_mesh *out = NULL;
    assert_int_equal(qc_mesh_create(ctx, V, p, F, t, &out), QC_OK);
    free(p);
    free(t);
    return out;
}

static inline qc_complex *random_crosses(const qc_mesh *mesh, uint64_t seed) {
    qc_complex *x = malloc(sizeof *x * (size_t)mesh->n_faces);
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        double a = 2 * PI * uniform(&seed);
        x[t] = (qc_complex){cos(a), sin(a)};
    }
    return x;
}

static inline qc_matching *match(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x) {
    qc_face_field *field = NULL;
    qc_matching *out = NULL;
    assert_int_equal(qc_face_field_create(ctx, mesh, x, NULL, NULL, &field), QC_OK);
    assert_int_equal(qc_matching_create(ctx, field, NULL, &out), QC_OK);
    qc_object_release(field);
    return out;
}

/* Angle between two crosses, in [0, pi/4]. */
static inline double cross_angle(qc_complex a, qc_complex b) {
    double d = atan2(b.im, b.re) - atan2(a.im, a.re);
    return fabs(d - PI / 2 * round(2 * d / PI));
}

/* The direction v (in space) as a number in the frame of face t. */
static inline qc_complex in_frame(const double *real, const double *imaginary, size_t t,
                                  const double v[3]) {
    qc_complex out = {0, 0};
    for (size_t i = 0; i < 3; i++) {
        out.re += real[3 * t + i] * v[i];
        out.im += imaginary[3 * t + i] * v[i];
    }
    return out;
}

static inline void centroid(const qc_mesh *mesh, size_t t, double out[3]) {
    for (size_t i = 0; i < 3; i++) {
        out[i] = 0;
        for (size_t k = 0; k < 3; k++)
            out[i] += mesh->position[3 * (size_t)mesh->face_vertex[3 * t + k] + i] / 3;
    }
}

#endif
