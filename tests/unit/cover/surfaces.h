/* Small surfaces of known genus and random matchings for the tests of coverings and forms. */
#ifndef QC_TEST_SURFACES_H
#define QC_TEST_SURFACES_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include <qc/cover.h>

static uint64_t random_state = 1;
static inline double random_unit(void) { /* in [0, 1) */
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 11) / 9007199254740992.0;
}
static inline int32_t random_int(int32_t n) {
    return (int32_t)(random_unit() * n);
}
static inline double random_signed(void) {
    return 2 * random_unit() - 1;
}

static inline void *new_array(size_t count, size_t size) {
    void *p = calloc(count + 1, size);
    assert_non_null(p);
    return p;
}
#define NEW_ARRAY(T, count) ((T *)new_array((size_t)(count), sizeof(T)))

static inline qc_ctx *new_context(void) {
    qc_ctx *ctx = NULL;
    assert_int_equal(qc_ctx_create(NULL, &ctx), QC_OK);
    return ctx;
}

typedef struct surface {
    const char *name;
    int32_t x, y, z, sub; /* voxels in each direction, subdivision of a voxel */
    const char *mask; /* x fastest; '#' = solid. z = 0: a flat sheet of cells instead of voxels */
    int32_t genus, boundaries, components;
} surface;

static const surface SURFACES[] = {
    {"cube", 1, 1, 1, 2, "#", 0, 0, 1},
    {"torus", 3, 3, 1, 1, "####.####", 1, 0, 1},
    {"double torus", 5, 3, 1, 1, "######.#.######", 2, 0, 1},
    {"two cubes", 3, 1, 1, 1, "#.#", 0, 0, 2},
    {"disk", 3, 3, 0, 1, "#########", 0, 1, 1},
    {"annulus", 4, 3, 0, 1, "#####..#####", 0, 2, 1},
    {"three holes", 7, 3, 0, 1, "########.#.#.########", 0, 4, 1},
};
enum { N_SURFACES = (int)(sizeof(SURFACES) / sizeof(SURFACES[0])) };

typedef struct builder {
    const surface *s;
    int32_t n_vertices, n_faces, *number, *face;
    double *position;
} builder;

static inline bool solid(const surface *s, int32_t x, int32_t y, int32_t z) {
    if (x < 0 || y < 0 || z < 0) return false;
    x /= s->sub, y /= s->sub, z /= s->sub;
    if (x >= s->x || y >= s->y || z >= (s->z ? s->z : 1)) return false;
    return s->mask[(z * s->y + y) * s->x + x] == '#';
}

static inline int32_t grid_vertex(builder *b, const int32_t p[3]) {
    const int32_t X = b->s->x * b->s->sub + 1, Y = b->s->y * b->s->sub + 1;
    int32_t *number = &b->number[(p[2] * Y + p[1]) * X + p[0]];
    if (*number < 0) {
        for (int i = 0; i < 3; i++)
            b->position[3 * b->n_vertices + i] = p[i] + 0.25 * random_signed();
        *number = b->n_vertices++;
    }
    return *number;
}

static inline void add_quad(builder *b, int32_t a, int32_t c, int32_t d, int32_t e) {
    const int32_t split[2][6] = {{a, c, d, a, d, e}, {a, c, e, c, d, e}};
    memcpy(b->face + 3 * b->n_faces, split[random_int(2)], sizeof(split[0]));
    b->n_faces += 2;
}

