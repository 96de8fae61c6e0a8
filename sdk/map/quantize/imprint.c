/* Imprint: the common refinement of the mesh and its coarse complex, on which the map of
 * quantization is affine on every face, hence injective (docs/theory/quantization.md).
 *
 * Walking once around a face, just inside, the cursor passes through the pieces into which coarse
 * edges cut it. They cut it along chords, so the pieces form a tree and are met like brackets: an
 * edge which is crossed opens a piece, the same one crossed again closes it. */
#include "sdk/map/quantize/imprint.h"

#include <string.h>

/* A crossing nearer than that to an end of its edge (parameter units) becomes that end: the grid
 * of the map could not tell them apart. */
static const double nearest = 6e-5;

typedef struct node { /* a vertex on the boundary of a piece */
    int32_t vertex;
    double weight[3]; /* barycentric coordinates in the face */
    double uv[2];
} node;

typedef struct piece { /* opened, not yet closed */
    int32_t start;     /* of its nodes */
    int32_t way_back;  /* halfedge of the coarse complex through which it is left in the end */
} piece;

typedef struct imprinter {
    qc_ctx *ctx;
    const qc__exact_map *map;
    const qc__coarse_map *coarse;
    const qc__point *x;
    int32_t *edge_start; /* n_edges + 1: the crossings of an edge with coarse ones, ...  */
    double *share;       /* ... how far along edge_halfedge[2 e] they are, ... */
    int32_t *vertex;     /* ... and their vertices: near an end of the edge that one */
    double *place;       /* 2 each: their values */
    int32_t n_vertices;  /* of the refined mesh */
    qc_complex *edge;    /* 3 n_faces: tangent edges */
    qc__refiner refiner;
    double *uv;          /* 6 for each new face */
    double *weight;      /* 9 for each new face */
    double corner[3][2]; /* values of the corners of the face */
    node *node;
    piece *piece;
    int64_t n_nodes, node_capacity, n_pieces, piece_capacity;
    bool short_of_memory;
    int32_t face; /* whose boundary is walked */
    qc__face_walk walk;
    qc__cursor cursor;
} imprinter;

/* --- crossings of one edge -------------------------------------------------------------------- */

/* Where the line from a to b meets halfedge h: share of the line and of the halfedge. */
static void meet(const qc__cursor *k, qc__point a, qc__point b, int32_t h, double share[2]) {
    const qc__point p = qc__cursor_place(k, a), e = k->coarse->vector[h];
    const qc__point d = qc__minus(qc__cursor_place(k, b), p);
    const qc__point from = qc__minus(qc__corner_place(k->coarse->vector, h), p);
    const double area = qc__area_of(d, e);
    share[0] = qc__area_of(from, e) / area;
    share[1] = qc__area_of(from, d) / area;
}

/* From where the cursor looks at corner k: to the line towards the next corner. */
static int32_t turn_at(const imprinter *q, int k) {
    const qc__point *c = q->walk.corner;
    return qc__cursor_turn(&q->cursor, c[k], qc__minus(c[(k + 1) % 3], c[k]));
}

static int32_t exit_from(const imprinter *q, int k) {
    return qc__cursor_exit(&q->cursor, q->walk.corner[k], q->walk.corner[(k + 1) % 3]);
}

/* Begins at corner k, looking along the edge to the next one. */
static void begin_at(imprinter *q, int32_t face, int k) {
    q->face = face;
    q->walk = qc__face_walk_begin(q->map, q->coarse, q->x, face);
    q->cursor = qc__face_walk_to(&q->walk, k);
    for (int32_t h = turn_at(q, k); h >= 0; h = turn_at(q, k)) qc__cursor_cross(&q->cursor, h);
}

/* The halfedge from corner k to the next one. */
static int32_t side_of(int32_t face, int k) {
    return 3 * face + (k + 2) % 3;
}

static bool is_near(const double a[2], const double b[2]) {
    return hypot(a[0] - b[0], a[1] - b[1]) < nearest;
}

/* The crossings from..to of edge e, between the values a and b of its ends. */
static void name_crossings(imprinter *q, int32_t e, int32_t from, int32_t to, const double a[2],
                           const double b[2]) {
    const int32_t *end = q->map->mesh->edge_vertex + 2 * (int64_t)e;
    int32_t low = from, high = to;
    for (int32_t i = from; i < to; i++)
        if (is_near(q->place + 2 * (int64_t)i, a)) low = i + 1;
    for (int32_t i = to; i-- > low;)
        if (is_near(q->place + 2 * (int64_t)i, b)) high = i;
    for (int32_t i = from; i < to; i++) {
        q->vertex[i] = i < low ? end[0] : i < high ? q->n_vertices++ : end[1];
        q->share[i] = i < low ? 0 : i < high ? fmin(fmax(q->share[i], 0), 1) : 1;
    }
}

