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
        qc_sizing *s = NULL;
        write_file(path, cases[i].text);
        assert_int_equal(qc_sizing_create_varying(*state, m, 0, &o, &s), QC_ERR_INPUT);
        assert_int_equal(qc_ctx_error(*state)->where, cases[i].where);
        assert_null(s);
    }
    unlink(path);
    qc_sizing *s = NULL;
    assert_int_equal(qc_sizing_create_varying(*state, m, 0, &o, &s), QC_ERR_IO);
    o.path = NULL;
    o.painted = true;
    assert_int_equal(qc_sizing_create_varying(*state, m, 0, &o, &s), QC_ERR_ARGUMENT);
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
    assert_non_null(in->quality);
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plane_surfaces_keep_their_length),
        cmocka_unit_test(bent_surfaces_get_shorter_edges),
        cmocka_unit_test(lengths_grow_slowly),
        cmocka_unit_test(wrong_files_are_refused),
        cmocka_unit_test(paint_multiplies_the_density),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
