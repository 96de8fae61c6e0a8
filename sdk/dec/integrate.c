/* Integration of a curl-free form to a potential by (1.12) of Kaelberer 2013: breadth first over
 * uncut edges, in the combed gauge f' = i^{face_turn} f. */
#include <math.h>

#include "sdk/dec/internal.h"

static qc_complex combed(const int8_t *face_turn, const qc_complex *z, int32_t h) {
    return face_turn ? qc_quarter_turn(z[h], face_turn[h / 3]) : z[h];
}

/* Corner values of face c / 3 from the value at corner c: halfedge k runs from corner k+1 to k+2.
 */
static void spread(const int8_t *face_turn, const qc_complex *z, int32_t c, qc_complex *f) {
    f[qc_next(c)] = qc__add(f[c], combed(face_turn, z, qc_prev(c)));
    f[qc_prev(c)] = qc__sub(f[c], combed(face_turn, z, qc_next(c)));
}

static bool is_open(const qc_mesh *m, const uint8_t *cut, int32_t h) {
    return m->twin[h] < 0 || (cut && cut[m->halfedge_edge[h]]);
}

static void integrate_patch(const qc_mesh *m, const uint8_t *cut, const int8_t *face_turn,
                            const qc_complex *z, int32_t root, uint8_t *seen, int32_t *queue,
                            qc_complex *f) {
    int32_t head = 0, tail = 0;
    f[3 * root] = (qc_complex){0, 0};
    spread(face_turn, z, 3 * root, f);
    seen[root] = 1;
    queue[tail++] = root;
    while (head < tail) {
        const int32_t t = queue[head++];
        for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
            if (is_open(m, cut, h) || seen[m->twin[h] / 3]) continue;
            const int32_t c = qc_prev(m->twin[h]); /* corner of the vertex where h starts */
            f[c] = f[qc_next(h)];
            spread(face_turn, z, c, f);
            seen[c / 3] = 1;
            queue[tail++] = c / 3;
        }
    }
}

static double mismatch(const qc_mesh *m, const uint8_t *cut, const qc_complex *f) {
    double largest = 0;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t h = m->edge_halfedge[2 * e], k = m->edge_halfedge[2 * e + 1];
        if (is_open(m, cut, h)) continue;
        const qc_complex a = qc__sub(f[qc_next(h)], f[qc_prev(k)]);
        const qc_complex b = qc__sub(f[qc_prev(h)], f[qc_next(k)]);
        largest = fmax(largest, fmax(hypot(a.re, a.im), hypot(b.re, b.im)));
    }
    return largest;
}

qc_status qc_form_integrate(qc_ctx *ctx, const qc_cover *cover, const uint8_t *cut,
                            const int8_t *face_turn, const qc_complex *z, qc_complex *f,
                            double *residual) {
    const qc_mesh *m = cover->mesh;
    uint8_t *seen = QC__ZERO(ctx, uint8_t, m->n_faces);
    int32_t *queue = QC__NEW(ctx, int32_t, m->n_faces);
    const qc_status status = seen && queue ? QC_OK : QC_ERR_NOMEM;
    for (int32_t t = 0; status == QC_OK && t < m->n_faces; t++)
        if (!seen[t]) integrate_patch(m, cut, face_turn, z, t, seen, queue, f);
    if (status == QC_OK && residual) *residual = mismatch(m, cut, f);
    qc__free(seen);
    qc__free(queue);
    return status;
}