/* Counts the crossings of all edges, and, with q->share, tells where they are. */
static void find_crossings(imprinter *q) {
    const qc_mesh *m = q->map->mesh;
    int32_t n = 0;
    q->n_vertices = m->n_vertices;
    for (int32_t e = 0; e < m->n_edges; e++) {
        const int32_t h = m->edge_halfedge[2 * (int64_t)e];
        const int k = qc_next(h) % 3;
        double start[2], end[2];
        q->edge_start[e] = n;
        begin_at(q, h / 3, k);
        qc__cursor_value(&q->cursor, q->walk.corner[k], start);
        for (int32_t c = exit_from(q, k); c >= 0; c = exit_from(q, k), n++) {
            double share[2];
            meet(&q->cursor, q->walk.corner[k], q->walk.corner[(k + 1) % 3], c, share);
            if (q->share) {
                q->share[n] = share[0];
                qc__cursor_on_edge(&q->cursor, c, share[1], q->place + 2 * (int64_t)n);
            }
            qc__cursor_cross(&q->cursor, c);
        }
        qc__cursor_value(&q->cursor, q->walk.corner[(k + 1) % 3], end);
        if (q->share) name_crossings(q, e, q->edge_start[e], n, start, end);
    }
    q->edge_start[m->n_edges] = n;
}

/* --- the pieces of one face ------------------------------------------------------------------- */

/* Crossings which became a corner follow each other there: one node is left. */
static bool push_node(imprinter *q, const node *n) {
    const piece *last = &q->piece[q->n_pieces - 1];
    if (q->n_nodes > last->start && q->node[q->n_nodes - 1].vertex == n->vertex) return true;
    if (!qc__reserve(q->ctx, (void **)&q->node, &q->node_capacity, q->n_nodes + 1,
                     sizeof *q->node)) {
        q->short_of_memory = true;
        return false;
    }
    q->node[q->n_nodes++] = *n;
    return true;
}

static bool open_piece(imprinter *q, int32_t way_back) {
    if (!qc__reserve(q->ctx, (void **)&q->piece, &q->piece_capacity, q->n_pieces + 1,
                     sizeof *q->piece)) {
        q->short_of_memory = true;
        return false;
    }
    q->piece[q->n_pieces++] = (piece){(int32_t)q->n_nodes, way_back};
    return true;
}

static double area_of(const node *a, const node *b, const node *c) {
    return (b->uv[0] - a->uv[0]) * (c->uv[1] - a->uv[1]) -
           (b->uv[1] - a->uv[1]) * (c->uv[0] - a->uv[0]);
}

/* The corner of a convex polygon whose fan has the largest least triangle. */
static int32_t best_apex(const node *p, int32_t n) {
    double best = -INFINITY;
    int32_t apex = 0;
    for (int32_t i = 0; i < n; i++) {
        double least = INFINITY;
        for (int32_t j = 1; j + 1 < n; j++)
            least = fmin(least, area_of(&p[i], &p[(i + j) % n], &p[(i + j + 1) % n]));
        if (least <= best) continue;
        best = least;
        apex = i;
    }
    return apex;
}

static qc__cplx in_frame(const imprinter *q, const node *p) { /* from corner 1 */
    const qc_complex *e = q->edge + 3 * (int64_t)q->face;
    return p->weight[2] * qc__c(e[0]) - p->weight[0] * qc__c(e[2]);
}

/* The halfedge of the face which both nodes lie on; -1 = they are ends of a chord. */
static int32_t side_between(const imprinter *q, const node *a, const node *b) {
    for (int k = 0; k < 3; k++)
        if (a->weight[k] == 0 && b->weight[k] == 0) return 3 * q->face + k;
    return -1;
}

static void add_triangle(imprinter *q, const node *a, const node *b, const node *c) {
    const int32_t vertex[3] = {a->vertex, b->vertex, c->vertex};
    const int32_t side[3] = {side_between(q, b, c), side_between(q, c, a), side_between(q, a, b)};
    const node *corner[3] = {a, b, c};
    const qc__cplx direction = in_frame(q, c) - in_frame(q, b);
    const int32_t t = qc__refiner_add(&q->refiner, q->face, vertex, side, direction);
    for (int k = 0; k < 3; k++) {
        memcpy(q->uv + 6 * (int64_t)t + 2 * k, corner[k]->uv, sizeof corner[k]->uv);
        memcpy(q->weight + 9 * (int64_t)t + 3 * k, corner[k]->weight, sizeof corner[k]->weight);
    }
}

