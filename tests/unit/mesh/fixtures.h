/* Small meshes for the tests of sdk/mesh: voxel sets (any genus, any number of components) and a
 * rectangular grid which may be closed to an annulus or a torus. */
#ifndef QC_TEST_MESH_FIXTURES_H
#define QC_TEST_MESH_FIXTURES_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <qc/mesh.h>

#include "unit/context.h"

static const double PI = 3.14159265358979323846;

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* n x m cells; wrap bit 1 closes the first direction, bit 2 the second. scale multiplies positions.
 * A torus of revolution, a cylinder, or a flat square. */
static inline qc_mesh *grid(qc_ctx *ctx, int n, int m, int wrap, double scale) {
    int nv = n + !(wrap & 1), mv = m + !(wrap & 2), f = 0;
    double *p = malloc((size_t)(nv * mv) * 3 * sizeof *p);
    int32_t *t = malloc((size_t)(n * m) * 6 * sizeof *t);
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < mv; j++) {
            double *q = p + 3 * (i * mv + j), a = 2 * PI * i / n, b = 2 * PI * j / m;
            double r = wrap == 3 ? 2 + cos(b) : 1, x = wrap & 1 ? r * cos(a) : (double)i / n;
            q[0] = scale * x;
            q[1] = scale * (wrap & 1 ? r * sin(a) : (double)j / m);
            q[2] = scale * (wrap == 3 ? sin(b) : wrap & 1 ? (double)j / m : 0);
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < m; j++) {
            int a = i * mv + j, b = (i + 1) % nv * mv + j;
            int c = (i + 1) % nv * mv + (j + 1) % mv, d = i * mv + (j + 1) % mv;
            int32_t two[6] = {a, b, c, a, c, d};
            memcpy(t + 6 * f++, two, sizeof two);
        }
    }
    qc_mesh *out = NULL;
    assert_int_equal(qc_mesh_create(ctx, nv * mv, p, 2 * n * m, t, &out), QC_OK);
    free(p);
    free(t);
    return out;
}

/* Boundary of a set of unit cubes in an nx x ny x nz box; rows[] holds '#' for a cube, x fastest.
 * Every square is split into four triangles round its centre when `fine`, else into two. */
static inline qc_mesh *voxels(qc_ctx *ctx, int nx, int ny, int nz, const char *rows, int fine) {
    int n_lattice = (nx + 1) * (ny + 1) * (nz + 1), n = 0, f = 0, cells = nx * ny * nz;
    int *number = malloc((size_t)n_lattice * sizeof *number);
    double *p = malloc((size_t)(n_lattice + 6 * cells) * 3 * sizeof *p);
    int32_t *t = malloc((size_t)cells * 6 * 12 * sizeof *t);
    for (int i = 0; i < n_lattice; i++) number[i] = -1;
    for (int cell = 0; cell < cells; cell++) {
        int at[3] = {cell % nx, cell / nx % ny, cell / nx / ny}, size[3] = {nx, ny, nz};
        if (rows[cell] != '#') continue;
        for (int side = 0; side < 6; side++) {
            int axis = side / 2, up = side % 2, other[3] = {at[0], at[1], at[2]};
            other[axis] += up ? 1 : -1;
            bool outside = other[axis] < 0 || other[axis] >= size[axis];
            if (!outside && rows[other[0] + nx * (other[1] + ny * other[2])] == '#') continue;
            int32_t q[4];
            double centre[3] = {0, 0, 0};
            for (int k = 0; k < 4; k++) { /* counter-clockwise from outside */
                int corner[3] = {at[0], at[1], at[2]}, u = k == 1 || k == 2, w = k >= 2;
                corner[axis] += up;
                corner[(axis + 1) % 3] += up ? u : w;
                corner[(axis + 2) % 3] += up ? w : u;
                int i = corner[0] + (nx + 1) * (corner[1] + (ny + 1) * corner[2]);
                if (number[i] < 0) {
                    for (int d = 0; d < 3; d++) p[3 * n + d] = corner[d];
                    number[i] = n++;
                }
                q[k] = number[i];
                for (int d = 0; d < 3; d++) centre[d] += 0.25 * corner[d];
            }
            for (int d = 0; fine && d < 3; d++) p[3 * n + d] = centre[d];
            for (int k = 0; k < (fine ? 4 : 2); k++, f++) {
                t[3 * f] = fine ? n : q[0];
                t[3 * f + 1] = fine ? q[k] : q[k + 1];
                t[3 * f + 2] = fine ? q[(k + 1) % 4] : q[k + 2];
            }
            n += fine;
        }
    }
    qc_mesh *out = NULL;
    assert_int_equal(qc_mesh_create(ctx, n, p, f, t, &out), QC_OK);
    free(number);
    free(p);
    free(t);
    return out;
}

/* A plate with `holes` holes in a row: genus = holes. */
static inline qc_mesh *plate(qc_ctx *ctx, int holes, int fine) {
    int nx = 2 * holes + 1;
    char *rows = malloc((size_t)nx * 3);
    for (int i = 0; i < 3 * nx; i++) rows[i] = i / nx == 1 && i % nx % 2 == 1 ? '.' : '#';
    qc_mesh *out = voxels(ctx, nx, 3, 1, rows, fine);
    free(rows);
    return out;
}

#endif
