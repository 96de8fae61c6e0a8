/* Shifts, corner turns and combing agree with the definition of the transition across an edge. */
#include "unit/cover/surfaces.h"

static void shifts_and_turns(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s;
    const qc_mesh *m = cover->mesh;
    int8_t *shift = NEW_ARRAY(int8_t, m->n_vertices), *turn = NEW_ARRAY(int8_t, 3 * m->n_faces);
    assert_int_equal(qc_cover_shifts(ctx, cover, shift), QC_OK);
    assert_int_equal(qc_cover_corner_turns(ctx, cover, turn), QC_OK);
    for (int32_t v = 0; v < m->n_vertices; v++) {
        assert_in_range(shift[v], 0, 3);
        if (kind == PLAIN || kind == GAUGE) assert_int_equal(shift[v], 0);
        if (kind == EVEN) assert_int_equal(shift[v] & 1, 0);
        if (qc_vertex_on_boundary(m, v)) assert_int_equal(shift[v], 0);
        assert_int_equal(turn[m->vertex_corner[v]], 0);
    }
    /* f_t = i^{-m} f_s at both ends of an edge; the fan of v closes up to its shift. */
    for (int32_t c = 0; c < 3 * m->n_faces; c++) {
        const int32_t next = qc_corner_ccw(m, c), v = m->face_vertex[c];
        if (next < 0) continue;
        const int32_t h = qc_next(c), jump = (turn[next] - turn[c] + qc_cover_turn(cover, h)) & 3;
        assert_int_equal(jump, next == m->vertex_corner[v] ? shift[v] : 0);
        assert_int_equal(qc_cover_turn(cover, h), -qc_cover_turn(cover, m->twin[h]));
    }
    free(shift);
    free(turn);
}

static void combing(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s;
    const qc_mesh *m = cover->mesh;
    int8_t *turn = NEW_ARRAY(int8_t, m->n_faces), *residual = NEW_ARRAY(int8_t, m->n_edges);
    uint8_t *trivial = NEW_ARRAY(uint8_t, m->n_components), *cut = NEW_ARRAY(uint8_t, m->n_edges);
    uint8_t *base = NEW_ARRAY(uint8_t, m->n_vertices);
    int8_t *shift = NEW_ARRAY(int8_t, m->n_vertices);
    for (int pass = 0; pass < 2; pass++) {
        assert_int_equal(qc_cover_comb(ctx, cover, pass ? cut : NULL, turn, residual, trivial),
                         QC_OK);
        int32_t flat = 0;
        for (int32_t e = 0; e < m->n_edges; e++) {
            const int32_t h = m->edge_halfedge[2 * e], k = m->edge_halfedge[2 * e + 1];
            flat += k >= 0 && residual[e] == 0;
            if (k < 0) {
                assert_int_equal(residual[e], 0);
                continue;
            }
            /* f' = i^turn f with f_t = i^{-m} f_s must satisfy f'_t = i^{-residual} f'_s. */
            const qc_complex fs = {1, 0};
            const qc_complex ft = qc_quarter_turn(fs, -(cover->matching ? cover->matching[e] : 0));
            const qc_complex a = qc_quarter_turn(ft, turn[k / 3]);
            const qc_complex b = qc_quarter_turn(fs, turn[h / 3] - residual[e]);
            assert_true(a.re == b.re && a.im == b.im);
            if (pass && !cut[e]) assert_int_equal(residual[e], 0);
        }
        assert_true(flat >= m->n_faces - m->n_components);
        if (kind == PLAIN || kind == GAUGE || pass) assert_int_equal(trivial[0], 1);
        /* Second pass: branch points on the cut, so that every component opens to a flat disk. */
        assert_int_equal(qc_cover_shifts(ctx, cover, shift), QC_OK);
        for (int32_t v = 0; v < m->n_vertices; v++) base[v] = shift[v] != 0;
        assert_int_equal(qc_mesh_cut_graph(ctx, m, NULL, base, cut), QC_OK);
    }
    free(turn);
    free(residual);
    free(trivial);
    free(cut);
    free(base);
    free(shift);
}

static void test_shifts(void **state) {
    (void)state, for_all_covers(shifts_and_turns);
}
static void test_comb(void **state) {
    (void)state, for_all_covers(combing);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shifts), cmocka_unit_test(test_comb)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
