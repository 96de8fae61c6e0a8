/* Mirror images of results: a half and its image with the vertices on the plane in common, so that
 * they are one mesh which is symmetric by construction. */
#include <string.h>

#include "sdk/mesh/plane.h"
#include "sdk/remesh/symmetry.h"

/* In diagonals: boundary vertices which count as on the plane, where the boundary of a half is. */
static const double near_plane = 1e-7;

/* --- the border ------------------------------------------------------------------------------- */

/* Flags the vertices of the boundary on the plane; *arcs: how many more there are of them than of
 * edges between them, which is the number of arcs they form that are not closed. */
static void flag_border(const qc_polygon_mesh *m, const qc_plane *plane, double tolerance,
                        const qc__sides *sides, uint8_t *on, int32_t *arcs) {
    *arcs = 0;
    memset(on, 0, (size_t)m->n_vertices);
    for (int pass = 0; pass < 2; pass++)
        for (int32_t g = 0; g < sides->n_groups; g++) {
            const int32_t c = sides->order[sides->group[g]];
            const int32_t v[2] = {m->face_vertex[c], m->face_vertex[sides->next[c]]};
            if (sides->group[g + 1] - sides->group[g] != 1) continue;
            if (pass == 1 && on[v[0]] && on[v[1]]) --*arcs;
            for (int k = 0; k < 2 && pass == 0; k++) {
                const double d = qc__plane_distance(plane, m->position + 3 * (int64_t)v[k]);
                on[v[k]] = fabs(d) <= tolerance;
            }
        }
    for (int32_t v = 0; v < m->n_vertices; v++) *arcs += on[v];
}

static qc_status find_border(qc_ctx *ctx, const qc_polygon_mesh *m, const qc_plane *plane,
                             double tolerance, uint8_t *on, int32_t *arcs) {
    qc__sides sides = {0};
    const qc_status status = qc__sides_create(ctx, m, &sides);
    if (status == QC_OK) flag_border(m, plane, tolerance, &sides, on, arcs);
    qc__sides_free(&sides);
    return status;
}

static bool on_plane(const qc_mesh *half, const qc_plane *plane, int32_t v) {
    const double d = qc__plane_distance(plane, half->position + 3 * (int64_t)v);
    return qc_vertex_on_boundary(half, v) && fabs(d) <= near_plane * half->diagonal;
}

qc__border qc__border_of(const qc_mesh *half, const qc_plane *plane) {
    qc__border b = {near_plane * half->diagonal, 0};
    bool all = true;
    for (int32_t v = 0; v < half->n_vertices; v++) {
        b.arcs += on_plane(half, plane, v);
        all = all && (on_plane(half, plane, v) || !qc_vertex_on_boundary(half, v));
    }
    for (int32_t e = 0; e < half->n_edges; e++) b.arcs -= qc__on_border(half, plane, e);
    if (all) b.tolerance = INFINITY;
    return b;
}

bool qc__on_border(const qc_mesh *half, const qc_plane *plane, int32_t e) {
    const int32_t *v = half->edge_vertex + 2 * (int64_t)e;
    return half->edge_halfedge[2 * (int64_t)e + 1] < 0 && on_plane(half, plane, v[0]) &&
           on_plane(half, plane, v[1]);
}

/* --- both halves ------------------------------------------------------------------------------ */

/* number: of the images of vertices. */
static int32_t number_images(const qc_polygon_mesh *m, const uint8_t *on, int32_t *number) {
    int32_t n = m->n_vertices;
    for (int32_t v = 0; v < m->n_vertices; v++) number[v] = on[v] ? v : n++;
    return n;
}

/* Lines on the plane are where the halves were joined and no features. */
static bool keeps_line(const qc_polygon_mesh *m, const uint8_t *on, int32_t i) {
    return !on[m->line[2 * (int64_t)i]] || !on[m->line[2 * (int64_t)i + 1]];
}

static void fill_positions(const qc_polygon_mesh *m, const qc_plane *plane, const uint8_t *on,
                           const int32_t *number, qc_polygon_mesh *out) {
    for (int32_t v = 0; v < m->n_vertices; v++) {
        double *p = out->position + 3 * (int64_t)v;
        memcpy(p, m->position + 3 * (int64_t)v, 3 * sizeof *p);
        if (on[v])
            qc__flatten(plane, p);
        else
            qc__mirror_pair(plane, p, out->position + 3 * (int64_t)number[v]);
    }
}

