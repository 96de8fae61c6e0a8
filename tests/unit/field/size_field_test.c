/* qc_sizing_create_varying: what lengths mean, what limits them, and which files are refused. */
#include <qc/field.h>
#include <stdio.h>
#include <unistd.h>

#include "unit/mesh/fixtures.h"

static qc_sizing *make(qc_ctx *ctx, const qc_mesh *m, double quads, const qc_size_options *o) {
    qc_sizing *s = NULL;
    const qc_status status = qc_sizing_create_varying(ctx, m, quads, o, &s);
    if (status != QC_OK) print_error("%s\n", qc_ctx_error(ctx)->text);
    assert_int_equal(status, QC_OK);
    return s;
}

static double quads_asked_for(qc_ctx *ctx, const qc_sizing *s) {
    double *area = malloc((size_t)s->mesh->n_faces * sizeof *area), n = 0;
    assert_int_equal(qc_mesh_geometry(ctx, s->mesh, NULL, area, NULL, NULL, NULL, NULL), QC_OK);
    for (int32_t t = 0; t < s->mesh->n_faces; t++) n += area[t] / (s->length[t] * s->length[t]);
    free(area);
    return n;
}

static void plane_surfaces_keep_their_length(void **state) {
    qc_mesh *m = grid(*state, 8, 8, 0, 1);
    qc_size_options o = QC_SIZE_OPTIONS_INIT;
    o.edge_length = 0.1;
    o.turn = 0.1;
    qc_sizing *s = make(*state, m, 0, &o);
    for (int32_t t = 0; t < m->n_faces; t++) assert_near(s->length[t], 0.1, 1e-12);
    qc_object_release(s);
    qc_object_release(m);
}

/* A torus bends most about its tube: radius 1, so the length becomes `turn`. */
static void bent_surfaces_get_shorter_edges(void **state) {
    for (int i = 0; i < 3; i++) {
        static const double scale[] = {1, 1e-6, 1e6};
        qc_mesh *m = grid(*state, 60, 40, 3, scale[i]);
        qc_size_options o = QC_SIZE_OPTIONS_INIT;
        o.edge_length = 0.4 * scale[i];
        o.turn = 0.2;
        qc_sizing *s = make(*state, m, 0, &o);
        for (int32_t t = 0; t < m->n_faces; t++) assert_near(s->length[t] / scale[i], 0.2, 0.03);
        qc_object_release(s);
        s = make(*state, m, 500, &o);
        assert_near(quads_asked_for(*state, s), 500, 1e-6);
        qc_object_release(s);
        qc_object_release(m);
    }
}

/* Lengths of `in` for a file, one a line. */
static void write_file(const char *path, const char *text) {
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void lengths_grow_slowly(void **state) {
    enum { N = 20 };
    static const char path[] = "size_field_test.txt";
    qc_mesh *m = grid(*state, N, N, 0, 1);
    FILE *f = fopen(path, "w");
    for (int32_t t = 0; t < m->n_faces; t++) fprintf(f, "%s\n", t == 210 ? "0.01 # fine" : "1");
    fclose(f);
    qc_size_options o = QC_SIZE_OPTIONS_INIT;
    o.edge_length = 1;
    o.path = path;
    o.gradation = 0.5;
    qc_sizing *s = make(*state, m, 0, &o);
    double least = 1;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t *h = m->edge_halfedge + 2 * e;
        if (h[1] < 0) continue;
        const double step = fabs(s->length[h[0] / 3] - s->length[h[1] / 3]);
        assert_true(step <= 0.5 * sqrt(2) / N * 2 / 3 + 1e-12); /* one corner differs */
        least = fmin(least, s->length[h[0] / 3]);
    }
    assert_near(least, 0.01, 1e-12);
    qc_object_release(s);
    o.gradation = 0;
    s = make(*state, m, 0, &o);
    assert_near(s->length[210], 0.01, 1e-15);
    assert_near(s->length[211], 1, 1e-15);
    qc_object_release(s);
    qc_object_release(m);
    unlink(path);
}

static void assert_refused(qc_ctx *ctx, const qc_mesh *m, const qc_size_options *o,
                           qc_status status, int64_t where) {
    qc_sizing *s = NULL;
    assert_int_equal(qc_sizing_create_varying(ctx, m, 0, o, &s), status);
    assert_int_equal(qc_ctx_error(ctx)->where, where);
    assert_null(s);
}

