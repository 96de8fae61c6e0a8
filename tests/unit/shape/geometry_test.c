/* The shapes are what they claim: oriented outwards, flat, round, minimal. */
#include "unit/shape/fixtures.h"

static qc_mesh *fine(qc_ctx *ctx, const char *name) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    options.resolution = 12000;
    return shape(ctx, name, &options);
}

static double volume(const qc_mesh *m) {
    double sum = 0;
    for (int32_t f = 0; f < m->n_faces; f++) {
        const double *a = m->position + 3 * m->face_vertex[3 * f];
        const double *b = m->position + 3 * m->face_vertex[3 * f + 1];
        const double *c = m->position + 3 * m->face_vertex[3 * f + 2];
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum / 6;
}

static void test_outwards(void **state) {
    const double pi = 3.14159265358979323846;
    const struct {
        const char *name;
        double volume; /* 0 = only its sign is known */
    } closed[] = {{"sphere", 4 * pi / 3},
                  {"ellipsoid", 4 * pi / 3 * 1.05},
                  {"flat-torus", 0},
                  {"torus", 2 * pi * pi * 0.16},
                  {"cube", 8},
                  {"cylinder", 3 * pi},
                  {"truncated-cone", 1.6 * pi * 1.56 / 3},
                  {"knot", 0},
                  {"lawson", 0},
                  {"genus", 0}};
    for (size_t i = 0; i < sizeof closed / sizeof *closed; i++) {
        qc_mesh *m = fine(*state, closed[i].name);
        double v = volume(m);
        assert_true(v > 0);
        if (closed[i].volume > 0) assert_true(fabs(v / closed[i].volume - 1) < 5e-3);
        qc_object_release(m);
    }
}

static void test_flat(void **state) {
    qc_mesh *m = fine(*state, "flat-torus");
    double *gauss = malloc((size_t)m->n_vertices * sizeof *gauss);
    assert_int_equal(qc_mesh_geometry(*state, m, NULL, NULL, NULL, NULL, NULL, gauss), QC_OK);
    for (int32_t v = 0; v < m->n_vertices; v++) assert_true(fabs(gauss[v]) < 1e-11);
    free(gauss);
    qc_object_release(m);
}

/* Area gradient (cotangent Laplacian of the position) against the total curvature, both scale-free:
 * sum |H|^2 A over sum |K| A with K the angle defect, over interior vertices. */
static double bending(qc_ctx *ctx, const qc_mesh *m) {
    size_t n = (size_t)m->n_vertices;
    double *cotangent = malloc(3 * (size_t)m->n_faces * 8), *area = malloc((size_t)m->n_faces * 8);
    double *gauss = malloc(n * 8), *laplace = calloc(3 * n, 8), *mass = calloc(n, 8);
    double h2 = 0, k = 0;
    assert_int_equal(qc_mesh_geometry(ctx, m, NULL, area, cotangent, NULL, NULL, gauss), QC_OK);
    for (int32_t c = 0; c < 3 * m->n_faces; c++) {
        int32_t a = qc_halfedge_start(m, c), b = qc_halfedge_end(m, c);
        mass[a] += area[c / 3] / 6;
        mass[b] += area[c / 3] / 6;
        for (int i = 0; i < 3; i++) {
            double d = 0.5 * cotangent[c] * (m->position[3 * b + i] - m->position[3 * a + i]);
            laplace[3 * a + i] += d;
            laplace[3 * b + i] -= d;
        }
    }
    for (int32_t v = 0; v < m->n_vertices; v++) {
        if (qc_vertex_on_boundary(m, v)) continue;
        for (int i = 0; i < 3; i++) h2 += pow(0.5 * laplace[3 * v + i], 2) / mass[v];
        k += fabs(gauss[v]);
    }
    free(cotangent);
    free(area);
    free(gauss);
    free(laplace);
    free(mass);
    return h2 / k;
}

static void test_minimal(void **state) {
    qc_mesh *trinoid = fine(*state, "trinoid"), *costa = fine(*state, "costa");
    qc_mesh *sphere = fine(*state, "sphere"), *p = fine(*state, "schwarz-p");
    assert_true(fabs(bending(*state, sphere) - 1) < 0.05); /* H^2 = K */
    assert_true(bending(*state, trinoid) < 1e-2);
    assert_true(bending(*state, costa) < 1e-2);
    assert_true(bending(*state, p) < 3e-2); /* the nodal approximation */
    qc_object_release(trinoid);
    qc_object_release(costa);
    qc_object_release(sphere);
    qc_object_release(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_outwards),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_minimal),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
