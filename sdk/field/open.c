/* Cuts the stars of the vertices of positive integer index open: Algorithm 1 of the second paper,
 * lines 1 to 7, and its Figure 8.
 *
 * Before that the star is shrunk by rings of vertices on its edges. The poles then share no vertex
 * with each other or with the boundary, the cut is no larger than half a quad, and the growth of
 * the gradient towards the pole is resolved on coarse meshes, too (docs/theory/poles.md). */
#include "refine.h"

enum { MOST_RINGS = 20 };

typedef struct opener {
    qc_ctx *ctx;
    const qc_mesh *mesh;
    const qc_matching *matching;
    int32_t *rings;       /* n_vertices: rings around a pole, 0 elsewhere */
    double *ratio;        /* n_vertices: of the radii of one ring and the next */
    int32_t *ring_vertex; /* n_edges: first vertex on the edge of a star, counted inwards */
    int32_t *tip;         /* 3 n_faces: the tip at the corner of a pole */
    int32_t n_vertices, n_faces;
    int32_t largest; /* index which is opened */
} opener;

/* Inside, and on no hard feature. */
static bool is_pole(const qc_matching *matching, int32_t v) {
    const qc_mesh *mesh = matching->field->mesh;
    const int32_t index4 = matching->index4[v], first = mesh->vertex_corner[v];
    if (index4 <= 0 || index4 % 4 != 0 || qc_vertex_on_boundary(mesh, v)) return false;
    int32_t c = first;
    do {
        if (matching->axis && matching->axis[mesh->halfedge_edge[qc_next(c)]] >= 0) return false;
        c = qc_corner_ccw(mesh, c);
    } while (c != first);
    return true;
}

/* The corner of the pole in face t, -1 = none. */
static int32_t pole_corner(const opener *o, int32_t t) {
    for (int32_t c = 3 * t; c < 3 * t + 3; c++)
        if (o->rings[o->mesh->face_vertex[c]] > 0) return c;
    return -1;
}

static double distance(const qc_mesh *mesh, int32_t v, int32_t w) {
    double d[3];
    qc__sub(mesh->position + 3 * (size_t)v, mesh->position + 3 * (size_t)w, d);
    return sqrt(qc__dot3(d, d));
}

/* Rings of equal ratio, at least one half, from the star to two thirds of it or half a quad. */
static void choose_rings(opener *o, const qc_sizing *sizing, int32_t v) {
    const int32_t first = o->mesh->vertex_corner[v];
    double radius = 0, quad = 0;
    int32_t c = first, n = 0;
    do {
        radius += distance(o->mesh, v, o->mesh->face_vertex[qc_next(c)]);
        quad += sizing->length ? sizing->length[c / 3] : sizing->edge_length;
        n++;
        c = qc_corner_ccw(o->mesh, c);
    } while (c != first);
    double ratio = fmin(2.0 / 3.0, 0.5 * quad / radius);
    ratio = fmax(ratio, ldexp(1, -MOST_RINGS));
    o->rings[v] = (int32_t)ceil(-log2(ratio));
    o->ratio[v] = pow(ratio, 1.0 / o->rings[v]);
    o->n_vertices += n * (o->rings[v] + 1) - 1;
    o->n_faces += 2 * n * o->rings[v];
}

static qc_status find_poles(opener *o, const qc_sizing *sizing, int32_t *n_poles) {
    const qc_mesh *mesh = o->mesh;
    *n_poles = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (!is_pole(o->matching, v)) continue;
        if (o->matching->index4[v] / 4 > o->largest)
            return qc__fail(o->ctx, QC_ERR_FAILED, v,
                            "vertex %d has index %d: like 1/z the map would have no end of quads "
                            "around it; give the field vertices of index 1 or less there, or set "
                            "`largest` of qc.open and expect many quads",
                            (int)v, (int)o->matching->index4[v] / 4);
        choose_rings(o, sizing, v);
        (*n_poles)++;
    }
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t v = mesh->edge_vertex[2 * e], w = mesh->edge_vertex[2 * e + 1];
        if (o->rings[v] > 0 && o->rings[w] > 0)
            return qc__fail(o->ctx, QC_ERR_ARGUMENT, v,
                            "the vertices %d and %d of positive integer index are neighbours; run "
                            "qc.split before",
                            (int)v, (int)w);
    }
    return QC_OK;
}