/* Triangulates the piece which was opened last, and drops it. */
static bool close_piece(imprinter *q) {
    const piece last = q->piece[--q->n_pieces];
    const node *p = q->node + last.start;
    int32_t n = (int32_t)q->n_nodes - last.start;
    while (n > 1 && p[n - 1].vertex == p[0].vertex) n--;
    if (n > 2 && q->refiner.n_faces + n - 2 > q->refiner.capacity) return false;
    const int32_t i = best_apex(p, n);
    for (int32_t j = 1; j + 1 < n; j++)
        add_triangle(q, &p[i], &p[(i + j) % n], &p[(i + j + 1) % n]);
    q->n_nodes = last.start;
    return true;
}

/* The cursor crosses h at the node which was pushed last. */
static bool cross_chord(imprinter *q, int32_t h) {
    node at = q->node[q->n_nodes - 1];
    const bool returns = q->n_pieces > 1 && q->piece[q->n_pieces - 1].way_back == h;
    const int32_t way_back = q->cursor.coarse->twin[h];
    qc__cursor_cross(&q->cursor, h);
    if (returns && !close_piece(q)) return false;
    if (!returns && !open_piece(q, way_back)) return false;
    return push_node(q, &at);
}

static void to_face_chart(const imprinter *q, double uv[2]) {
    const qc_complex z = qc_quarter_turn((qc_complex){uv[0], uv[1]}, -q->walk.turn);
    uv[0] = z.re;
    uv[1] = z.im;
}

/* The crossing number i of the side from corner k with coarse halfedge h. */
static node crossing_node(const imprinter *q, int k, int32_t h, int32_t i) {
    const qc_mesh *m = q->map->mesh;
    const int32_t side = side_of(q->face, k), e = m->halfedge_edge[side];
    const bool forward = m->edge_halfedge[2 * (int64_t)e] == side;
    const int32_t number = forward ? q->edge_start[e] + i : q->edge_start[e + 1] - 1 - i;
    node n = {.vertex = q->vertex[number]};
    double share[2];
    meet(&q->cursor, q->walk.corner[k], q->walk.corner[(k + 1) % 3], h, share);
    const double along = forward ? q->share[number] : 1 - q->share[number];
    n.weight[k] = 1 - along; /* exactly 0 or 1 where the vertex is an end */
    n.weight[(k + 1) % 3] = along;
    qc__cursor_on_edge(&q->cursor, h, share[1], n.uv);
    to_face_chart(q, n.uv);
    for (int j = 0; j < 3; j++)
        if (n.weight[j] == 1) memcpy(n.uv, q->corner[j], sizeof n.uv);
    return n;
}

/* Along the side from corner k, then about its end. */
static bool walk_side(imprinter *q, int k) {
    const int32_t *start = q->edge_start + q->map->mesh->halfedge_edge[side_of(q->face, k)];
    const int end = (k + 1) % 3;
    int32_t i = 0;
    for (int32_t h = exit_from(q, k); h >= 0; h = exit_from(q, k), i++) {
        if (i >= start[1] - start[0]) return false;
        const node n = crossing_node(q, k, h, i);
        if (!push_node(q, &n) || !cross_chord(q, h)) return false;
    }
    node corner = {.vertex = q->map->mesh->face_vertex[3 * q->face + end]};
    corner.weight[end] = 1;
    memcpy(corner.uv, q->corner[end], sizeof corner.uv);
    if (i != start[1] - start[0] || !push_node(q, &corner)) return false;
    for (int32_t h = turn_at(q, end); h >= 0; h = turn_at(q, end))
        if (!cross_chord(q, h)) return false;
    return true;
}

static bool cut_face(imprinter *q, int32_t face) {
    begin_at(q, face, 0);
    for (int k = 0; k < 3; k++) {
        const qc__cursor end = qc__face_walk_to(&q->walk, k);
        qc__cursor_value(&end, q->walk.corner[k], q->corner[k]);
        to_face_chart(q, q->corner[k]);
    }
    q->n_nodes = q->n_pieces = 0;
    if (!open_piece(q, -1)) return false;
    for (int k = 0; k < 3; k++)
        if (!walk_side(q, k)) return false;
    return q->n_pieces == 1 && close_piece(q);
}

/* --- the refined map -------------------------------------------------------------------------- */

static void place_vertices(imprinter *q) {
    const qc_mesh *m = q->map->mesh;
    for (int32_t e = 0; e < m->n_edges; e++)
        for (int32_t i = q->edge_start[e]; i < q->edge_start[e + 1]; i++) {
            const int32_t v = q->vertex[i];
            if (v < m->n_vertices) continue;
            const double *a = m->position + 3 * (int64_t)m->edge_vertex[2 * (int64_t)e];
            const double *b = m->position + 3 * (int64_t)m->edge_vertex[2 * (int64_t)e + 1];
            for (int j = 0; j < 3; j++)
                q->refiner.position[3 * (int64_t)v + j] = a[j] + q->share[i] * (b[j] - a[j]);
            q->refiner.source_vertex[v] = -1;
        }
}

