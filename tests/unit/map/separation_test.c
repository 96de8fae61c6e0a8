/* Separation: forms measure the vector between two cones; afterwards no pair collides, numbers are
 * integers and the energy is that of the definition. */
#include "tests/unit/map/seamless.h"

static const surface_case CASES[] = {
    {"sphere", 400, 0, 0, SMOOTH},  {"sphere", 400, 0, 0.05, ROUGH},
    {"torus", 400, 0, 0.05, ROUGH}, {"genus", 600, 2, 0, SMOOTH},
    {"genus", 600, 2, 0.05, ROUGH}, {"trinoid", 500, 0, 0.05, ROUGH},
    {"knot", 600, 0, 0.2, SMOOTH},  {"knot", 600, 0, 0.2, ROUGH},
};
enum { N_CASES = (int)(sizeof CASES / sizeof *CASES) };

typedef struct problem {
    setting *s;
    qc__seams *seams;
    qc__periods *periods;
    qc__separation *separation;
    double reach, *P, *t; /* t: periods of the seamless map */
    int32_t n;
} problem;

static problem *problem_create(qc_ctx *ctx, const surface_case *c, double quads, qc_complex **map) {
    problem *p = ARRAY(problem, 1);
    p->s = setting_create(ctx, c, quads);
    p->seams = setting_seams(p->s, QC_LATTICE_QUADS);
    p->n = p->seams->n_free;
    p->reach = 3 * p->s->sizing->edge_length;
    must(ctx, qc__periods_create(ctx, p->seams, p->s->stiffness, NULL, &p->periods));
    p->P = ARRAY(double, (int64_t)p->n * p->n);
    p->t = ARRAY(double, p->n);
    must(ctx, qc__period_matrix(ctx, p->periods, p->P));
    qc_complex *f = ARRAY(qc_complex, 3 * (int64_t)p->s->mesh->n_faces);
    memcpy(f, p->s->map->f, sizeof *f * 3 * (size_t)p->s->mesh->n_faces);
    must(ctx, qc__seams_read(ctx, p->seams, f, p->t));
    must(ctx, qc__separation_create(ctx, p->seams, p->s->matching->axis, NULL, f, p->reach,
                                    &p->separation));
    if (map)
        *map = f;
    else
        free(f);
    return p;
}
static void problem_free(problem *p) {
    qc__separation_free(p->separation);
    qc__periods_free(p->periods);
    qc__seams_free(p->seams);
    setting_free(p->s);
    free(p->P);
    free(p->t);
    free(p);
}

static complex_t form_of(const qc__separation *s, int32_t pair, const double *z) {
    complex_t value = 0;
    for (int64_t i = s->start[pair]; i < s->start[pair + 1]; i++) {
        value += s->value[i] * z[s->variable[i]];
    }
    return value;
}

/* --- forms ------------------------------------------------------------------------------------ */

static int32_t other_end(const qc_mesh *m, int32_t e, int32_t v) {
    return m->edge_vertex[2 * e] == v ? m->edge_vertex[2 * e + 1] : m->edge_vertex[2 * e];
}

static int32_t corner_at(const qc_mesh *m, int32_t t, int32_t v) {
    for (int32_t c = 3 * t; c < 3 * t + 3; c++)
        if (m->face_vertex[c] == v) return c;
    return -1;
}

/* Turns about v from corner c to a face at edge e, clockwise first; turns met are added to *turn.
 */
static int32_t pivot(const setting *s, int32_t c, int32_t e, int32_t *turn) {
    const qc_mesh *m = s->mesh;
    for (int way = 0; way < 2; way++) {
        int32_t at = c, turns = *turn;
        for (;;) {
            if (m->halfedge_edge[qc_next(at)] == e || m->halfedge_edge[qc_prev(at)] == e) {
                *turn = turns;
                return at;
            }
            const int32_t h = way == 0 ? qc_prev(at) : qc_next(at);
            if (m->twin[h] < 0) break;
            turns += combed_turn(s, h);
            at = way == 0 ? qc_corner_cw(m, at) : qc_corner_ccw(m, at);
            if (at == c) break;
        }
    }
    fail_msg("edge %d is not at the vertex", (int)e);
    return -1;
}

