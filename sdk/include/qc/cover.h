/* qc/cover.h - the four-sheeted branched covering of a mesh induced by a matching (thesis 3.2.2).
 *
 * A cover is a view: a mesh and one int8 per edge; it owns and copies nothing. m_e is the number of
 * quarter turns from the face s (lower index) to t of edge e: x_t ~ i^m rho x_s, and layer l of s
 * meets layer l - m of t (docs/conventions.md). Boundary edges have m = 0.
 * Thread rule: everything here only reads the view. */
#ifndef QC_COVER_H
#define QC_COVER_H

#include <qc/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct qc_cover {
    const qc_mesh *mesh;
    const int8_t *matching; /* n_edges, any integers; NULL = trivial (four copies of the mesh) */
} qc_cover;

/* Quarter turns met when crossing halfedge h from its own face: +m from s to t, -m from t to s; 0
 * on the boundary. The value of a function in the gauge of the new face is i^{-turn} times the old
 * one. */
static inline int32_t qc_cover_turn(const qc_cover *c, int32_t h) {
    const int32_t e = c->mesh->halfedge_edge[h];
    if (!c->matching || c->mesh->twin[h] < 0) return 0;
    return c->mesh->edge_halfedge[2 * e] == h ? c->matching[e] : -c->matching[e];
}
/* Layer of the neighbour met from layer l of h's face. */
static inline int32_t qc_cover_layer(const qc_cover *c, int32_t h, int32_t layer) {
    return (layer - qc_cover_turn(c, h)) & 3;
}
/* z * i^k for any k. */
static inline qc_complex qc_quarter_turn(qc_complex z, int32_t k) {
    const qc_complex r0 = z, r1 = {-z.im, z.re}, r2 = {-z.re, -z.im}, r3 = {z.im, -z.re};
    switch (k & 3) {
    case 0:
        return r0;
    case 1:
        return r1;
    case 2:
        return r2;
    default:
        return r3;
    }
}

/* shift[v] (n_vertices): turns summed counter-clockwise about v, in 0..3; 0 on the boundary.
 * Non-zero = branch point (odd: one vertex above it; 2: two; 0: four). */
QC_API qc_status qc_cover_shifts(qc_ctx *ctx, const qc_cover *cover, int8_t *shift);

/* Gauge: corner_turn[c] (3 n_faces) with f_c = i^{corner_turn[c]} F_v, F_v the value in the face of
 * vertex_corner[v]. At branch points the walk does not close: the jump lies before
 * vertex_corner. */
QC_API qc_status qc_cover_corner_turns(qc_ctx *ctx, const qc_cover *cover, int8_t *corner_turn);

/* Combing: turns face_turn[t] in 0..3 such that faces joined by edges with cut[e] == 0 (cut NULL =
 * no cuts) agree when values in face t are multiplied by i^{face_turn[t]} (a cross x by
 * i^{-face_turn[t]}). residual[e] (n_edges, may be NULL) in 0..3 is the matching of the new gauge,
 *     residual = m_e + turn_s - turn_t mod 4,   f'_t = i^{-residual} f'_s + tau;
 * it is 0 on the spanning tree (breadth first from the lowest face of each patch, turn 0 there) and
 * on the boundary. trivial (n_components, may be NULL): 1 when it is 0 on every uncut interior
 * edge: with a cut which opens every component to a disk this holds always. */
QC_API qc_status qc_cover_comb(qc_ctx *ctx, const qc_cover *cover, const uint8_t *cut,
                               int8_t *face_turn, int8_t *residual, uint8_t *trivial);

typedef struct qc_cover_info {
    int32_t odd, even;  /* branch points by parity of their shift                              */
    int32_t components; /* of the covering                                                     */
    int32_t vertices, edges, faces, euler;
    /* Closed connected mesh: the sum of genera by Riemann and Hurwitz, components - euler / 2 with
     * euler = 4 chi - 2 even - 3 odd; 4 g + even + 3/2 odd - 3 for a connected covering (Lemma 3.5,
     * where 1/2 even is misprinted). -1 otherwise. */
    int32_t lemma_genus;
    int32_t symmetric_loops; /* (4.1): 4 g + 2 (even + odd) - 4; -1 without branch points or when
                                the mesh is not closed and connected */
} qc_cover_info;
/* Counted from the view, without building the covering. */
QC_API qc_status qc_cover_get_info(qc_ctx *ctx, const qc_cover *cover, qc_cover_info *info);

/* The covering as a mesh of its own: face 4 t + l lies on layer l above face t, corners and
 * halfedges keep their place in the face. Vertices are ordered by the vertex below; source_vertex
 * and source_face of the result are numbers of cover->mesh. Four edges may join the same two branch
 * points: use twins, never end points, to walk. *vertex_below (may be NULL) = source_vertex as an
 * array of the caller's; free it with qc_cover_free_array. Errors: ARGUMENT (more than 2^31 / 12
 * faces), NOMEM. */
QC_API qc_status qc_cover_mesh(qc_ctx *ctx, const qc_cover *cover, qc_mesh **out,
                               int32_t **vertex_below);
QC_API void qc_cover_free_array(void *array);
/* Deck transformation: layer l -> l + k of every face; deck (4 n_faces) is a permutation of the
 * faces of the covering. */
QC_API qc_status qc_cover_deck(qc_ctx *ctx, const qc_cover *cover, int32_t k, int32_t *deck);

/* Lifts a path of faces (face_path[i] and [i+1] share an edge; their lowest shared halfedge is
 * crossed) which starts on `layer`: layers (n). ARGUMENT with where = i when face_path[i] is no
 * face or shares no edge with the next one. */
QC_API qc_status qc_cover_lift(qc_ctx *ctx, const qc_cover *cover, int32_t n,
                               const int32_t *face_path, int32_t layer, int8_t *layers);
/* The symmetric loop of a path (thesis 4.2): the lift on `layer` followed by the reversed lift on
 * layer + 2; 2 n entries each in faces and layers. Shifted by two layers it is its own reversal. */
QC_API qc_status qc_cover_symmetric_loop(qc_ctx *ctx, const qc_cover *cover, int32_t n,
                                         const int32_t *face_path, int32_t layer, int32_t *faces,
                                         int8_t *layers);

#ifdef __cplusplus
}
#endif
#endif