static int32_t count_faces(const imprinter *q) {
    const qc_mesh *m = q->map->mesh;
    int32_t n = m->n_faces;
    for (int32_t e = 0; e < m->n_edges; e++)
        n += (q->edge_start[e + 1] - q->edge_start[e]) *
             (m->edge_halfedge[2 * (int64_t)e + 1] < 0 ? 1 : 2);
    return n;
}

static qc_status prepare(imprinter *q) {
    const qc_mesh *m = q->map->mesh;
    q->edge_start = QC__NEW(q->ctx, int32_t, m->n_edges + 1);
    q->edge = QC__NEW(q->ctx, qc_complex, 3 * (int64_t)m->n_faces);
    if (!q->edge_start || !q->edge) return QC_ERR_NOMEM;
    qc_status status = qc_tangent_edges(q->ctx, m, q->edge);
    if (status != QC_OK) return status;
    find_crossings(q);
    const int32_t n = q->edge_start[m->n_edges];
    q->share = QC__NEW(q->ctx, double, n);
    q->place = QC__NEW(q->ctx, double, 2 * (int64_t)n);
    q->vertex = QC__NEW(q->ctx, int32_t, n);
    if (!q->share || !q->place || !q->vertex) return QC_ERR_NOMEM;
    find_crossings(q);
    const int32_t n_faces = count_faces(q);
    q->uv = QC__NEW(q->ctx, double, 6 * (int64_t)n_faces);
    q->weight = QC__NEW(q->ctx, double, 9 * (int64_t)n_faces);
    if (!q->uv || !q->weight) return QC_ERR_NOMEM;
    status = qc__refiner_create(q->ctx, m, q->n_vertices, n_faces, &q->refiner);
    if (status == QC_OK) place_vertices(q);
    return status;
}

static qc_status cut_faces(imprinter *q) {
    for (int32_t t = 0; t < q->map->mesh->n_faces; t++) {
        if (t % 4096 == 0 && !qc__progress(q->ctx, (double)t / q->map->mesh->n_faces))
            return QC_ERR_CANCELLED;
        if (cut_face(q, t)) continue;
        if (q->short_of_memory) return QC_ERR_NOMEM;
        return qc__fail(q->ctx, QC_ERR_FAILED, t, "face %d is not cut along chords", (int)t);
    }
    return QC_OK;
}

void qc__imprint_free(qc__imprint *imprint) {
    qc_object_release(imprint->mesh);
    void *const blocks[] = {imprint->uv,     imprint->rotation, imprint->axis,
                            imprint->parent, imprint->weight,   imprint->turn};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    *imprint = (qc__imprint){0};
}

/* Parts of an edge inherit its transition and its feature; chords have none. */
static qc_status publish(imprinter *q, qc__imprint *out) {
    qc__refinement made;
    qc_status status = qc__refiner_finish(q->ctx, &q->refiner, &made);
    if (status != QC_OK) return status;
    const qc__exact_map *map = q->map;
    const int32_t n = made.mesh->n_edges;
    int8_t *rotation = QC__NEW(q->ctx, int8_t, n);
    int8_t *axis = map->axis ? QC__NEW(q->ctx, int8_t, n) : NULL;
    if (!rotation || (map->axis && !axis)) {
        qc__free(rotation);
        qc__free(axis);
        qc__refinement_free(&made);
        return QC_ERR_NOMEM;
    }
    for (int32_t e = 0; e < n; e++) {
        const int32_t h = made.parent_halfedge[made.mesh->edge_halfedge[2 * (int64_t)e]];
        rotation[e] = h < 0 ? 0 : map->rotation[map->mesh->halfedge_edge[h]];
        if (axis) axis[e] = h < 0 ? -1 : map->axis[map->mesh->halfedge_edge[h]];
    }
    *out = (qc__imprint){made.mesh, q->uv, rotation, axis, made.parent, q->weight, made.turn};
    q->uv = q->weight = NULL;
    qc__free(made.parent_halfedge);
    return QC_OK;
}

qc_status qc__imprint_create(qc_ctx *ctx, const qc__exact_map *map, const qc__coarse_map *coarse,
                             const qc__point *x, qc__imprint *out) {
    imprinter q = {.ctx = ctx, .map = map, .coarse = coarse, .x = x};
    qc_status status = prepare(&q);
    if (status == QC_OK) status = cut_faces(&q);
    if (status == QC_OK) status = publish(&q, out);
    qc__refiner_free(&q.refiner);
    void *const blocks[] = {q.edge_start, q.share,  q.vertex, q.place, q.edge,
                            q.uv,         q.weight, q.node,   q.piece};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}
