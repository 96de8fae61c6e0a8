/* qc_quads_transfer: linear functions come through exactly, charts and groups keep their borders.
 */
#include "unit/finish/quads.h"

/* The triangles of a mesh as input: uv = (x, y), moved by `gap` right of x = 1/2; group 1 left of
 * it, 2 right of it; colour (x, y, 1/2). */
static qc_polygon_mesh *as_input(qc_ctx *ctx, const qc_mesh *m, double gap) {
    qc_polygon_mesh *p = NULL;
    assert_int_equal(qc_polygon_mesh_create(ctx, m->n_vertices, m->n_faces, 3 * m->n_faces,
                                            3 * m->n_faces, 0, QC_POLYGON_FACE_GROUP, &p),
                     QC_OK);
    memcpy(p->position, m->position, 3 * sizeof(double) * (size_t)m->n_vertices);
    memcpy(p->face_vertex, m->face_vertex, 3 * sizeof(int32_t) * (size_t)m->n_faces);
    double *colour = NULL;
    assert_int_equal(qc_polygon_mesh_add_attribute(ctx, p, "colour", QC_AT_VERTEX,
                                                   QC_ATTRIBUTE_LINEAR, 3, &colour),
                     QC_OK);
    for (int32_t v = 0; v < m->n_vertices; v++)
        for (int k = 0; k < 3; k++) colour[3 * v + k] = k < 2 ? m->position[3 * v + k] : 0.5;
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
    const double *colour = qc_polygon_mesh_attribute(q, QC_AT_VERTEX, "colour")->value;
    for (int32_t v = 0; v < q->n_vertices; v++) {
        assert_near(colour[3 * v], q->position[3 * v], 1e-12);
        assert_near(colour[3 * v + 1], q->position[3 * v + 1], 1e-12);
        assert_near(colour[3 * v + 2], 0.5, 1e-12);
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
    assert_true(!out->uv && !out->face_group && out->n_attributes == 0);
    qc_object_release(out);
    qc_object_release(q);
    qc_object_release(in);
    qc_object_release(m);
}

/* The square folded by 90 degrees along x = 1/2, each half with vertices of its own there: normals
 * differ on the two sides, which repair merges. */
static qc_polygon_mesh *folded(qc_ctx *ctx, int32_t at) {
    qc_polygon_mesh *p = NULL;
    double *normal = NULL;
    assert_int_equal(qc_polygon_mesh_create(ctx, 8, 4, 12, 0, 0, 0, &p), QC_OK);
    assert_int_equal(
        qc_polygon_mesh_add_attribute(ctx, p, "normal", at, QC_ATTRIBUTE_DIRECTION, 3, &normal),
        QC_OK);
    for (int half = 0; half < 2; half++)
        for (int i = 0; i < 4; i++) {
            const int v = 4 * half + i;
            const double along = i == 1 || i == 2;
            p->position[3 * v] = half ? 0.5 : 0.5 * along;
            p->position[3 * v + 1] = i >= 2;
            p->position[3 * v + 2] = half ? 0.5 * along : 0;
        }
    const int32_t corner[12] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    memcpy(p->face_vertex, corner, sizeof corner);
    for (int f = 0; f < 4; f++) p->face_offset[f + 1] = 3 * f + 3;
    for (int i = 0; i < (at == QC_AT_VERTEX ? 8 : 12); i++) {
        const int half = (at == QC_AT_VERTEX ? i : corner[i]) >= 4;
        normal[3 * i] = half ? -1 : 0;
        normal[3 * i + 2] = half ? 0 : 1;
    }
    return p;
}

static void the_side_of_a_crease_counts(void **state) {
    for (int32_t at = QC_AT_VERTEX; at <= QC_AT_CORNER; at += QC_AT_CORNER) {
        qc_polygon_mesh *in = folded(*state, at), *q = quad_grid(*state, 6, 0, -1, 1), *out = NULL;
        qc_mesh *m = NULL;
        fold(q->n_vertices, q->position, 1);
        assert_int_equal(qc_mesh_repair(*state, in, &m, NULL), QC_OK);
        assert_int_equal(m->n_vertices, 6);
        assert_int_equal(qc_quads_transfer(*state, in, m, q, &out), QC_OK);
        const qc_attribute *a = qc_polygon_mesh_attribute(out, QC_AT_CORNER, "normal");
        assert_non_null(a);
        assert_int_equal(out->n_attributes, 1);
        for (int32_t c = 0; c < out->n_corners; c++) {
            const bool right = c / 4 >= out->n_faces / 2;
            assert_near(a->value[3 * c], right ? -1 : 0, 1e-12);
            assert_near(a->value[3 * c + 2], right ? 0 : 1, 1e-12);
        }
        qc_object_release(out);
        qc_object_release(m);
        qc_object_release(q);
        qc_object_release(in);
    }
}

static double *add(qc_ctx *ctx, qc_polygon_mesh *p, const char *name, int32_t at, int32_t kind,
                   int32_t width) {
    double *value = NULL;
    assert_int_equal(qc_polygon_mesh_add_attribute(ctx, p, name, at, kind, width, &value), QC_OK);
    return value;
}

/* Vertices: weight = (1 - x, x (1 - y), x y) and the same with joints 5, 2 and, at odd vertices in
 * another order, 8; normal (x, 0, 1) / |.|; faces: heat = 1 + 2 x at the middle. */
static qc_polygon_mesh *weighted(qc_ctx *ctx, const qc_mesh *m) {
    qc_polygon_mesh *p = as_input(ctx, m, 0);
    double *w = add(ctx, p, "skin", QC_AT_VERTEX, QC_ATTRIBUTE_LINEAR, 3);
    double *joint = add(ctx, p, "joint", QC_AT_VERTEX, QC_ATTRIBUTE_LABEL, 3);
    double *weight = add(ctx, p, "weight", QC_AT_VERTEX, QC_ATTRIBUTE_LINEAR, 3);
    double *normal = add(ctx, p, "normal", QC_AT_VERTEX, QC_ATTRIBUTE_DIRECTION, 3);
    double *heat = add(ctx, p, "heat", QC_AT_FACE, QC_ATTRIBUTE_LINEAR, 1);
    double *label = add(ctx, p, "label", QC_AT_FACE, QC_ATTRIBUTE_LABEL, 1);
    static const double names[] = {5, 2, 8};
    for (int32_t v = 0; v < m->n_vertices; v++) {
        const double x = m->position[3 * v], y = m->position[3 * v + 1];
        const double all[] = {1 - x, x * (1 - y), x * y};
        memcpy(w + 3 * v, all, sizeof all);
        for (int k = 0; k < 3; k++) {
            joint[3 * v + k] = names[(k + v) % 3];
            weight[3 * v + k] = all[(k + v) % 3];
        }
        normal[3 * v] = x / sqrt(1 + x * x);
        normal[3 * v + 2] = 1 / sqrt(1 + x * x);
    }
    for (int32_t f = 0; f < m->n_faces; f++) {
        for (int k = 0; k < 3; k++) heat[f] += m->position[3 * m->face_vertex[3 * f + k]] / 3;
        label[f] = heat[f] < 0.5 ? 40 : 41;
    }
    return p;
}

static const double *values(const qc_polygon_mesh *q, int32_t at, const char *name) {
    const qc_attribute *a = qc_polygon_mesh_attribute(q, at, name);
    assert_non_null(a);
    return a->value;
}

static void weights_sum_to_one(void **state) {
    qc_mesh *m = grid(*state, 10, 6, 0, 1);
    qc_polygon_mesh *in = weighted(*state, m), *q = quad_grid(*state, 7, 0.2, -1, 1), *out = NULL;
    assert_int_equal(qc_quads_transfer(*state, in, m, q, &out), QC_OK);
    const double *skin = values(out, QC_AT_VERTEX, "skin");
    const double *joint = values(out, QC_AT_VERTEX, "joint");
    const double *weight = values(out, QC_AT_VERTEX, "weight");
    const double *normal = values(out, QC_AT_VERTEX, "normal");
    for (int32_t v = 0; v < q->n_vertices; v++) {
        double x = q->position[3 * v];
        assert_near(skin[3 * v] + skin[3 * v + 1] + skin[3 * v + 2], 1, 1e-14);
        assert_near(weight[3 * v] + weight[3 * v + 1] + weight[3 * v + 2], 1, 1e-14);
        assert_near(skin[3 * v], 1 - x, 1e-12);
        for (int k = 0; k < 3; k++) { /* each joint has the weight it has everywhere */
            const int i = joint[3 * v + k] == 5 ? 0 : joint[3 * v + k] == 2 ? 1 : 2;
            if (weight[3 * v + k] > 1e-12) assert_near(weight[3 * v + k], skin[3 * v + i], 1e-12);
            if (k > 0) assert_true(weight[3 * v + k] <= weight[3 * v + k - 1]);
        }
        assert_near(qc__norm3(normal + 3 * v), 1, 1e-14);
        assert_near(normal[3 * v] / normal[3 * v + 2], x, 0.01);
    }
    const double *heat = values(out, QC_AT_FACE, "heat"), *label = values(out, QC_AT_FACE, "label");
    for (int32_t f = 0; f < out->n_faces; f++) {
        double x = 0;
        for (int k = 0; k < 4; k++) x += q->position[3 * q->face_vertex[4 * f + k]] / 4;
        assert_near(heat[f], x, 0.1);
        assert_true(label[f] == 40 || label[f] == 41);
        if (fabs(x - 0.5) > 0.1) assert_true(label[f] == (x < 0.5 ? 40 : 41));
    }
    qc_object_release(out);
    qc_object_release(q);
    qc_object_release(in);
    qc_object_release(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(attributes_come_through),
        cmocka_unit_test(nothing_is_made_up),
        cmocka_unit_test(the_side_of_a_crease_counts),
        cmocka_unit_test(weights_sum_to_one),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
