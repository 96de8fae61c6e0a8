/* Integer-grid maps with known quads: plane, torus, surfaces of voxels, cones of several turns. */
#ifndef QC_TESTS_MAPS_H
#define QC_TESTS_MAPS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <qc/map.h>

typedef struct maps_rng {
    uint64_t state;
} maps_rng;
static inline uint32_t maps_random(maps_rng *r) {
    r->state = r->state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(r->state >> 33);
}
static inline double maps_uniform(maps_rng *r) { /* [-1, 1) */
    return (double)maps_random(r) / 1073741824.0 - 1;
}

static inline qc_ctx *maps_context(void) {
    qc_ctx *ctx = NULL;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.threads = 1;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    return ctx;
}

static inline int set_up(void **state) {
    *state = maps_context();
    return 0;
}

static inline int tear_down(void **state) {
    qc_ctx_free(*state);
    return 0;
}

#define maps_ok(ctx, call)                                                                         \
    do {                                                                                           \
        if ((call) != QC_OK) fail_msg("%s", qc_ctx_error(ctx)->text);                              \
    } while (0)

/* A growing triangle list with parameters; positions are by vertex. */
typedef struct maps_list {
    int32_t n_vertices, n_faces;
    double *position, *uv;
    int32_t *face;
} maps_list;
static inline maps_list maps_list_create(int32_t max_vertices, int32_t max_faces) {
    maps_list l = {0, 0, calloc(3 * (size_t)max_vertices, sizeof(double)),
                   calloc(6 * (size_t)max_faces, sizeof(double)),
                   calloc(3 * (size_t)max_faces, sizeof(int32_t))};
    return l;
}
static inline void maps_list_free(maps_list *l) {
    free(l->position);
    free(l->uv);
    free(l->face);
}
static inline void maps_triangle(maps_list *l, const int32_t v[3], const double uv[6]) {
    memcpy(l->face + 3 * (size_t)l->n_faces, v, 3 * sizeof *v);
    memcpy(l->uv + 6 * (size_t)l->n_faces, uv, 6 * sizeof *uv);
    l->n_faces++;
}
/* Two triangles of a square with corners (x, y), (x+1, y), (x+1, y+1), (x, y+1), either diagonal.
 */
static inline void maps_square(maps_list *l, const int32_t v[4], const double uv[8],
                               bool diagonal) {
    static const int split[2][2][3] = {{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}};
    for (int i = 0; i < 2; i++) {
        int32_t w[3];
        double p[6];
        for (int k = 0; k < 3; k++) {
            const int c = split[diagonal][i][k];
            w[k] = v[c];
            p[2 * k] = uv[2 * c];
            p[2 * k + 1] = uv[2 * c + 1];
        }
        maps_triangle(l, w, p);
    }
}

/* Square (i, j) of a block of k x k, whose vertices and parameters are given row by row. */
static inline void maps_block_square(maps_list *l, const int32_t *id, const double *uv, int k,
                                     int i, int j, bool diagonal) {
    int32_t w[4];
    double p[8];
    for (int c = 0; c < 4; c++) {
        const int at = (j + (c >= 2)) * (k + 1) + i + (c == 1 || c == 2);
        w[c] = id[at];
        memcpy(p + 2 * c, uv + 2 * at, 2 * sizeof *p);
    }
    maps_square(l, w, p, diagonal);
}

/* Applies a random automorphism of the grid to the chart of every triangle. */
static inline void maps_gauge(maps_list *l, maps_rng *r) {
    for (int32_t t = 0; t < l->n_faces; t++) {
        const uint32_t turns = maps_random(r) & 3;
        const double shift[2] = {maps_random(r) % 9 - 4.0, maps_random(r) % 9 - 4.0};
        for (int k = 0; k < 3; k++) {
            double *p = l->uv + 6 * (size_t)t + 2 * k;
            for (uint32_t i = 0; i < turns; i++) {
                const double u = p[0];
                p[0] = -p[1];
                p[1] = u;
            }
            p[0] += shift[0];
            p[1] += shift[1];
        }
    }
}
static inline qc_corner_map *maps_finish(qc_ctx *ctx, maps_list *l) {
    qc_mesh *mesh = NULL;
    qc_corner_map *map = NULL;
    maps_ok(ctx, qc_mesh_create(ctx, l->n_vertices, l->position, l->n_faces, l->face, &mesh));
    maps_ok(ctx, qc_corner_map_create(ctx, mesh, l->uv, 0, NULL, &map));
    qc_object_release(mesh);
    maps_list_free(l);
    return map;
}

