/* Integer vectors of a coarse complex: closed, positive, along features, winding as the real ones
 * do, and as near to them as the scale allows. Complexes are boxes, tori and open strips made of
 * rectangles, deformed along closed paths. */
#include <math.h>
#include <string.h>

#include "sdk/map/quantize/triangulation.h"
#include "tests/unit/map/seamless.h"

enum { BITS = 24 };

typedef struct complex_case {
    int32_t n_rectangles;
    int32_t vertex[6][4]; /* counter-clockwise, the first side along u */
    int32_t side[6][2];   /* which length its two sides have */
    double length[3];
    bool features;
} complex_case;

#define BOX                                                                                        \
    6, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}},       \
        {{1, 0}, {0, 1}, {0, 2}, {1, 2}, {0, 2}, {1, 2}},
static const complex_case CASES[] = {
    {BOX{1, 1, 1}, false},
    {BOX{0.07, 3.3, 2.71}, false},
    {BOX{0.01, 0.013, 5}, false},
    {BOX{1.4, 2.6, 0.3}, true},
    {1, {{0, 0, 0, 0}}, {{0, 1}}, {2.3, 0.4, 0}, false},
    {2, {{0, 1, 2, 3}, {1, 4, 5, 2}}, {{0, 1}, {2, 1}}, {0.2, 1.7, 3.1}, true},
    {2, {{0, 1, 2, 3}, {1, 4, 5, 2}}, {{0, 1}, {2, 1}}, {0.2, 1.7, 3.1}, false},
};
enum { N_CASES = (int)(sizeof CASES / sizeof *CASES) };

typedef struct holder {
    qc__coarse c;
    qc__point vector[36];
    int32_t twin[36], origin[36];
    int8_t rotation[36], axis[36];
} holder;

static int32_t side_of(int32_t h) { /* of the rectangle; -1 = the diagonal */
    static const int32_t side[6] = {0, 1, -1, -1, 2, 3};
    return side[h % 6];
}

static void glue(holder *b, int32_t h, int32_t g, int32_t turn) {
    b->twin[h] = g;
    b->twin[g] = h;
    b->rotation[h] = (int8_t)(turn & 3);
    b->rotation[g] = (int8_t)(-turn & 3);
}

/* Two triangles 0 1 2 and 0 2 3 for each rectangle. */
static void build(const complex_case *k, holder *b) {
    *b = (holder){
        .c = {2 * k->n_rectangles, BITS, b->vector, b->twin, b->rotation, b->axis, b->origin}};
    for (int32_t i = 0; i < k->n_rectangles; i++) {
        const int64_t a = (int64_t)ldexp(k->length[k->side[i][0]], BITS);
        const int64_t d = (int64_t)ldexp(k->length[k->side[i][1]], BITS);
        const qc__point v[6] = {{a, 0}, {0, d}, {-a, -d}, {a, d}, {-a, 0}, {0, -d}};
        const int32_t corner[6] = {0, 1, 2, 0, 2, 3};
        for (int32_t j = 0; j < 6; j++) {
            const int32_t h = 6 * i + j, side = side_of(h);
            b->vector[h] = v[j];
            b->origin[h] = k->vertex[i][corner[j]];
            b->axis[h] = (int8_t)(k->features ? side : -1);
            b->twin[h] = -1;
        }
    }
    const bool torus = k->n_rectangles == 1;
    for (int32_t h = 0; h < 6 * k->n_rectangles; h++)
        for (int32_t g = 0; g < h; g++) {
            const int32_t p = side_of(h), q = side_of(g);
            if (p < 0 && q < 0 && h / 6 == g / 6) glue(b, h, g, 0);
            if (p < 0 || q < 0 || (torus && (p + q) % 2 != 0)) continue;
            if (b->origin[h] == b->origin[qc_next(g)] && b->origin[g] == b->origin[qc_next(h)])
                glue(b, h, g, q - p - 2);
        }
}

static int64_t area(const qc__point *v, int32_t t) {
    return qc__cross(v[3 * t], v[3 * t + 1]);
}