/* Images turn the other way round, and u and v change places, which keeps integers and makes the
 * map positive again. */
static void fill_faces(const qc_polygon_mesh *m, const int32_t *number, qc_polygon_mesh *out) {
    const int32_t n = m->n_corners;
    for (int32_t f = 0; f < m->n_faces; f++) {
        const int32_t begin = m->face_offset[f], size = m->face_offset[f + 1] - begin;
        out->face_offset[f + 1] = begin + size;
        out->face_offset[m->n_faces + f + 1] = n + begin + size;
        for (int32_t k = 0; k < size; k++) {
            const int32_t from = begin + (size - k) % size;
            out->face_vertex[begin + k] = m->face_vertex[begin + k];
            out->face_vertex[n + begin + k] = number[m->face_vertex[from]];
            if (!m->corner_uv) continue;
            out->corner_uv[begin + k] = m->corner_uv[begin + k];
            out->corner_uv[n + begin + k] =
                m->corner_uv[from] < 0 ? -1 : m->n_uvs + m->corner_uv[from];
        }
    }
    for (int32_t i = 0; i < m->n_uvs; i++)
        for (int k = 0; k < 2; k++) {
            out->uv[2 * (int64_t)i + k] = m->uv[2 * (int64_t)i + k];
            out->uv[2 * (int64_t)(m->n_uvs + i) + k] = m->uv[2 * (int64_t)i + 1 - k];
        }
}

static void fill_lines(const qc_polygon_mesh *m, const uint8_t *on, const int32_t *number,
                       qc_polygon_mesh *out) {
    int32_t n = 0;
    for (int32_t i = 0; i < m->n_lines; i++) {
        if (!keeps_line(m, on, i)) continue;
        for (int k = 0; k < 2; k++) {
            const int32_t v = m->line[2 * (int64_t)i + k];
            out->line[4 * (int64_t)n + k] = v;
            out->line[4 * (int64_t)n + 2 + k] = number[v];
        }
        n++;
    }
    for (int32_t i = 0; out->source_edge && i < out->n_lines; i++) out->source_edge[i] = -1;
}

static qc_status join(qc_ctx *ctx, const qc_polygon_mesh *m, const qc_plane *plane,
                      const uint8_t *on, int32_t *number, qc_polygon_mesh **out) {
    const int32_t n = number_images(m, on, number);
    int32_t n_lines = 0;
    for (int32_t i = 0; i < m->n_lines; i++) n_lines += keeps_line(m, on, i);
    const qc_status status =
        qc_polygon_mesh_create(ctx, n, 2 * m->n_faces, 2 * m->n_corners, 2 * m->n_uvs, 2 * n_lines,
                               m->source_face ? QC_POLYGON_SOURCE : 0, out);
    if (status != QC_OK) return status;
    fill_positions(m, plane, on, number, *out);
    fill_faces(m, number, *out);
    fill_lines(m, on, number, *out);
    return QC_OK;
}

qc_status qc__mirror_polygons(qc_ctx *ctx, const qc_polygon_mesh *half, const qc_plane *plane,
                              const qc__border *border, qc_polygon_mesh **out) {
    uint8_t *on = QC__NEW(ctx, uint8_t, half->n_vertices);
    int32_t *number = QC__NEW(ctx, int32_t, half->n_vertices), found = 0;
    qc_polygon_mesh *both = NULL;
    qc_polygon_topology t;
    qc_status status = on && number ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = find_border(ctx, half, plane, border->tolerance, on, &found);
    if (status == QC_OK) status = join(ctx, half, plane, on, number, &both);
    if (status == QC_OK) status = qc_polygon_mesh_topology(ctx, both, &t);
    if (status == QC_OK &&
        (found != border->arcs || t.non_manifold_edges || t.non_manifold_vertices ||
         t.inconsistent_edges || t.duplicate_faces || t.degenerate_faces))
        status = qc__fail(ctx, QC_ERR_FAILED, t.first_bad_element,
                          "the quads of one half and their mirror image do not fit together");
    qc__free(on);
    qc__free(number);
    if (status == QC_OK)
        *out = both;
    else
        qc_object_release(both);
    return status;
}