/* Numbers and places the ring vertices and the tips of pole p; its lowest corner keeps its vertex.
 */
static void place_star(opener *o, qc__refiner *r, int32_t p, int32_t *next) {
    const qc_mesh *mesh = o->mesh;
    const double *x = mesh->position + 3 * (size_t)p;
    const int32_t first = mesh->vertex_corner[p];
    int32_t c = first, lowest = first;
    do {
        const double *y = mesh->position + 3 * (size_t)mesh->face_vertex[qc_next(c)];
        double scale = 1;
        o->ring_vertex[mesh->halfedge_edge[qc_prev(c)]] = *next;
        for (int32_t i = 0; i < o->rings[p]; i++, (*next)++) {
            scale *= o->ratio[p];
            for (size_t k = 0; k < 3; k++)
                r->position[3 * (size_t)*next + k] = x[k] + scale * (y[k] - x[k]);
            r->source_vertex[*next] = -1;
        }
        if (c < lowest) lowest = c;
        c = qc_corner_ccw(mesh, c);
    } while (c != first);
    do {
        o->tip[c] = c == lowest ? p : (*next)++;
        for (size_t k = 0; k < 3; k++) r->position[3 * (size_t)o->tip[c] + k] = x[k];
        r->source_vertex[o->tip[c]] = r->source_vertex[p];
        c = qc_corner_ccw(mesh, c);
    } while (c != first);
}

/* Vertex i rings inside the star on the edge of halfedge h, whose outer end is v. */
static int32_t ring_vertex(const opener *o, int32_t h, int32_t v, int32_t i) {
    return i == 0 ? v : o->ring_vertex[o->mesh->halfedge_edge[h]] + i - 1;
}

/* Two triangles for each ring, then the tip. With the pole at corner c the other corners are a, b.
 * edge: of qc_tangent_edges. */
static void add_sector(const opener *o, qc__refiner *r, const qc_complex *edge, int32_t c) {
    const int32_t t = c / 3, ha = qc_prev(c), hb = qc_next(c); /* pole to a, b to pole */
    const int32_t a = o->mesh->face_vertex[hb], b = o->mesh->face_vertex[ha];
    const int32_t rings = o->rings[o->mesh->face_vertex[c]];
    const qc__cplx inward = qc__c(edge[hb]), along = qc__c(edge[c]);
    for (int32_t i = 0; i < rings; i++) {
        const int32_t a0 = ring_vertex(o, ha, a, i), a1 = ring_vertex(o, ha, a, i + 1);
        const int32_t b0 = ring_vertex(o, hb, b, i), b1 = ring_vertex(o, hb, b, i + 1);
        qc__refiner_add(r, t, (int32_t[3]){a0, b0, b1}, (int32_t[3]){hb, -1, i == 0 ? c : -1},
                        inward);
        qc__refiner_add(r, t, (int32_t[3]){a0, b1, a1}, (int32_t[3]){-1, ha, -1}, -along);
    }
    qc__refiner_add(
        r, t, (int32_t[3]){o->tip[c], ring_vertex(o, ha, a, rings), ring_vertex(o, hb, b, rings)},
        (int32_t[3]){-1, hb, ha}, along);
}

static qc_status flag_tips(qc_ctx *ctx, const opener *o, qc_mesh *mesh) {
    uint8_t *tip = QC__ZERO(ctx, uint8_t, 3 * (int64_t)mesh->n_faces);
    uint8_t *is_tip = QC__ZERO(ctx, uint8_t, mesh->n_vertices);
    qc_status status = tip && is_tip ? QC_OK : QC_ERR_NOMEM;
    if (!status) {
        for (int32_t c = 0; c < 3 * o->mesh->n_faces; c++)
            if (o->tip[c] >= 0) is_tip[o->tip[c]] = 1;
        for (int32_t c = 0; c < 3 * mesh->n_faces; c++) tip[c] = is_tip[mesh->face_vertex[c]];
        status = qc_mesh_set_poles(ctx, mesh, tip);
    }
    qc__free(tip);
    qc__free(is_tip);
    return status;
}

