/* E_D by two routes (docs/conventions.md): from the co-potential, and as the minimum of 1/2 int
 * |grad f - Z|^2 over the maps of the cut surface which are seamless up to free translations. The
 * second is solved densely: one unknown per vertex of the open surface, one equation per cut edge,
 * both as they are written down, in orthonormal frames. Agreement to 13 digits pins every sign. */
#include <lapacke.h>

#include "unit/dec/forms.h"

typedef struct problem {
    const qc_mesh *m;
    int32_t n, n_cut, *vertex; /* unknown of each corner */
    int8_t *turn, *residual;
    uint8_t *cut;
    double _Complex *B; /* n_cut x n: seams */
} problem;

static int32_t find(int32_t *set, int32_t i) {
    while (set[i] != i) i = set[i] = set[set[i]];
    return i;
}

static void open_surface(qc_ctx *ctx, const qc_cover *cover, problem *p) {
    const qc_mesh *m = p->m = cover->mesh;
    int8_t *shift = NEW_ARRAY(int8_t, m->n_vertices);
    uint8_t *base = NEW_ARRAY(uint8_t, m->n_vertices);
    p->turn = NEW_ARRAY(int8_t, m->n_faces);
    p->residual = NEW_ARRAY(int8_t, m->n_edges);
    p->cut = NEW_ARRAY(uint8_t, m->n_edges);
    p->vertex = NEW_ARRAY(int32_t, 3 * m->n_faces);
    assert_int_equal(qc_cover_shifts(ctx, cover, shift), QC_OK);
    for (int32_t v = 0; v < m->n_vertices; v++) base[v] = shift[v] != 0;
    assert_int_equal(qc_mesh_cut_graph(ctx, m, NULL, base, p->cut), QC_OK);
    assert_int_equal(qc_cover_comb(ctx, cover, p->cut, p->turn, p->residual, NULL), QC_OK);
    for (int32_t c = 0; c < 3 * m->n_faces; c++) p->vertex[c] = c;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t h = m->edge_halfedge[2 * e], k = m->edge_halfedge[2 * e + 1];
        p->n_cut += p->cut[e];
        if (p->cut[e] || k < 0) continue;
        assert_int_equal(p->residual[e], 0);
        p->vertex[find(p->vertex, qc_next(h))] = find(p->vertex, qc_prev(k));
        p->vertex[find(p->vertex, qc_prev(h))] = find(p->vertex, qc_next(k));
    }
    int32_t *number_of = NEW_ARRAY(int32_t, 3 * m->n_faces);
    for (int32_t c = 0; c < 3 * m->n_faces; c++)
        if (find(p->vertex, c) == c) number_of[c] = p->n++;
    int32_t *root = NEW_ARRAY(int32_t, 3 * m->n_faces);
    for (int32_t c = 0; c < 3 * m->n_faces; c++) root[c] = find(p->vertex, c);
    for (int32_t c = 0; c < 3 * m->n_faces; c++) p->vertex[c] = number_of[root[c]];
    free(root), free(number_of), free(shift), free(base);
}

/* f_t - i^{-r} f_s is the same at both ends of a cut edge (and so all along its segment). */
static void add_seams(problem *p) {
    const qc_mesh *m = p->m;
    p->B = NEW_ARRAY(double _Complex, p->n_cut * p->n);
    for (int32_t e = 0, row = 0; e < m->n_edges; e++) {
        if (!p->cut[e]) continue;
        const int32_t h = m->edge_halfedge[2 * e], k = m->edge_halfedge[2 * e + 1];
        const double _Complex rotation = cpow(I, -p->residual[e]);
        p->B[row + p->n_cut * p->vertex[qc_prev(k)]] += 1;
        p->B[row + p->n_cut * p->vertex[qc_next(k)]] -= 1;
        p->B[row + p->n_cut * p->vertex[qc_next(h)]] -= rotation;
        p->B[row + p->n_cut * p->vertex[qc_prev(h)]] += rotation;
        row++;
    }
}

/* Orthonormal basis of the kernel of B: *dim columns of the result. */
static double _Complex *seamless_maps(const problem *p, int32_t *dim) {
    const int32_t n = p->n, rows = p->n_cut > 0 ? p->n_cut : 1;
    double _Complex *V = NEW_ARRAY(double _Complex, n *n), *N = NEW_ARRAY(double _Complex, n *n);
    double _Complex *B = NEW_ARRAY(double _Complex, rows *n), none[1];
    double *s = NEW_ARRAY(double, n), *super = NEW_ARRAY(double, n);
    memcpy(B, p->B, (size_t)(p->n_cut * n) * sizeof(*B));
    assert_int_equal(
        LAPACKE_zgesvd(LAPACK_COL_MAJOR, 'N', 'A', rows, n, B, rows, s, none, 1, V, n, super), 0);
    int32_t r = 0;
    while (r < p->n_cut && r < n && s[r] > 1e-10 * s[0]) r++;
    *dim = n - r;
    for (int32_t j = 0; j < n - r; j++)
        for (int32_t i = 0; i < n; i++) N[i + j * n] = conj(V[r + j + i * n]);
    free(V), free(B), free(s), free(super);
    return N;
}

/* sqrt(area) times the two components of the gradient of the corner values f. */
static void gradient(const qc_complex *edge, int32_t t, const double _Complex f[3],
                     double _Complex out[2]) {
    const double twice_area = cimag(conj(number(edge[3 * t])) * number(edge[3 * t + 1]));
    out[0] = out[1] = 0;
    for (int k = 0; k < 3; k++) { /* grad phi_k = J e_k / (2 A) */
        const double _Complex g = I * number(edge[3 * t + k]) / twice_area;
        out[0] += sqrt(twice_area / 2) * creal(g) * f[k];
        out[1] += sqrt(twice_area / 2) * cimag(g) * f[k];
    }
}