static bool is_positive(const holder *b) {
    for (int32_t t = 0; t < b->c.n_triangles; t++)
        if (area(b->vector, t) <= 0) return false;
    return true;
}

static void push(holder *b, int32_t h, qc__point d) {
    b->vector[h] = qc__minus(b->vector[h], d);
    if (b->twin[h] >= 0)
        b->vector[b->twin[h]] = qc__plus(b->vector[b->twin[h]], qc__turn_point(d, b->rotation[h]));
}

static uint32_t draw(uint64_t *random) {
    *random = *random * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*random >> 33);
}

/* Random closed paths of a fraction of a unit; those which fold something are taken back. */
static void deform(holder *b, uint64_t *random) {
    for (int32_t round = 0; round < 60; round++) {
        const holder before = *b;
        const int32_t start = (int32_t)(draw(random) % (uint32_t)b->c.n_triangles);
        const int64_t amount = (int64_t)(draw(random) % (1 << (BITS - 2)));
        int32_t t = start, k = 0, steps = 0;
        do {
            const int32_t h = 3 * t + (int32_t)(draw(random) % 3);
            if (b->twin[h] < 0 || (b->axis[h] >= 0 && (k - b->axis[h]) % 2 != 0)) continue;
            push(b, h, qc__turn_point((qc__point){amount, 0}, k));
            t = b->twin[h] / 3;
            k = (k + b->rotation[h]) & 3;
        } while ((t != start || k != 0) && ++steps < 10000);
        if (t != start || k != 0 || !is_positive(b)) {
            const qc__coarse c = b->c;
            *b = before;
            b->c = c;
        }
    }
}

static int32_t windings(const holder *b, const qc__point *v, int32_t vertex) {
    int32_t n = 0;
    for (int32_t h = 0; h < 3 * b->c.n_triangles; h++) {
        const int32_t p = qc_prev(h);
        if (b->origin[h] != vertex) continue;
        for (int d = 0; d < 4; d++)
            n += qc__in_sector(v[h], (qc__point){-v[p].u, -v[p].v}, b->twin[p] < 0, d);
    }
    return n;
}

static void check_vectors(const complex_case *k, const holder *b, const qc__point *x) {
    bool open = false;
    for (int32_t h = 0; h < 3 * b->c.n_triangles; h++) {
        const int32_t g = b->twin[h];
        open |= g < 0;
        if (g >= 0) {
            const qc__point sum = qc__plus(x[g], qc__turn_point(x[h], b->rotation[h]));
            assert_true(sum.u == 0 && sum.v == 0);
        }
        if (b->axis[h] >= 0) {
            const qc__point along = qc__turn_point(x[h], -b->axis[h] & 3);
            assert_true(along.u > 0 && along.v == 0);
        }
    }
    for (int32_t t = 0; t < b->c.n_triangles; t++) {
        const qc__point sum = qc__plus(qc__plus(x[3 * t], x[3 * t + 1]), x[3 * t + 2]);
        assert_true(sum.u == 0 && sum.v == 0);
        assert_true(area(x, t) > 0);
    }
    for (int32_t v = 0; v < 8 && (!open || k->features); v++)
        assert_int_equal(windings(b, x, v), windings(b, b->vector, v));
}

static double total(const holder *b, const qc__point *v) {
    double sum = 0;
    for (int32_t t = 0; t < b->c.n_triangles; t++) sum += 0.5 * (double)area(v, t);
    return sum;
}

/* The vectors x of the complex which the search has flipped; b becomes that one. */
static void find_vectors(qc_ctx *ctx, holder *b, double scale, double quads, qc__point *x,
                         double *made) {
    qc__flips flips = {0};
    must(ctx, qc__coarse_integers(ctx, &b->c, scale, quads, x, made, &flips));
    must(ctx, qc__coarse_flip(ctx, &b->c, &flips, 0, NULL, NULL, NULL));
    assert_true(is_positive(b));
    qc__free(flips.halfedge);
}