/* k x k squares on [0, width] x [0, height], interior vertices moved by up to `jitter` squares;
 * then the parameters are turned by `angle` and shifted by (u, v). */
static inline maps_list maps_plane(int k, double width, double height, double jitter, double angle,
                                   double u, double v, maps_rng *r) {
    maps_list l = maps_list_create((k + 1) * (k + 1), 2 * k * k);
    l.n_vertices = (k + 1) * (k + 1);
    for (int j = 0; j <= k; j++)
        for (int i = 0; i <= k; i++) {
            double *p = l.position + 3 * (size_t)(j * (k + 1) + i);
            const bool inner = i > 0 && i < k && j > 0 && j < k;
            p[0] = width / k * (i + (inner ? jitter * maps_uniform(r) : 0));
            p[1] = height / k * (j + (inner ? jitter * maps_uniform(r) : 0));
        }
    for (int j = 0; j < k; j++)
        for (int i = 0; i < k; i++) {
            const int32_t a = j * (k + 1) + i, w[4] = {a, a + 1, a + k + 2, a + k + 1};
            double uv[8];
            for (int c = 0; c < 4; c++) {
                const double *p = l.position + 3 * (size_t)w[c];
                uv[2 * c] = cos(angle) * p[0] - sin(angle) * p[1] + u;
                uv[2 * c + 1] = sin(angle) * p[0] + cos(angle) * p[1] + v;
            }
            maps_square(&l, w, uv, maps_random(r) & 1);
        }
    return l;
}

/* Flat torus: k x k squares over the parallelogram of the integer vectors a and b. */
static inline maps_list maps_torus(int k, const double a[2], const double b[2], double jitter,
                                   maps_rng *r) {
    maps_list l = maps_list_create(k * k, 2 * k * k);
    l.n_vertices = k * k;
    double *moved = calloc(2 * (size_t)(k * k), sizeof *moved);
    for (int i = 0; i < k * k; i++) {
        const double x = 6.283185307179586 * (i % k) / k, y = 6.283185307179586 * (i / k) / k;
        l.position[3 * i] = (3 + cos(y)) * cos(x);
        l.position[3 * i + 1] = (3 + cos(y)) * sin(x);
        l.position[3 * i + 2] = sin(y);
        moved[2 * i] = jitter * maps_uniform(r);
        moved[2 * i + 1] = jitter * maps_uniform(r);
    }
    for (int j = 0; j < k; j++)
        for (int i = 0; i < k; i++) {
            int32_t w[4];
            double uv[8];
            for (int c = 0; c < 4; c++) {
                const int x = i + (c == 1 || c == 2), y = j + (c >= 2);
                w[c] = y % k * k + x % k;
                const double s = (x + moved[2 * w[c]]) / k, t = (y + moved[2 * w[c] + 1]) / k;
                uv[2 * c] = s * a[0] + t * b[0];
                uv[2 * c + 1] = s * a[1] + t * b[1];
            }
            maps_square(&l, w, uv, maps_random(r) & 1);
        }
    free(moved);
    return l;
}

/* Boundary of a set of unit voxels (size^3 flags), k x k squares a side, each side mapped to an n x
 * n square of the grid; vertices inside a side move by up to `jitter` squares. */