static double direct_energy(const problem *p, const qc_complex *edge, const qc_complex *z) {
    const qc_mesh *m = p->m;
    const int32_t rows = 2 * m->n_faces;
    int32_t dim, rank;
    double _Complex *N = seamless_maps(p, &dim), *A = NEW_ARRAY(double _Complex, rows *dim);
    double _Complex *b = NEW_ARRAY(double _Complex, rows + dim), *x = b;
    double *s = NEW_ARRAY(double, rows + dim), energy = 0;
    for (int32_t t = 0; t < m->n_faces; t++) {
        const qc_complex *zt = z + 3 * t; /* combed, as gradient of corner values 0, z_2, -z_1 */
        const double _Complex f[3] = {0, number(qc_quarter_turn(zt[2], p->turn[t])),
                                      -number(qc_quarter_turn(zt[1], p->turn[t]))};
        gradient(edge, t, f, b + 2 * t);
        for (int32_t j = 0; j < dim; j++) {
            double _Complex g[3];
            for (int k = 0; k < 3; k++) g[k] = N[p->vertex[3 * t + k] + j * p->n];
            gradient(edge, t, g, A + 2 * t + j * rows);
        }
    }
    double _Complex *A0 = NEW_ARRAY(double _Complex, rows *dim),
                    *c = NEW_ARRAY(double _Complex, rows);
    memcpy(A0, A, (size_t)(rows * dim) * sizeof(*A));
    memcpy(c, b, (size_t)rows * sizeof(*c));
    const int32_t ldb = rows > dim ? rows : dim;
    assert_int_equal(
        LAPACKE_zgelsd(LAPACK_COL_MAJOR, rows, dim, 1, A, rows, b, ldb, s, 1e-10, &rank), 0);
    for (int32_t i = 0; i < rows; i++) {
        for (int32_t j = 0; j < dim; j++) c[i] -= A0[i + j * rows] * x[j];
        energy += 0.5 * creal(c[i] * conj(c[i]));
    }
    free(N), free(A), free(A0), free(b), free(c), free(s);
    return energy;
}

static void compare(qc_ctx *ctx, const qc_cover *cover, const qc_complex *edge,
                    const qc_complex *z) {
    problem p = {0};
    double *cot = cotangents(ctx, cover->mesh), energy = -1;
    open_surface(ctx, cover, &p);
    add_seams(&p);
    assert_int_equal(qc_hodge_remove_curl(ctx, cover, cot, NULL, z, NULL, NULL, &energy), QC_OK);
    const double direct = direct_energy(&p, edge, z);
    assert_true(fabs(direct - energy) < 1e-13 * energy);
    free(cot), free(p.turn), free(p.residual), free(p.cut), free(p.vertex), free(p.B);
}

static void random_fields(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s, (void)kind;
    const qc_mesh *m = cover->mesh;
    qc_complex *edge = NEW_ARRAY(qc_complex, 3 * m->n_faces), *z = random_form(m);
    assert_int_equal(qc_tangent_edges(ctx, m, edge), QC_OK);
    compare(ctx, cover, edge, z);
    free(edge), free(z);
}

/* A cross field which follows a smooth field of directions in space, with its straightest matching.
 */
static void smooth_field(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s;
    if (kind != PLAIN) return;
    const qc_mesh *m = cover->mesh;
    const int32_t n = 3 * m->n_faces;
    qc_complex *edge = NEW_ARRAY(qc_complex, n), *rho = NEW_ARRAY(qc_complex, m->n_edges);
    qc_complex *x = NEW_ARRAY(qc_complex, m->n_faces), *z = NEW_ARRAY(qc_complex, n);
    double *a = NEW_ARRAY(double, n), *b = NEW_ARRAY(double, n);
    int8_t *matching = NEW_ARRAY(int8_t, m->n_edges);
    assert_int_equal(qc_tangent_edges(ctx, m, edge), QC_OK);
    assert_int_equal(qc_tangent_frames(ctx, m, a, b), QC_OK);
    assert_int_equal(qc_tangent_transport(ctx, m, edge, rho), QC_OK);
    for (int32_t t = 0; t < m->n_faces; t++) {
        const double *p = m->position + 3 * m->face_vertex[3 * t];
        const double d[3] = {1, sin(p[0] + 1), cos(p[1])};
        double _Complex w = 0;
        for (int i = 0; i < 3; i++) w += d[i] * (a[3 * t + i] + I * b[3 * t + i]);
        w /= cabs(w);
        w *= cpow(I, random_int(4)); /* any of the four branches */
        x[t] = (qc_complex){creal(w), cimag(w)};
    }
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t hs = m->edge_halfedge[2 * e], ht = m->edge_halfedge[2 * e + 1];
        if (ht < 0) continue;
        const double _Complex r = number(x[ht / 3]) / (number(rho[e]) * number(x[hs / 3]));
        matching[e] = (int8_t)lround(2 * carg(r) / 3.14159265358979323846);
    }
    const qc_cover straight = {m, matching};
    assert_int_equal(qc_form_from_cross(ctx, m, edge, x, NULL, z), QC_OK);
    compare(ctx, &straight, edge, z);
    free(edge), free(rho), free(x), free(z), free(a), free(b), free(matching);
}

static void test_random(void **state) {
    (void)state, for_all_covers(random_fields);
}
static void test_smooth(void **state) {
    (void)state, for_all_covers(smooth_field);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random),
                                       cmocka_unit_test(test_smooth)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
