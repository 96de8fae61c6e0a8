/* One face cut into the pieces in which the map of quantization is affine.
 *
 * Walking once around a face, just inside, the cursor passes through the pieces into which coarse
 * edges cut it. They cut it along chords, so the pieces form a tree and are met like brackets: an
 * edge which is crossed opens a piece, the same one crossed again closes it. */
#include "sdk/map/quantize/imprinter.h"

#include <string.h>

typedef qc__imprinter imprinter;
typedef qc__piece_node node;
typedef qc__piece piece;

/* The halfedge from corner k to the next one. */
static int32_t side_of(int32_t face, int k) {
    return 3 * face + (k + 2) % 3;
}

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
    qc__imprint_meet(&q->cursor, q->walk.corner[k], q->walk.corner[(k + 1) % 3], h, share);
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
    for (int32_t h = qc__imprint_exit(q, k); h >= 0; h = qc__imprint_exit(q, k), i++) {
        if (i >= start[1] - start[0]) return false;
        const node n = crossing_node(q, k, h, i);
        if (!push_node(q, &n) || !cross_chord(q, h)) return false;
    }
    node corner = {.vertex = q->map->mesh->face_vertex[3 * q->face + end]};
    corner.weight[end] = 1;
    memcpy(corner.uv, q->corner[end], sizeof corner.uv);
    if (i != start[1] - start[0] || !push_node(q, &corner)) return false;
    for (int32_t h = qc__imprint_turn(q, end); h >= 0; h = qc__imprint_turn(q, end))
        if (!cross_chord(q, h)) return false;
    return true;
}

bool qc__cut_face(imprinter *q, int32_t face) {
    qc__imprint_begin(q, face, 0);
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