static void wrong_files_are_refused(void **state) {
    static const char path[] = "size_field_test_bad.txt";
    static const struct {
        const char *text;
        int64_t where;
    } cases[] = {{"1\n1\nzero\n", 3}, {"1 2\n-1", 2}, {"1 2 3", 3}, {"", 0}, {"1\nnan", 2}};
    qc_mesh *m = grid(*state, 2, 2, 0, 1);
    qc_size_options o = QC_SIZE_OPTIONS_INIT;
    o.edge_length = 1;
    o.path = path;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        write_file(path, cases[i].text);
        assert_refused(*state, m, &o, QC_ERR_INPUT, cases[i].where);
    }
    unlink(path);
    assert_refused(*state, m, &o, QC_ERR_IO, -1);
    o.path = NULL;
    o.painted = true;
    assert_refused(*state, m, &o, QC_ERR_ARGUMENT, -1);
    qc_object_release(m);
}

static void paint_multiplies_the_density(void **state) {
    static const char ply[] = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                              "property float y\nproperty float z\nproperty float quality\n"
                              "element face 2\nproperty list uchar int vertex_indices\n"
                              "end_header\n0 0 0 4\n1 0 0 4\n1 1 0 4\n0 1 0 1\n"
                              "3 0 1 2\n3 0 2 3\n";
    qc_polygon_mesh *in = NULL;
    qc_mesh *m = NULL;
    assert_int_equal(qc_polygon_mesh_parse(*state, ply, sizeof ply - 1, "a.ply", &in), QC_OK);
    assert_non_null(qc_polygon_mesh_attribute(in, QC_AT_VERTEX, "quality"));
    assert_int_equal(qc_mesh_create(*state, 4, in->position, 2, in->face_vertex, &m), QC_OK);
    qc_size_options o = QC_SIZE_OPTIONS_INIT;
    o.edge_length = 1;
    o.painted = true;
    o.gradation = 0;
    o.input = in;
    qc_sizing *s = make(*state, m, 0, &o);
    assert_near(s->length[0], 0.5, 1e-12);
    assert_near(s->length[1], 1 / sqrt(3), 1e-12);
    qc_object_release(s);
    o.range = 1.5;
    s = make(*state, m, 0, &o);
    assert_near(s->length[0], 1 / 1.5, 1e-12);
    qc_object_release(s);
    qc_object_release(m);
    qc_object_release(in);
}

/* --- two lengths ------------------------------------------------------------------------------ */

/* The ratio of the length along d to that across in face t, and how far it is from stretched along
 * d or across (radians of the double angle). */
static double ratio_along(qc_ctx *ctx, const qc_sizing *s, int32_t t, const double d[3],
                          double *off) {
    const size_t n = 3 * (size_t)s->mesh->n_faces;
    double *real = malloc(n * sizeof *real), *imag = malloc(n * sizeof *imag);
    assert_int_equal(qc_tangent_frames(ctx, s->mesh, real, imag), QC_OK);
    double re = 0, im = 0;
    for (int k = 0; k < 3; k++) {
        re += d[k] * real[3 * t + k];
        im += d[k] * imag[3 * t + k];
    }
    const double angle = 2 * atan2(im, re);
    const double along = s->stretch[t].re * cos(angle) + s->stretch[t].im * sin(angle);
    *off = fabs(s->stretch[t].im * cos(angle) - s->stretch[t].re * sin(angle));
    free(real);
    free(imag);
    return exp(2 * along);
}

/* A cylinder bends about its axis, along which edges are long; a plane bends nowhere. */
static void edges_are_long_where_curvature_is_least(void **state) {
    static const double axis[3] = {0, 0, 1};
    for (int i = 0; i < 3; i++) {
        static const double scale[] = {1, 1e-6, 1e6};
        qc_mesh *m = grid(*state, 40, 8, 1, scale[i]);
        qc_size_options o = QC_SIZE_OPTIONS_INIT;
        o.edge_length = 0.2 * scale[i];
        o.anisotropy = 2;
        qc_sizing *s = make(*state, m, 300, &o);
        assert_near(quads_asked_for(*state, s), 300, 1e-6);
        for (int32_t t = 0; t < m->n_faces; t += 7) {
            double off;
            assert_near(ratio_along(*state, s, t, axis, &off), 2, 0.05);
            assert_near(off, 0, 0.02);
        }
        qc_object_release(s);
        qc_object_release(m);
    }
    qc_mesh *m = grid(*state, 8, 8, 0, 1);
    qc_size_options o = QC_SIZE_OPTIONS_INIT;
    o.edge_length = 0.2;
    o.anisotropy = 2;
    qc_sizing *s = make(*state, m, 0, &o);
    for (int32_t t = 0; t < m->n_faces; t++)
        assert_near(hypot(s->stretch[t].re, s->stretch[t].im), 0, 1e-12);
    qc_object_release(s);
    qc_object_release(m);
}

