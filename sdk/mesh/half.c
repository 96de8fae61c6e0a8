/* qc_mesh_half: the part of a mesh on one side of a plane, cut along it. */
#include "sdk/mesh/plane.h"

/* Vertices nearer to the plane than this part of their shortest edge move onto it: cut edges would
 * leave slivers. */
static const double snap = 0.05;

typedef struct cut {
    const qc_mesh *mesh;
    const qc_plane *plane;
    double *distance;     /* n_vertices, 0 on the plane */
    int32_t *edge_vertex; /* n_edges: new vertex on it, -1 */
    int32_t *vertex;      /* n_vertices: its new number, -1 */
    int32_t n_vertices, n_faces;
    double *position; /* of the new vertices */
    int32_t *source_vertex, *face_vertex, *source_face;
} cut;

static qc_status measure(qc_ctx *ctx, cut *c) {
    const qc_mesh *m = c->mesh;
    double *shortest = QC__NEW(ctx, double, m->n_vertices);
    if (!shortest) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < m->n_vertices; v++) shortest[v] = INFINITY;
    for (int32_t e = 0; e < m->n_edges; e++) {
        double d[3];
        qc__halfedge_vector(m, m->edge_halfedge[2 * (int64_t)e], d);
        for (int i = 0; i < 2; i++) {
            const int32_t v = m->edge_vertex[2 * (int64_t)e + i];
            shortest[v] = fmin(shortest[v], qc__norm3(d));
        }
    }
    for (int32_t v = 0; v < m->n_vertices; v++) {
        const double d = qc__plane_distance(c->plane, m->position + 3 * (int64_t)v);
        c->distance[v] = fabs(d) <= fmax(snap * shortest[v], 1e-9 * m->diagonal) ? 0 : d;
    }
    qc__free(shortest);
    return QC_OK;
}

/* A plane which does not cut leaves nothing on one side. */
static qc_status check_sides(qc_ctx *ctx, const cut *c) {
    bool above = false, below = false;
    for (int32_t v = 0; v < c->mesh->n_vertices; v++) {
        above |= c->distance[v] > 0;
        below |= c->distance[v] < 0;
    }
    if (!above || !below)
        return qc__fail(ctx, QC_ERR_FAILED, -1, "the plane does not cut the surface");
    return QC_OK;
}

static void number_vertices(cut *c) {
    const qc_mesh *m = c->mesh;
    for (int32_t v = 0; v < m->n_vertices; v++) c->vertex[v] = -1;
    for (int32_t t = 0; t < m->n_faces; t++) { /* vertices on the plane only beside kept faces */
        const int32_t *v = m->face_vertex + 3 * (int64_t)t;
        const bool kept = c->distance[v[0]] > 0 || c->distance[v[1]] > 0 || c->distance[v[2]] > 0;
        for (int k = 0; k < 3; k++)
            if (kept && c->distance[v[k]] >= 0) c->vertex[v[k]] = 0;
    }
    for (int32_t v = 0; v < m->n_vertices; v++)
        if (c->vertex[v] == 0) c->vertex[v] = c->n_vertices++;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t *v = m->edge_vertex + 2 * (int64_t)e;
        const bool crosses = c->distance[v[0]] * c->distance[v[1]] < 0;
        c->edge_vertex[e] = crosses ? c->n_vertices++ : -1;
    }
}

static void place_vertices(cut *c) {
    const qc_mesh *m = c->mesh;
    for (int32_t v = 0; v < m->n_vertices; v++) {
        if (c->vertex[v] < 0) continue;
        double *x = c->position + 3 * (int64_t)c->vertex[v];
        for (int k = 0; k < 3; k++) x[k] = m->position[3 * (int64_t)v + k];
        if (c->distance[v] == 0) qc__flatten(c->plane, x);
        c->source_vertex[c->vertex[v]] = m->source_vertex ? m->source_vertex[v] : v;
    }
    for (int32_t e = 0; e < m->n_edges; e++) {
        if (c->edge_vertex[e] < 0) continue;
        const int32_t *v = m->edge_vertex + 2 * (int64_t)e;
        const double t = c->distance[v[0]] / (c->distance[v[0]] - c->distance[v[1]]);
        double *x = c->position + 3 * (int64_t)c->edge_vertex[e];
        for (int k = 0; k < 3; k++)
            x[k] = (1 - t) * m->position[3 * (int64_t)v[0] + k] +
                   t * m->position[3 * (int64_t)v[1] + k];
        qc__flatten(c->plane, x);
        c->source_vertex[c->edge_vertex[e]] = -1;
    }
}

