/* The explicit covering: counts, genus (Lemma 3.5), and deck transformations as automorphisms. */
#include "unit/cover/surfaces.h"

static void counts(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    qc_cover_info info;
    qc_mesh *q = NULL;
    int32_t *below = NULL;
    const qc_mesh *m = cover->mesh;
    assert_int_equal(qc_cover_get_info(ctx, cover, &info), QC_OK);
    assert_int_equal(qc_cover_mesh(ctx, cover, &q, &below), QC_OK);
    assert_int_equal(q->n_vertices, info.vertices);
    assert_int_equal(q->n_edges, info.edges);
    assert_int_equal(q->n_faces, info.faces);
    assert_int_equal(q->euler, info.euler);
    assert_int_equal(q->n_components, info.components);
    assert_int_equal(q->n_boundary_edges, 4 * m->n_boundary_edges);
    const bool closed = s->components == 1 && s->boundaries == 0;
    assert_int_equal(info.lemma_genus, closed ? q->genus : -1);
    if (kind == PLAIN || kind == GAUGE) assert_int_equal(q->n_components, 4 * m->n_components);
    if (closed && info.odd > 0) {
        assert_int_equal(q->n_components, 1);
        assert_int_equal(2 * q->genus, 8 * m->genus + 2 * info.even + 3 * info.odd - 6);
        /* 4 g + odd - 2 further loops are asymmetric. */
        assert_int_equal(2 * q->genus - info.symmetric_loops, 4 * m->genus + info.odd - 2);
    }
    for (int32_t c = 0; c < 3 * q->n_faces; c++) {
        const int32_t v = q->face_vertex[c];
        assert_int_equal(below[v], m->face_vertex[3 * (c / 12) + c % 3]);
        assert_int_equal(q->source_vertex[v], below[v]);
        assert_memory_equal(q->position + 3 * v, m->position + 3 * below[v], 3 * sizeof(double));
        if (q->twin[c] >= 0) {
            assert_int_equal(q->twin[q->twin[c]], c);
            assert_int_equal(qc_halfedge_start(q, c), qc_halfedge_end(q, q->twin[c]));
        }
    }
    assert_true(fabs(q->area - 4 * m->area) < 1e-12 * q->area);
    qc_cover_free_array(below);
    qc_object_release(q);
}

/* Deck transformations permute the sheets, commute with gluing and keep the surface below. */
static void deck(qc_ctx *ctx, const surface *s, const qc_cover *cover, int kind) {
    (void)s, (void)kind;
    qc_mesh *q = NULL;
    assert_int_equal(qc_cover_mesh(ctx, cover, &q, NULL), QC_OK);
    int32_t *by = NEW_ARRAY(int32_t, q->n_faces), *back = NEW_ARRAY(int32_t, q->n_faces);
    int32_t *image = NEW_ARRAY(int32_t, q->n_vertices);
    for (int32_t k = -1; k < 4; k++) {
        assert_int_equal(qc_cover_deck(ctx, cover, k, by), QC_OK);
        assert_int_equal(qc_cover_deck(ctx, cover, -k, back), QC_OK);
        for (int32_t v = 0; v < q->n_vertices; v++) image[v] = -1;
        for (int32_t t = 0; t < q->n_faces; t++) {
            assert_int_equal(back[by[t]], t);
            assert_int_equal(by[t] / 4, t / 4);
            if (k & 3) assert_int_not_equal(by[t], t);
            for (int32_t i = 0; i < 3; i++) {
                const int32_t twin = q->twin[3 * t + i], v = q->face_vertex[3 * t + i];
                const int32_t w = q->face_vertex[3 * by[t] + i];
                assert_int_equal(q->twin[3 * by[t] + i],
                                 twin < 0 ? -1 : 3 * by[twin / 3] + twin % 3);
                if (image[v] >= 0) assert_int_equal(image[v], w);
                image[v] = w;
            }
        }
    }
    free(by);
    free(back);
    free(image);
    qc_object_release(q);
}

/* A tetrahedron whose four corners are branch points: four edges join each pair of vertices. */
static void test_adjacent_branch_points(void **state) {
    (void)state;
    qc_ctx *ctx = new_context();
    const double position[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const int32_t face[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    qc_mesh *m = NULL, *q = NULL;
    assert_int_equal(qc_mesh_create(ctx, 4, position, 4, face, &m), QC_OK);
    const int8_t matching[6] = {0, 1, 0, 0, 0, 1}; /* edges (0, 1) and (2, 3) */
    const qc_cover cover = {m, matching};
    qc_cover_info info;
    assert_int_equal(qc_cover_get_info(ctx, &cover, &info), QC_OK);
    assert_int_equal(info.odd, 4);
    assert_int_equal(info.lemma_genus, 3);
    assert_int_equal(info.symmetric_loops, 4);
    assert_int_equal(qc_cover_mesh(ctx, &cover, &q, NULL), QC_OK);
    assert_int_equal(q->n_vertices, 4);
    assert_int_equal(q->n_edges, 24);
    assert_int_equal(q->genus, 3);
    double cotangent[48];
    assert_int_equal(qc_mesh_geometry(ctx, q, NULL, NULL, cotangent, NULL, NULL, NULL), QC_OK);
    qc_object_release(q);
    qc_object_release(m);
    qc_ctx_free(ctx);
}

static void test_counts(void **state) {
    (void)state, for_all_covers(counts);
}
static void test_deck(void **state) {
    (void)state, for_all_covers(deck);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_counts), cmocka_unit_test(test_deck),
                                       cmocka_unit_test(test_adjacent_branch_points)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
