/* Closes the holes of poles (docs/theory/poles.md): a ring of 2 k sides r_0, r_1, ... gets a vertex
 * p at the pole and the k quads (p, r_2i, r_2i+1, r_2i+2), or those from r_1 on: those with the
 * better worst corner. */
#include <math.h>
#include <string.h>

#include "sdk/map/extract/pole_rings.h"
#include "sdk/mesh/internal.h"

/* Corner k of quad i of a pole: -1 = the pole. The ring runs the other way round than the quads
 * beside it see it. */
static int32_t quad_corner(const qc__pole_rings *r, int32_t pole, bool odd, int32_t i, int k) {
    const int32_t n = r->start[pole + 1] - r->start[pole];
    if (k == 0) return -1;
    return r->ring[r->start[pole] + (2 * n - 2 * i - k - odd) % n];
}

/* Least scaled Jacobian of the quads of a pole. */
static double worst(const qc__pole_rings *r, int32_t pole, bool odd) {
    static const int32_t corner[4] = {0, 1, 2, 3};
    double least = 1, x[12];
    memcpy(x, qc__pole_position(r, pole), 3 * sizeof *x);
    for (int32_t i = 0; 2 * i < r->start[pole + 1] - r->start[pole]; i++) {
        for (int k = 1; k < 4; k++)
            memcpy(x + 3 * k, qc__ring_position(r, quad_corner(r, pole, odd, i, k)), 3 * sizeof *x);
        least = fmin(least, qc__scaled_jacobian(x, corner, 4));
    }
    return least;
}

/* --- the closed mesh -------------------------------------------------------------------------- */

/* Kept vertices in their order, then the poles. number: of the vertices of q. */
static void copy_vertices(const qc__pole_rings *r, int32_t *number, qc_polygon_mesh *out) {
    const qc_mesh *m = qc__rings_mesh(r);
    int32_t n = 0;
    for (int32_t v = 0; v < r->q->n_vertices; v++) {
        if (number[v] < 0) continue;
        for (int k = 0; k < 3; k++) {
            out->position[3 * (int64_t)n + k] = qc__ring_position(r, v)[k];
            out->source_barycentric[3 * (int64_t)n + k] =
                r->q->source_barycentric[3 * (int64_t)v + k];
        }
        out->source_face[n] = r->q->source_face[v];
        number[v] = n++;
    }
    for (int32_t i = 0; i < m->n_poles; i++, n++) {
        const int32_t tip = m->pole_corner[m->pole_start[i]];
        for (int k = 0; k < 3; k++) {
            out->position[3 * (int64_t)n + k] = qc__pole_position(r, i)[k];
            out->source_barycentric[3 * (int64_t)n + k] = k == tip % 3;
        }
        out->source_face[n] = tip / 3;
    }
}

static void copy_faces(const qc__pole_rings *r, const uint8_t *odd, const int32_t *number,
                       qc_polygon_mesh *out) {
    const qc_mesh *m = qc__rings_mesh(r);
    const qc__cells *c = r->cells;
    int32_t n = 0;
    for (int32_t cell = 0; cell < c->n; cell++) {
        if (!c->keep[cell] || r->drop[cell]) continue;
        for (int k = 0; k < 4; k++)
            out->face_vertex[n++] = number[r->vertex[4 * (int64_t)cell + k]];
    }
    for (int32_t i = 0; i < m->n_poles; i++)
        for (int32_t j = 0; 2 * j < r->start[i + 1] - r->start[i]; j++)
            for (int k = 0; k < 4; k++) {
                const int32_t v = quad_corner(r, i, odd[i], j, k);
                out->face_vertex[n++] = v < 0 ? out->n_vertices - m->n_poles + i : number[v];
            }
    for (int32_t f = 0; f <= out->n_faces; f++) out->face_offset[f] = 4 * f;
}

/* Lines both of whose ends stay. */
static int32_t copy_lines(const qc__pole_rings *r, const int32_t *number, qc_polygon_mesh *out) {
    int32_t n = 0;
    for (int32_t i = 0; i < r->q->n_lines; i++) {
        const int32_t v = number[r->q->line[2 * (int64_t)i]];
        const int32_t w = number[r->q->line[2 * (int64_t)i + 1]];
        if (v < 0 || w < 0) continue;
        if (out) {
            out->line[2 * (int64_t)n] = v;
            out->line[2 * (int64_t)n + 1] = w;
            out->source_edge[n] = r->q->source_edge[i];
        }
        n++;
    }
    return n;
}

/* odd: n_poles, quads begin with the second vertex of the ring. */
static qc_status build(const qc__pole_rings *r, const uint8_t *odd, qc_polygon_mesh **out) {
    const qc_mesh *m = qc__rings_mesh(r);
    const qc__cells *c = r->cells;
    int32_t *number = QC__NEW(r->ctx, int32_t, r->q->n_vertices);
    if (!number) return QC_ERR_NOMEM;
    int32_t n_vertices = m->n_poles, n_faces = r->start[m->n_poles] / 2;
    for (int32_t v = 0; v < r->q->n_vertices; v++) number[v] = -1;
    for (int32_t cell = 0; cell < c->n; cell++) {
        if (!c->keep[cell] || r->drop[cell]) continue;
        n_faces++;
        for (int k = 0; k < 4; k++) {
            int32_t *v = &number[r->vertex[4 * (int64_t)cell + k]];
            n_vertices += *v < 0;
            *v = 0;
        }
    }
    qc_polygon_mesh *q = NULL;
    const qc_status status =
        qc_polygon_mesh_create(r->ctx, n_vertices, n_faces, 4 * n_faces, 0,
                               copy_lines(r, number, NULL), QC_POLYGON_SOURCE, &q);
    if (status == QC_OK) {
        copy_vertices(r, number, q);
        copy_lines(r, number, q);
        copy_faces(r, odd, number, q);
        *out = q;
    }
    qc__free(number);
    return status;
}

qc_status qc__close_poles(qc_ctx *ctx, const qc__cells *cells, const int32_t *vertex,
                          qc_polygon_mesh **quads) {
    qc__pole_rings r;
    qc_polygon_mesh *closed = NULL;
    qc_status status = qc__pole_rings_create(ctx, cells, vertex, *quads, &r);
    const int32_t n_poles = qc__rings_mesh(&r)->n_poles;
    uint8_t *odd = QC__NEW(ctx, uint8_t, n_poles);
    if (status == QC_OK && !odd) status = QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t i = 0; i < n_poles; i++) odd[i] = worst(&r, i, true) > worst(&r, i, false);
        status = build(&r, odd, &closed);
    }
    if (status == QC_OK) {
        qc_object_release(*quads);
        *quads = closed;
    }
    qc__free(odd);
    qc__pole_rings_free(&r);
    return status;
}