/* The side of cell p whose outer normal is `sign` times axis i. */
static inline void add_side(builder *b, const int32_t p[3], int i, int sign) {
    int32_t q[3] = {p[0], p[1], p[2]}, v[4];
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const int32_t step[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    q[i] += sign > 0;
    for (int n = 0; n < 4; n++) {
        q[j] = p[j] + step[n][0];
        q[k] = p[k] + step[n][1];
        v[n] = grid_vertex(b, q);
    }
    if (sign > 0)
        add_quad(b, v[0], v[1], v[2], v[3]);
    else
        add_quad(b, v[3], v[2], v[1], v[0]);
}

static inline qc_mesh *build_surface(qc_ctx *ctx, const surface *s, double size) {
    const int32_t n[3] = {s->x * s->sub, s->y * s->sub, s->z ? s->z * s->sub : 1};
    const int32_t cells = n[0] * n[1] * n[2], points = (n[0] + 1) * (n[1] + 1) * (n[2] + 1);
    builder b = {s,
                 0,
                 0,
                 NEW_ARRAY(int32_t, points),
                 NEW_ARRAY(int32_t, 36 * cells),
                 NEW_ARRAY(double, 3 * points)};
    for (int32_t i = 0; i < points; i++) b.number[i] = -1;
    for (int32_t i = 0; i < cells; i++) {
        const int32_t p[3] = {i % n[0], i / n[0] % n[1], i / n[0] / n[1]};
        if (!solid(s, p[0], p[1], p[2])) continue;
        for (int axis = s->z ? 0 : 2; axis < 3; axis++)
            for (int sign = s->z ? -1 : 1; sign < 2; sign += 2) {
                int32_t q[3] = {p[0], p[1], p[2]};
                q[axis] += sign;
                if (!s->z || !solid(s, q[0], q[1], q[2])) add_side(&b, p, axis, sign);
            }
    }
    for (int32_t i = 0; i < 3 * b.n_vertices; i++) b.position[i] *= size;
    qc_mesh *mesh = NULL;
    assert_int_equal(qc_mesh_create(ctx, b.n_vertices, b.position, b.n_faces, b.face, &mesh),
                     QC_OK);
    assert_int_equal(mesh->genus, s->genus);
    assert_int_equal(mesh->n_boundary_loops, s->boundaries);
    assert_int_equal(mesh->n_components, s->components);
    free(b.number);
    free(b.face);
    free(b.position);
    return mesh;
}

/* Kinds of matching: the ways a covering can hang together. */
enum { PLAIN, GAUGE, EVEN, SPARSE, DENSE, N_MATCHINGS };

/* NULL for PLAIN; GAUGE: trivial holonomy in disguise; EVEN: only half turns; SPARSE: few edges;
 * DENSE: all of them, with turns beyond 0..3. */
static inline int8_t *random_matching(const qc_mesh *m, int kind) {
    if (kind == PLAIN) return NULL;
    int8_t *matching = NEW_ARRAY(int8_t, m->n_edges);
    int32_t *turn = NEW_ARRAY(int32_t, m->n_faces);
    for (int32_t t = 0; t < m->n_faces; t++) turn[t] = random_int(4);
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t s = m->edge_halfedge[2 * e], t = m->edge_halfedge[2 * e + 1];
        if (t < 0) continue;
        const int32_t gauge = turn[t / 3] - turn[s / 3];
        if (kind == GAUGE) matching[e] = (int8_t)gauge;
        if (kind == EVEN) matching[e] = (int8_t)(gauge + 2 * random_int(2));
        if (kind == SPARSE) matching[e] = (int8_t)(random_int(8) ? 0 : random_int(4) - 2);
        if (kind == DENSE) matching[e] = (int8_t)(random_int(9) - 4);
    }
    free(turn);
    return matching;
}

static inline qc_complex *random_numbers(int32_t n) {
    qc_complex *z = NEW_ARRAY(qc_complex, n);
    for (int32_t i = 0; i < n; i++) z[i] = (qc_complex){random_signed(), random_signed()};
    return z;
}

/* Runs `body` on every surface with every kind of matching. */
typedef void cover_body(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind);
static inline void for_all_covers(cover_body *body) {
    qc_ctx *ctx = new_context();
    random_state = 1;
    for (int i = 0; i < N_SURFACES; i++)
        for (int kind = 0; kind < N_MATCHINGS; kind++) {
            qc_mesh *mesh = build_surface(ctx, &SURFACES[i], 1);
            int8_t *matching = random_matching(mesh, kind);
            const qc_cover cover = {mesh, matching};
            body(ctx, &SURFACES[i], &cover, kind);
            free(matching);
            qc_object_release(mesh);
        }
    qc_ctx_free(ctx);
}

#endif