static inline maps_list maps_voxels(int size, const uint8_t *voxel, int k, double n, double jitter,
                                    maps_rng *r) {
    const int points = size * k + 1;
    int32_t *number = malloc(sizeof *number * (size_t)(points * points * points));
    for (int i = 0; i < points * points * points; i++) number[i] = -1;
    const int sides = 6 * size * size * size;
    maps_list l = maps_list_create(sides * (k + 1) * (k + 1), 2 * sides * k * k);
    double *uv = malloc(sizeof *uv * 2 * (size_t)((k + 1) * (k + 1)));
    int32_t *id = malloc(sizeof *id * (size_t)((k + 1) * (k + 1)));
    for (int cell = 0; cell < size * size * size; cell++) {
        const int x[3] = {cell % size, cell / size % size, cell / size / size};
        for (int side = 0; side < 6 && voxel[cell]; side++) {
            const int axis = side / 2, up = side % 2;
            int y[3] = {x[0], x[1], x[2]};
            y[axis] += up ? 1 : -1;
            if (y[axis] >= 0 && y[axis] < size && voxel[y[0] + size * (y[1] + size * y[2])])
                continue;
            const int a = (axis + (up ? 1 : 2)) % 3, b = (axis + (up ? 2 : 1)) % 3;
            for (int j = 0; j <= k; j++)
                for (int i = 0; i <= k; i++) {
                    int q[3] = {x[0] * k, x[1] * k, x[2] * k};
                    q[axis] += up * k;
                    q[a] += i;
                    q[b] += j;
                    int32_t *v = &number[q[0] + points * (q[1] + points * q[2])];
                    if (*v < 0) {
                        *v = l.n_vertices++;
                        for (int c = 0; c < 3; c++)
                            l.position[3 * (size_t)*v + (size_t)c] =
                                (double)q[c] / k + 0.01 * maps_uniform(r);
                    }
                    const int at = j * (k + 1) + i;
                    const bool inner = i > 0 && i < k && j > 0 && j < k;
                    id[at] = *v;
                    uv[2 * at] = n / k * (i + (inner ? jitter * maps_uniform(r) : 0));
                    uv[2 * at + 1] = n / k * (j + (inner ? jitter * maps_uniform(r) : 0));
                }
            for (int j = 0; j < k; j++)
                for (int i = 0; i < k; i++) {
                    maps_block_square(&l, id, uv, k, i, j, maps_random(r) & 1);
                }
        }
    }
    free(number);
    free(uv);
    free(id);
    return l;
}

/* Disk around a cone of `turns` quarter turns with its centre at (u, v): rings of 8 sectors a
 * quarter. */
static inline maps_list maps_cone(int turns, int rings, double radius, double u, double v) {
    const int sectors = 4 * turns;
    maps_list l = maps_list_create(1 + rings * sectors, 2 * rings * sectors);
    l.n_vertices = 1 + rings * sectors;
    for (int i = 0; i < rings * sectors; i++) {
        const double angle = 6.283185307179586 * (i % sectors) / sectors;
        l.position[3 * i + 3] = (i / sectors + 1) * cos(angle);
        l.position[3 * i + 4] = (i / sectors + 1) * sin(angle);
        l.position[3 * i + 5] = 0.1 * (i % sectors % 3);
    }
    for (int j = 0; j < rings; j++)
        for (int i = 0; i < sectors; i++) {
            int32_t w[4]; /* inner, outer, next outer, next inner */
            double uv[8];
            for (int c = 0; c < 4; c++) {
                const int ring = j + (c == 1 || c == 2), s = i + (c >= 2);
                const double angle = 1.5707963267948966 * s / 4, length = radius * ring / rings;
                w[c] = ring == 0 ? 0 : 1 + (ring - 1) * sectors + s % sectors;
                uv[2 * c] = u + length * cos(angle);
                uv[2 * c + 1] = v + length * sin(angle);
            }
            if (j == 0)
                maps_triangle(&l, w, uv);
            else
                maps_square(&l, w, uv, (i ^ j) & 1);
        }
    return l;
}

static inline qc_polygon_mesh *maps_extract(qc_ctx *ctx, qc_corner_map *map) {
    qc_grid_map *grid = NULL;
    qc_polygon_mesh *quads = NULL;
    maps_ok(ctx, qc_grid_map_create(ctx, map, 0, &grid));
    maps_ok(ctx, qc_map_extract(ctx, grid, &quads));
    qc_object_release(grid);
    qc_object_release(map);
    return quads;
}

#endif