static double distance(const cut *c, int32_t a, int32_t b) {
    const double *p = c->position + 3 * (int64_t)a, *q = c->position + 3 * (int64_t)b;
    const double d[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
    return qc__norm3(d);
}

static void add_face(cut *c, int32_t t, int32_t a, int32_t b, int32_t d) {
    int32_t *v = c->face_vertex + 3 * (int64_t)c->n_faces;
    v[0] = a;
    v[1] = b;
    v[2] = d;
    c->source_face[c->n_faces++] = c->mesh->source_face ? c->mesh->source_face[t] : t;
}

/* What is left of face t, a polygon of up to four corners, cut along the shorter diagonal. Of faces
 * in the plane, as the halves of a bent quad may be, nothing is: they are on neither side. */
static void clip_face(cut *c, int32_t t) {
    const int32_t *v = c->mesh->face_vertex + 3 * (int64_t)t;
    int32_t corner[4];
    int n = 0;
    if (!(c->distance[v[0]] > 0 || c->distance[v[1]] > 0 || c->distance[v[2]] > 0)) return;
    for (int k = 0; k < 3; k++) {
        const int32_t h = 3 * t + (k + 2) % 3; /* from corner k to the next */
        const int32_t on = c->edge_vertex[c->mesh->halfedge_edge[h]];
        if (c->distance[v[k]] >= 0) corner[n++] = c->vertex[v[k]];
        if (on >= 0) corner[n++] = on;
    }
    const bool other =
        n == 4 && distance(c, corner[1], corner[3]) < distance(c, corner[0], corner[2]);
    add_face(c, t, corner[0], corner[1], corner[other ? 3 : 2]);
    if (n == 4) add_face(c, t, corner[other ? 1 : 0], corner[2], corner[3]);
}

static qc_status build(qc_ctx *ctx, cut *c, qc_mesh **out) {
    const int64_t most = 2 * (int64_t)c->mesh->n_faces;
    number_vertices(c);
    c->position = QC__NEW(ctx, double, 3 * (int64_t)c->n_vertices);
    c->source_vertex = QC__NEW(ctx, int32_t, c->n_vertices);
    c->face_vertex = QC__NEW(ctx, int32_t, 3 * most);
    c->source_face = QC__NEW(ctx, int32_t, most);
    if (!c->position || !c->source_vertex || !c->face_vertex || !c->source_face)
        return QC_ERR_NOMEM;
    place_vertices(c);
    for (int32_t t = 0; t < c->mesh->n_faces; t++) clip_face(c, t);
    return qc_mesh_create_from(ctx, c->n_vertices, c->position, c->n_faces, c->face_vertex,
                               c->source_vertex, c->source_face, out);
}

qc_status qc_mesh_half(qc_ctx *ctx, const qc_mesh *mesh, const qc_plane *plane, qc_mesh **out) {
    cut c = {.mesh = mesh, .plane = plane};
    if (!(fabs(qc__norm3(plane->normal) - 1) < 1e-9) || !isfinite(plane->offset))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the normal of the plane is no unit vector");
    c.distance = QC__NEW(ctx, double, mesh->n_vertices);
    c.vertex = QC__NEW(ctx, int32_t, mesh->n_vertices);
    c.edge_vertex = QC__NEW(ctx, int32_t, mesh->n_edges);
    qc_status status = c.distance && c.vertex && c.edge_vertex ? measure(ctx, &c) : QC_ERR_NOMEM;
    if (status == QC_OK) status = check_sides(ctx, &c);
    if (status == QC_OK) status = build(ctx, &c, out);
    void *const blocks[] = {c.distance,      c.vertex,      c.edge_vertex, c.position,
                            c.source_vertex, c.face_vertex, c.source_face};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