/* The image of a path of edges from cone vertex v, developed into the chart of the lower face of
 * its first. */
static complex_t develop(const setting *s, const qc_complex *f, int32_t v, int32_t n,
                         const int32_t *path, int32_t *end) {
    const qc_mesh *m = s->mesh;
    complex_t sum = 0;
    int32_t c = corner_at(m, m->edge_halfedge[2 * path[0]] / 3, v), turn = 0;
    for (int32_t i = 0; i < n; i++) {
        if (i > 0) c = pivot(s, c, path[i], &turn);
        v = other_end(m, path[i], v);
        const int32_t d = corner_at(m, c / 3, v);
        sum += qc__turn(qc__complex(f[d]) - qc__complex(f[c]), -turn);
        c = d;
    }
    *end = v;
    return sum;
}

/* Shortest path from a to b; its length; INFINITY when it passes the cell of another cone. nearest:
 * distance of each vertex from the nearest cone. */
static double shortest_path(const setting *s, const double *nearest, int32_t a, int32_t b,
                            int32_t *n, int32_t *path) {
    const qc_mesh *m = s->mesh;
    uint8_t *source = ARRAY(uint8_t, m->n_vertices);
    double *distance = ARRAY(double, m->n_vertices);
    int32_t *towards = ARRAY(int32_t, m->n_vertices);
    source[b] = 1;
    must(s->ctx, qc_mesh_shortest_paths(s->ctx, m, NULL, source, distance, towards));
    double length = distance[a];
    *n = 0;
    for (int32_t v = a; v != b; v = other_end(m, path[(*n)++], v)) {
        const double on_path = fmin(distance[v], distance[a] - distance[v]);
        path[*n] = towards[v];
        if (nearest[v] < on_path - 1e-9 * distance[a]) length = INFINITY;
    }
    free(source);
    free(distance);
    free(towards);
    return length;
}

static void forms_measure_the_vector_between_cones(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    int32_t compared = 0, longer = 0;
    for (int i = 0; i < N_CASES; i++) {
        qc_complex *f = NULL;
        problem *p = problem_create(ctx, &CASES[i], 200, &f);
        const qc__separation *s = p->separation;
        int32_t *path = ARRAY(int32_t, p->s->mesh->n_vertices);
        uint8_t *cones = ARRAY(uint8_t, p->s->mesh->n_vertices);
        double *nearest = ARRAY(double, p->s->mesh->n_vertices);
        for (int32_t k = 0; k < p->seams->n_cones; k++) cones[p->seams->cone_vertex[k]] = 1;
        must(ctx, qc_mesh_shortest_paths(ctx, p->s->mesh, NULL, cones, nearest, NULL));
        for (int32_t pair = 0; pair < s->n; pair++) {
            int32_t n = 0, end = -1;
            const int32_t a = s->vertex[2 * pair];
            const int32_t b = s->vertex[2 * pair + 1];
            assert_true(a < b);
            const double length = shortest_path(p->s, nearest, a, b, &n, path);
            if (!(length < p->reach)) continue;
            const complex_t wanted = develop(p->s, f, a, n, path, &end);
            const complex_t form = form_of(s, pair, p->t);
            assert_int_equal(end, b);
            compared++;
            longer += n > 2;
            if (cabs(form - wanted) > 1e-8 * (1 + cabs(wanted)))
                fail_msg("%s: cones %d and %d: (%g, %g), not (%g, %g), %d edges", CASES[i].shape,
                         (int)a, (int)b, creal(form), cimag(form), creal(wanted), cimag(wanted),
                         (int)n);
        }
        free(nearest);
        free(cones);
        free(path);
        free(f);
        problem_free(p);
    }
    assert_true(compared > 50 && longer > 5);
    qc_ctx_free(ctx);
}