static qc_status build(opener *o, qc__refinement *out) {
    const qc_mesh *mesh = o->mesh;
    qc__refiner r = {0};
    int32_t next = mesh->n_vertices;
    o->ring_vertex = QC__NEW(o->ctx, int32_t, mesh->n_edges);
    o->tip = QC__NEW(o->ctx, int32_t, 3 * (size_t)mesh->n_faces);
    qc_complex *edge = QC__NEW(o->ctx, qc_complex, 3 * (size_t)mesh->n_faces);
    qc_status status = edge && o->tip && o->ring_vertex ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_tangent_edges(o->ctx, mesh, edge);
    if (!status) status = qc__refiner_create(o->ctx, mesh, o->n_vertices, o->n_faces, &r);
    if (!status) {
        for (int32_t c = 0; c < 3 * mesh->n_faces; c++) o->tip[c] = -1;
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            if (o->rings[v] > 0) place_star(o, &r, v, &next);
        for (int32_t t = 0; t < mesh->n_faces; t++) {
            const int32_t c = pole_corner(o, t), *v = mesh->face_vertex + 3 * (size_t)t;
            if (c >= 0)
                add_sector(o, &r, edge, c);
            else
                qc__refiner_add(&r, t, v, (int32_t[3]){3 * t, 3 * t + 1, 3 * t + 2}, 0);
        }
        status = qc__refiner_finish(o->ctx, &r, out);
    }
    if (!status) status = flag_tips(o->ctx, o, out->mesh);
    qc__refiner_free(&r);
    qc__free(edge);
    return status;
}

/* The first tip of a pole has its number in the old mesh. */
static qc_status add_indices(qc_ctx *ctx, const qc_matching *old, qc_matching *matching) {
    const qc_mesh *mesh = matching->field->mesh;
    int32_t *index4 = QC__NEW(ctx, int32_t, mesh->n_poles);
    if (!index4) return QC_ERR_NOMEM;
    for (int32_t i = 0; i < mesh->n_poles; i++)
        index4[i] = old->index4[mesh->face_vertex[mesh->pole_corner[mesh->pole_start[i]]]];
    matching->pole_index4 = index4;
    matching->n_singular = old->n_singular;
    matching->index4_sum = old->index4_sum;
    return QC_OK;
}

static qc_status open_all(opener *o, const qc_matching *matching, const qc_sizing *sizing,
                          qc_mesh **mesh, qc_sizing **sizing_out, qc_matching **matching_out) {
    qc__refinement b = {NULL, NULL, NULL, NULL};
    qc_sizing *s = NULL;
    qc_matching *m = NULL;
    qc_status status = build(o, &b);
    if (!status) status = qc__refinement_carry(o->ctx, &b, matching, sizing, &m, &s);
    if (!status) status = add_indices(o->ctx, matching, m);
    if (!status) {
        *mesh = qc_object_retain(b.mesh);
        *sizing_out = s;
        *matching_out = m;
    } else {
        qc_object_release(s);
        qc_object_release(m);
    }
    qc__refinement_free(&b);
    return status;
}

qc_status qc_matching_open(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                           int32_t largest, qc_mesh **mesh, qc_sizing **sizing_out,
                           qc_matching **matching_out) {
    const qc_mesh *old = matching->field->mesh;
    if (sizing->mesh != old)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "the sizing and the matching are of different meshes");
    opener o = {.ctx = ctx,
                .mesh = old,
                .matching = matching,
                .n_vertices = old->n_vertices,
                .n_faces = old->n_faces,
                .largest = largest};
    int32_t n_poles = 0;
    o.rings = QC__ZERO(ctx, int32_t, old->n_vertices);
    o.ratio = QC__NEW(ctx, double, old->n_vertices);
    qc_status status = o.rings && o.ratio ? find_poles(&o, sizing, &n_poles) : QC_ERR_NOMEM;
    if (!status && n_poles == 0) {
        *mesh = qc_object_retain(old);
        *sizing_out = qc_object_retain(sizing);
        *matching_out = qc_object_retain(matching);
    } else if (!status) {
        status = open_all(&o, matching, sizing, mesh, sizing_out, matching_out);
    }
    qc__free(o.rings);
    qc__free(o.ratio);
    qc__free(o.ring_vertex);
    qc__free(o.tip);
    return status;
}