static void vectors_are_feasible_at_every_scale(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    static const double scales[] = {0.1, 1, 3, 10, 300};
    for (int i = 0; i < N_CASES; i++)
        for (uint64_t seed = 0; seed < 6; seed++) {
            holder b;
            uint64_t random = 1 + seed;
            build(&CASES[i], &b);
            if (seed > 0) deform(&b, &random);
            for (size_t s = 0; s < sizeof scales / sizeof *scales; s++) {
                qc__point x[36];
                double made = 0;
                find_vectors(ctx, &b, scales[s], 0, x, &made);
                check_vectors(&CASES[i], &b, x);
                double real = total(&b, b.vector);
                real = ldexp(real, -2 * BITS);
                assert_true(made == total(&b, x));
                const double wanted = real * scales[s] * scales[s];
                if (scales[s] > 100) assert_true(fabs(made / wanted - 1) < 0.05);
                find_vectors(ctx, &b, scales[s], 4 * wanted, x, &made);
                check_vectors(&CASES[i], &b, x);
                if (scales[s] > 100) assert_true(fabs(made / (4 * wanted) - 1) < 0.03);
            }
        }
    qc_ctx_free(ctx);
}

/* The vectors of an integer map are feasible themselves. */
static void integers_stay(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    complex_case k = CASES[0];
    k.length[0] = 3;
    k.length[1] = 2;
    k.length[2] = 7;
    holder b;
    build(&k, &b);
    qc__point x[36];
    double made;
    find_vectors(ctx, &b, 1, 0, x, &made);
    for (int32_t h = 0; h < 36; h++) {
        assert_int_equal(x[h].u * (1 << BITS), b.vector[h].u);
        assert_int_equal(x[h].v * (1 << BITS), b.vector[h].v);
    }
    assert_true(made == 82);
    qc_ctx_free(ctx);
}

/* Random flips which leave the triangles positive, mostly needles. */
static void flip_at_random(qc_ctx *ctx, holder *b, uint64_t *random) {
    for (int32_t i = 0; i < 60; i++) {
        int32_t h = (int32_t)(draw(random) % (uint32_t)(3 * b->c.n_triangles));
        const qc__triangulation T = {
            .vector = b->vector, .twin = b->twin, .rotation = b->rotation, .axis = b->axis};
        const qc__flips flips = {&h, 1, 1};
        if (qc__can_flip(&T, h, false))
            must(ctx, qc__coarse_flip(ctx, &b->c, &flips, 0, NULL, NULL, NULL));
    }
    assert_true(is_positive(b));
}

/* How coarse a map may get is a matter of the surface. Without flips of its own the search makes
 * half as many squares again. */
static void the_triangulation_matters_little(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    double sum[2] = {0, 0};
    for (int i = 0; i < 3; i++)
        for (uint64_t seed = 1; seed < 20; seed++) {
            holder b[2];
            for (int k = 0; k < 2; k++) {
                uint64_t random = seed;
                qc__point x[36];
                double made;
                build(&CASES[i], &b[k]);
                deform(&b[k], &random);
                if (k == 1) flip_at_random(ctx, &b[k], &random);
                find_vectors(ctx, &b[k], 0.3, 6, x, &made);
                check_vectors(&CASES[i], &b[k], x);
                sum[k] += made;
            }
        }
    assert_true(sum[1] < 1.1 * sum[0]);
    qc_ctx_free(ctx);
}

static void a_folded_complex_is_refused(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    holder b;
    build(&CASES[0], &b);
    for (int32_t h = 0; h < 36; h++) b.vector[h] = (qc__point){b.vector[h].v, b.vector[h].u};
    qc__point x[36];
    double made = -1;
    qc__flips flips = {0};
    assert_int_equal(qc__coarse_integers(ctx, &b.c, 1, 0, x, &made, &flips), QC_ERR_FAILED);
    assert_null(flips.halfedge);
    assert_true(made == -1);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vectors_are_feasible_at_every_scale),
        cmocka_unit_test(integers_stay),
        cmocka_unit_test(the_triangulation_matters_little),
        cmocka_unit_test(a_folded_complex_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