/* Both lengths of a bent surface are short enough, the one across by the ratio shorter. */
static void two_lengths_turn_by_little(void **state) {
    qc_mesh *m = grid(*state, 40, 8, 1, 1);
    qc_size_options o = QC_SIZE_OPTIONS_INIT;
    o.edge_length = 1;
    o.turn = 0.3;
    o.anisotropy = 4;
    qc_sizing *s = make(*state, m, 0, &o);
    for (int32_t t = 0; t < m->n_faces; t++) {
        const double across =
            s->length[t] * exp(-hypot(s->stretch[t].re, s->stretch[t].im)); /* about the axis */
        assert_near(across, 0.3, 0.02);
    }
    qc_object_release(s);
    qc_object_release(m);
}

/* The same tensor by vertex, by face, and with its two lengths named the other way round; the split
 * of a mesh keeps it in space. */
static void files_give_two_lengths(void **state) {
    static const char path[] = "size_field_test_two.txt";
    static const double d[3] = {0.6, 0.8, 0};
    static const char *const rows[] = {"0.2 0.1 0.6 0.8 0\n", "0.1 0.2 -8 6 0\n"};
    qc_mesh *m = grid(*state, 6, 5, 0, 1);
    for (int by_face = 0; by_face < 2; by_face++)
        for (int i = 0; i < 2; i++) {
            FILE *f = fopen(path, "w");
            assert_non_null(f);
            for (int32_t k = 0; k < (by_face ? m->n_faces : m->n_vertices); k++) fputs(rows[i], f);
            fclose(f);
            qc_size_options o = QC_SIZE_OPTIONS_INIT;
            o.edge_length = 1;
            o.path = path;
            qc_sizing *s = make(*state, m, 0, &o), *split = NULL;
            qc_features *features = NULL, *finer = NULL;
            qc_mesh *refined = NULL;
            uint8_t *edge = malloc((size_t)m->n_edges);
            memset(edge, 1, (size_t)m->n_edges);
            assert_int_equal(qc_features_create(*state, m, edge, true, &features), QC_OK);
            assert_int_equal(qc_features_split(*state, features, s, &refined, &finer, &split),
                             QC_OK);
            assert_true(refined->n_faces > m->n_faces);
            for (int32_t t = 0; t < refined->n_faces; t++) {
                double off;
                assert_near(ratio_along(*state, split, t, d, &off), 2, 1e-9);
                assert_near(off, 0, 1e-9);
                assert_near(split->length[t], sqrt(0.02), 1e-12);
            }
            free(edge);
            qc_object_release(features);
            qc_object_release(finer);
            qc_object_release(refined);
            qc_object_release(split);
            qc_object_release(s);
        }
    qc_object_release(m);
    unlink(path);
}

static void wrong_directions_are_refused(void **state) {
    static const char path[] = "size_field_test_direction.txt";
    static const struct {
        const char *row;
        qc_status status;
    } cases[] = {{"1 2 0 0 0\n", QC_ERR_INPUT},
                 {"1 -2 1 0 0\n", QC_ERR_INPUT},
                 {"0 2 1 0 0\n", QC_ERR_INPUT},
                 {"1 1e5 1 0 0\n", QC_ERR_ARGUMENT}};
    qc_mesh *m = grid(*state, 2, 2, 0, 1);
    qc_size_options o = QC_SIZE_OPTIONS_INIT;
    o.edge_length = 1;
    o.path = path;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        FILE *f = fopen(path, "w");
        assert_non_null(f);
        for (int32_t k = 0; k < m->n_faces; k++) fputs(k == 3 ? cases[i].row : "1 2 1 0 0\n", f);
        fclose(f);
        assert_refused(*state, m, &o, cases[i].status, cases[i].status == QC_ERR_INPUT ? 4 : 3);
    }
    unlink(path);
    o.path = NULL;
    o.anisotropy = 0.5;
    assert_refused(*state, m, &o, QC_ERR_ARGUMENT, -1);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plane_surfaces_keep_their_length),
        cmocka_unit_test(bent_surfaces_get_shorter_edges),
        cmocka_unit_test(lengths_grow_slowly),
        cmocka_unit_test(wrong_files_are_refused),
        cmocka_unit_test(paint_multiplies_the_density),
        cmocka_unit_test(edges_are_long_where_curvature_is_least),
        cmocka_unit_test(two_lengths_turn_by_little),
        cmocka_unit_test(files_give_two_lengths),
        cmocka_unit_test(wrong_directions_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