/* Every pair of cones joined by one edge is found. */
static void neighbours_are_found(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    int32_t found = 0;
    for (int i = 0; i < N_CASES; i++) {
        problem *p = problem_create(ctx, &CASES[i], 200, NULL);
        const qc_mesh *m = p->s->mesh;
        for (int32_t e = 0; e < m->n_edges; e++) {
            const int32_t a = p->seams->vertex_cone[m->edge_vertex[2 * e]];
            const int32_t b = p->seams->vertex_cone[m->edge_vertex[2 * e + 1]];
            const double *x = m->position + 3 * m->edge_vertex[2 * e];
            const double *y = m->position + 3 * m->edge_vertex[2 * e + 1];
            if (a < 0 || b < 0) continue;
            if (hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]) >= p->reach) continue;
            int32_t count = 0;
            for (int32_t k = 0; k < p->separation->n; k++) {
                const int32_t *ends = p->separation->vertex + 2 * k;
                const int32_t pair[2] = {p->seams->vertex_cone[ends[0]],
                                         p->seams->vertex_cone[ends[1]]};
                count += (pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a);
            }
            assert_int_equal(count, 1);
            found++;
        }
        problem_free(p);
    }
    assert_true(found > 0);
    qc_ctx_free(ctx);
}

/* --- the search ------------------------------------------------------------------------------- */

static double energy_at(const problem *p, const double *t, const double *z) {
    double sum = 0;
    for (int64_t j = 0; j < p->n; j++)
        for (int64_t i = 0; i < p->n; i++)
            sum += 0.5 * (z[i] - t[i]) * p->P[i + j * p->n] * (z[j] - t[j]);
    return sum;
}

static int32_t collisions(const problem *p, const double *t, const double *z) {
    int32_t n = 0;
    for (int32_t k = 0; k < p->separation->n; k++) {
        const complex_t now = form_of(p->separation, k, z), w = form_of(p->separation, k, t);
        n += cabs(now) < 0.5 || creal(now) * creal(w) + cimag(now) * cimag(w) < -1e-12;
    }
    return n;
}

static void separated_cones_do_not_collide(void **state) {
    (void)state;
    qc_ctx *ctx = context(1);
    uint64_t random = 21;
    int32_t cleared = 0, untouched = 0;
    for (int i = 0; i < N_CASES; i++)
        for (int round = 0; round < 4; round++) {
            problem *p = problem_create(ctx, &CASES[i], round % 2 ? 100 : 800, NULL);
            const int64_t size = p->n;
            double *t = ARRAY(double, size), *z = ARRAY(double, size), *z0 = ARRAY(double, size);
            for (int64_t j = 0; j < size; j++) {
                t[j] = p->t[j] + (round > 1 ? 3 * uniform(&random) : 0);
                z[j] = z0[j] = rint(t[j]);
            }
            const int32_t before = collisions(p, t, z);
            const double start = energy_at(p, t, z);
            double energy = start;
            int32_t left = -1;
            must(ctx, qc__separate(ctx, p->separation, p->n, p->P, t, true, z, &energy, &left));
            for (int64_t j = 0; j < size; j++) assert_true(z[j] == rint(z[j]));
            const double wanted = energy_at(p, t, z);
            assert_true(fabs(energy - wanted) <= 1e-9 * (1 + wanted + start));
            assert_int_equal(left, collisions(p, t, z));
            assert_true(left <= before);
            cleared += before > 0 && left == 0;
            if (before == 0) {
                assert_memory_equal(z, z0, sizeof *z * (size_t)size);
                untouched++;
            }
            free(z0);
            free(z);
            free(t);
            problem_free(p);
        }
    assert_true(cleared > 0 && untouched > 0);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forms_measure_the_vector_between_cones),
        cmocka_unit_test(neighbours_are_found),
        cmocka_unit_test(separated_cones_do_not_collide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
