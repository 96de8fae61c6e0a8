/* qc_quads_transfer: linear functions come through exactly, charts and groups keep their borders.
 */
#include "unit/finish/quads.h"

/* The triangles of a mesh as input: uv = (x, y), moved by `gap` right of x = 1/2; group 1 left of
 * it, 2 right of it; colour (x, y, 1/2). */
static qc_polygon_mesh *as_input(qc_ctx *ctx, const qc_mesh *m, double gap) {
    qc_polygon_mesh *p = NULL;
    assert_int_equal(qc_polygon_mesh_create(ctx, m->n_vertices, m->n_faces, 3 * m->n_faces,
                                            3 * m->n_faces, 0,
                                            QC_POLYGON_FACE_GROUP | QC_POLYGON_COLOUR, &p),
                     QC_OK);
    memcpy(p->position, m->position, 3 * sizeof(double) * (size_t)m->n_vertices);
    memcpy(p->face_vertex, m->face_vertex, 3 * sizeof(int32_t) * (size_t)m->n_faces);
    for (int32_t v = 0; v < m->n_vertices; v++)
        for (int k = 0; k < 3; k++) p->colour[3 * v + k] = k < 2 ? m->position[3 * v + k] : 0.5;
    int32_t *number = calloc(2 * (size_t)m->n_vertices, sizeof *number);
    p->n_uvs = 0;
    for (int32_t f = 0; f < m->n_faces; f++) {
        double x = 0;
        p->face_offset[f + 1] = 3 * f + 3;
        for (int k = 0; k < 3; k++) x += m->position[3 * m->face_vertex[3 * f + k]] / 3;
        p->face_group[f] = x < 0.5 ? 1 : 2;
        for (int k = 0; k < 3; k++) { /* one uv for each vertex and side */
            const int32_t v = m->face_vertex[3 * f + k];
            int32_t *i = &number[2 * v + (gap > 0 && x > 0.5)];
            if (*i == 0) {
                p->uv[2 * p->n_uvs] = m->position[3 * v] + (x > 0.5 ? gap : 0);
                p->uv[2 * p->n_uvs + 1] = m->position[3 * v + 1];
                *i = ++p->n_uvs;
            }
            p->corner_uv[3 * f + k] = *i - 1;
        }
    }
    free(number);
    return p;
}

/* Quads left and right of x = 1/2 have their side's group and uvs; those across it have no uvs
 * when there is a gap. Returns how many have none. */
static int check(const qc_polygon_mesh *q, double gap) {
    int none = 0;
    for (int32_t f = 0; f < q->n_faces; f++) {
        double x = 0, lo = 1, hi = 0;
        for (int k = 0; k < 4; k++) {
            const double at = q->position[3 * q->face_vertex[4 * f + k]];
            x += at / 4;
            lo = fmin(lo, at);
            hi = fmax(hi, at);
        }
        if (fabs(x - 0.5) > 1e-9) assert_int_equal(q->face_group[f], x < 0.5 ? 1 : 2);
        const bool across = lo < 0.5 - 1e-9 && hi > 0.5 + 1e-9;
        for (int k = 0; k < 4; k++) {
            const int32_t i = q->corner_uv[4 * f + k];
            const double *at = q->position + 3 * q->face_vertex[4 * f + k];
            assert_true((i < 0) == (across && gap > 0));
            if (i < 0) continue;
            assert_near(q->uv[2 * i], at[0] + (x > 0.5 ? gap : 0), 1e-3);
            assert_near(q->uv[2 * i + 1], at[1], 1e-3);
        }
        none += across && gap > 0;
    }
    for (int32_t v = 0; v < q->n_vertices; v++) {
        assert_near(q->colour[3 * v], q->position[3 * v], 1e-12);
        assert_near(q->colour[3 * v + 1], q->position[3 * v + 1], 1e-12);
        assert_near(q->colour[3 * v + 2], 0.5, 1e-12);
    }
    return none;
}

static void attributes_come_through(void **state) {
    static const struct {
        int n;
        double gap;
        int none;
    } cases[] = {{8, 0, 0}, {8, 3, 0}, {7, 3, 7}};
    for (int i = 0; i < 3; i++) {
        qc_mesh *m = grid(*state, 10, 6, 0, 1);
        qc_polygon_mesh *in = as_input(*state, m, cases[i].gap), *out = NULL;
        qc_polygon_mesh *q = quad_grid(*state, cases[i].n, 0, -1, 1);
        assert_int_equal(qc_quads_transfer(*state, in, m, q, &out), QC_OK);
        assert_int_equal(check(out, cases[i].gap), cases[i].none);
        if (cases[i].gap <= 0) assert_int_equal(out->n_uvs, q->n_vertices);
        qc_object_release(out);
        qc_object_release(q);
        qc_object_release(in);
        qc_object_release(m);
    }
}

static void nothing_is_made_up(void **state) {
    qc_mesh *m = grid(*state, 4, 4, 0, 1);
    qc_polygon_mesh *in = NULL, *out = NULL, *q = quad_grid(*state, 3, 0, -1, 1);
    assert_int_equal(
        qc_polygon_mesh_create(*state, m->n_vertices, m->n_faces, 3 * m->n_faces, 0, 0, 0, &in),
        QC_OK);
    assert_int_equal(qc_quads_transfer(*state, in, m, q, &out), QC_OK);
    assert_true(!out->uv && !out->face_group && !out->colour);
    qc_object_release(out);
    qc_object_release(q);
    qc_object_release(in);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(attributes_come_through),
        cmocka_unit_test(nothing_is_made_up),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
