/* Chains of feature edges: gaps closed by hysteresis, noise and features which leave no room
 * dropped. A chain runs between vertices of feature degree other than 2, or round. */
#include "sdk/mesh/crease_scale.h"

enum { NAMED = 8 };

/* Strengths above every crease angle; means of equal ones are equal up to rounding. */
#define STRENGTH_DRAWN    10.0
#define STRENGTH_BOUNDARY 1000.0
/* Angle between two sides of a face below which a crease has no corner there. */
#define CORNER_MIN (75 * 3.14159265358979323846 / 180)

typedef struct chain {
    int32_t end[2];          /* vertices; equal when it is closed */
    int32_t first, n;        /* edges in order: n from `first` in the network's list */
    double length, strength; /* strength: of the edges, on average */
    bool drop, lost, won;
} chain;

typedef struct network {
    const qc_mesh *mesh;
    uint8_t *edge;                   /* n_edges flags                                            */
    double *crease, *length, *angle; /* n_edges, n_edges, 3 n_faces                             */
    int32_t *degree;                 /* n_vertices                                               */
    uint8_t *node;                   /* n_vertices: chains end there                             */
    int32_t *of;                     /* n_edges: chain, -1 = none                                */
    int32_t *list, n_list;           /* n_edges: edges by chain                                  */
    chain *chain;                    /* n_edges, n used                                          */
    int32_t n, named;
} network;

static void network_free(network *w) {
    void *arrays[] = {w->edge, w->crease, w->length, w->angle, w->degree,
                      w->node, w->of,     w->list,   w->chain};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) qc__free(arrays[i]);
}

static qc_status network_create(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge, network *w) {
    const size_t E = (size_t)mesh->n_edges;
    *w = (network){.mesh = mesh};
    w->edge = QC__NEW(ctx, uint8_t, E);
    w->crease = QC__NEW(ctx, double, E);
    w->length = QC__NEW(ctx, double, E);
    w->angle = QC__NEW(ctx, double, 3 * (size_t)mesh->n_faces);
    w->degree = QC__NEW(ctx, int32_t, mesh->n_vertices);
    w->node = QC__NEW(ctx, uint8_t, mesh->n_vertices);
    w->of = QC__NEW(ctx, int32_t, E);
    w->list = QC__NEW(ctx, int32_t, E);
    w->chain = QC__NEW(ctx, chain, E);
    if (!w->edge || !w->crease || !w->length || !w->angle || !w->degree || !w->node || !w->of ||
        !w->list || !w->chain)
        return QC_ERR_NOMEM;
    for (size_t e = 0; e < E; e++) w->edge[e] = edge[e];
    const qc_status status = qc__crease_angles(ctx, mesh, w->crease);
    return status ? status
                  : qc_mesh_geometry(ctx, mesh, w->length, NULL, NULL, w->angle, NULL, NULL);
}

static int32_t other_end(const qc_mesh *mesh, int32_t e, int32_t v) {
    return mesh->edge_vertex[2 * e] == v ? mesh->edge_vertex[2 * e + 1] : mesh->edge_vertex[2 * e];
}

/* Edges at v in order: start with *c = -1; -1 after the last. */
static int32_t next_edge(const qc_mesh *mesh, int32_t v, int32_t *c) {
    const int32_t first = mesh->vertex_corner[v];
    if (*c == -2) return -1;
    if (*c == -1) {
        *c = first;
        if (mesh->twin[qc_prev(first)] < 0) return mesh->halfedge_edge[qc_prev(first)];
    }
    const int32_t e = mesh->halfedge_edge[qc_next(*c)];
    *c = qc_corner_ccw(mesh, *c);
    if (*c < 0 || *c == first) *c = -2;
    return e;
}

static void count_degrees(network *w) {
    for (int32_t v = 0; v < w->mesh->n_vertices; v++) w->degree[v] = 0;
    for (int32_t e = 0; e < w->mesh->n_edges; e++)
        for (int i = 0; i < 2; i++) w->degree[w->mesh->edge_vertex[2 * e + i]] += w->edge[e] != 0;
}

static void edge_direction(const qc_mesh *mesh, int32_t e, int32_t from, double out[3]) {
    const double *p = mesh->position + 3 * (size_t)from;
    const double *q = mesh->position + 3 * (size_t)other_end(mesh, e, from);
    for (int i = 0; i < 3; i++) out[i] = q[i] - p[i];
}

/* Of degree other than 2, or where a feature turns back by more than 120 degrees. */
static bool is_node(const network *w, int32_t v) {
    double d[2][3];
    int n = 0;
    if (w->degree[v] != 2) return true;
    for (int32_t k = -1, e; (e = next_edge(w->mesh, v, &k)) >= 0;)
        if (w->edge[e]) edge_direction(w->mesh, e, v, d[n++]);
    const double product = d[0][0] * d[1][0] + d[0][1] * d[1][1] + d[0][2] * d[1][2];
    return product > 0.5 * qc__norm3(d[0]) * qc__norm3(d[1]);
}

static double strength_of(const network *w, int32_t e) {
    if (w->edge[e] & QC_FEATURE_BOUNDARY) return STRENGTH_BOUNDARY;
    return w->edge[e] & (QC_FEATURE_LINE | QC_FEATURE_GROUP) ? STRENGTH_DRAWN : w->crease[e];
}

/* The chain which leaves v over edge e. */
static void walk(network *w, int32_t v, int32_t e) {
    chain *c = &w->chain[w->n];
    *c = (chain){{v, v}, w->n_list, 0, 0, 0, false, false, false};
    while (e >= 0) {
        w->of[e] = w->n;
        w->list[w->n_list++] = e;
        c->n++;
        c->length += w->length[e];
        c->strength += w->length[e] * strength_of(w, e);
        c->end[1] = v = other_end(w->mesh, e, v);
        e = -1;
        if (!w->node[v])
            for (int32_t k = -1, f; (f = next_edge(w->mesh, v, &k)) >= 0;)
                if (w->edge[f] && w->of[f] < 0) e = f;
    }
    if (c->length > 0) c->strength /= c->length;
    w->n++;
}

static void find_chains(network *w) {
    const qc_mesh *mesh = w->mesh;
    count_degrees(w);
    for (int32_t v = 0; v < mesh->n_vertices; v++) w->node[v] = is_node(w, v);
    w->n = w->n_list = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) w->of[e] = -1;
    for (int closed = 0; closed < 2; closed++)
        for (int32_t e = 0; e < mesh->n_edges; e++)
            for (int i = 0; i < 2; i++) {
                const int32_t v = mesh->edge_vertex[2 * e + i];
                if (w->edge[e] && w->of[e] < 0 && (closed || w->node[v])) walk(w, v, e);
            }
}

qc_status qc_features_chains(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge, int32_t *of,
                             int32_t *n) {
    network w;
    qc_status status = network_create(ctx, mesh, edge, &w);
    if (status == QC_OK) {
        find_chains(&w);
        for (int32_t e = 0; e < mesh->n_edges; e++) of[e] = w.of[e];
        *n = w.n;
    }
    network_free(&w);
    return status;
}

qc_status qc_features_measure_chains(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge,
                                     qc_feature_chain *out) {
    network w;
    qc_status status = network_create(ctx, mesh, edge, &w);
    if (status == QC_OK) find_chains(&w);
    for (int32_t i = 0; status == QC_OK && i < w.n; i++) {
        const chain *c = &w.chain[i];
        qc_feature_chain o = {{c->end[0], c->end[1]}, c->n, 0, c->length, 0};
        for (int32_t j = c->first; j < c->first + c->n; j++) {
            o.kinds |= edge[w.list[j]];
            o.angle += w.length[w.list[j]] * w.crease[w.list[j]];
        }
        if (c->length > 0) o.angle /= c->length;
        out[i] = o;
    }
    network_free(&w);
    return status;
}

/* --- hysteresis ------------------------------------------------------------------------------- */

/* The sharpest weak edge at v which leads on from edge e within 60 degrees, -1 = none. */
static int32_t weak_edge(const network *w, double weak, int32_t v, int32_t e) {
    double in[3], out[3], best = weak;
    int32_t found = -1;
    edge_direction(w->mesh, e, v, in);
    for (int32_t k = -1, f; (f = next_edge(w->mesh, v, &k)) >= 0;) {
        if (f == e || w->edge[f] || w->of[f] >= 0 || !(w->crease[f] > best)) continue;
        edge_direction(w->mesh, f, v, out);
        const double product = in[0] * out[0] + in[1] * out[1] + in[2] * out[2];
        if (!(-product > 0.5 * qc__norm3(in) * qc__norm3(out))) continue;
        best = w->crease[f];
        found = f;
    }
    return found;
}

/* Follows weak edges from the free end v of edge e; they become a crease when another feature is
 * met. path: n_edges scratch. */
static void close_gap(network *w, double weak, int32_t v, int32_t e, int32_t *path) {
    int32_t n = 0;
    bool met = false;
    while (!met && (e = weak_edge(w, weak, v, e)) >= 0) {
        path[n++] = e;
        w->of[e] = 0; /* not twice */
        v = other_end(w->mesh, e, v);
        met = w->degree[v] > 0;
    }
    for (int32_t i = 0; i < n; i++) {
        w->of[path[i]] = -1;
        if (met) w->edge[path[i]] = QC_FEATURE_CREASE;
    }
}

static qc_status close_gaps(qc_ctx *ctx, network *w, double weak) {
    const qc_mesh *mesh = w->mesh;
    int32_t *path = QC__NEW(ctx, int32_t, mesh->n_edges);
    if (!path) return QC_ERR_NOMEM;
    count_degrees(w);
    for (int32_t e = 0; e < mesh->n_edges; e++) w->of[e] = -1;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (w->degree[v] != 1) continue;
        int32_t end = -1;
        for (int32_t k = -1, f; (f = next_edge(mesh, v, &k)) >= 0;)
            if (w->edge[f]) end = f;
        if (end >= 0 && w->edge[end] == QC_FEATURE_CREASE) close_gap(w, weak, v, end, path);
    }
    qc__free(path);
    return QC_OK;
}

/* --- shortcuts -------------------------------------------------------------------------------- */

/* A crease which takes two sides of a face, turning by more than 105 degrees, zigzags: it takes the
 * third one. */
static void cut_corners(network *w) {
    const qc_mesh *mesh = w->mesh;
    count_degrees(w);
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) {
        const int32_t a = mesh->halfedge_edge[qc_prev(c)], b = mesh->halfedge_edge[qc_next(c)];
        const int32_t across = mesh->halfedge_edge[c], v = mesh->face_vertex[c];
        if (w->edge[a] != QC_FEATURE_CREASE || w->edge[b] != QC_FEATURE_CREASE || w->edge[across] ||
            w->degree[v] != 2 || !(w->angle[c] < CORNER_MIN))
            continue;
        w->edge[a] = w->edge[b] = 0;
        w->edge[across] = QC_FEATURE_CREASE;
        w->degree[v] = 0;
    }
}

/* --- pruning ---------------------------------------------------------------------------------- */

/* Chains of creases along which the surface does not bend by `blunt` on average, as measured at the
 * scale of half a quad, once in so much of their length. */
static qc_status mark_blunt(qc_ctx *ctx, network *w, double half, double blunt) {
    qc__crease_scale *scale = NULL;
    const qc_status status = qc__crease_scale_create(ctx, w->mesh, half, &scale);
    for (int32_t i = 0; status == QC_OK && i < w->n; i++) {
        chain *c = &w->chain[i];
        double sum = 0, total = 0, since = INFINITY, bend = 0;
        for (int32_t j = c->first; j < c->first + c->n; j++) {
            const int32_t e = w->list[j];
            if (w->edge[e] != QC_FEATURE_CREASE) continue;
            if (since >= half) {
                bend = qc__crease_scale_at(scale, w->of, e);
                since = 0;
            }
            since += w->length[e];
            total += w->length[e];
            sum += w->length[e] * bend;
        }
        c->drop = sum < blunt * total;
    }
    qc__crease_scale_free(scale);
    return status;
}

static void mark_short(network *w, double least) {
    for (int32_t i = 0; i < w->n; i++) {
        chain *c = &w->chain[i];
        const bool round = c->end[0] == c->end[1] && !w->node[c->end[0]];
        const bool loose = w->degree[c->end[0]] == 1 || w->degree[c->end[1]] == 1;
        c->drop = c->strength < 0.999 * STRENGTH_DRAWN &&
                  ((round && c->length < 2 * least) || (loose && c->length < least));
    }
}

static int32_t input_number(const qc_mesh *mesh, int32_t v) {
    return mesh->source_vertex ? mesh->source_vertex[v] : v;
}

/* The edges before and after the sector from corner c on, and its angle; false when c begins none.
 */
static bool sector_at(const network *w, int32_t c, int32_t side[2], double *angle) {
    const qc_mesh *mesh = w->mesh;
    side[0] = mesh->halfedge_edge[qc_prev(c)];
    *angle = 0;
    if (!w->edge[side[0]]) return false;
    while (c >= 0) {
        *angle += w->angle[c];
        side[1] = mesh->halfedge_edge[qc_next(c)];
        if (w->edge[side[1]]) return side[0] != side[1];
        c = qc_corner_ccw(mesh, c);
    }
    return false;
}

/* Of the two chains at a sharp sector the weaker one loses; -1 = both are the boundary. */
static int32_t weaker(const network *w, const int32_t side[2]) {
    const int32_t a = w->of[side[0]], b = w->of[side[1]];
    const double sa = w->chain[a].strength, sb = w->chain[b].strength;
    if (fmin(sa, sb) > 0.999 * STRENGTH_BOUNDARY) return -1;
    return sa < sb || (!(sb < sa) && a > b) ? a : b;
}

/* A chain which is the stronger one elsewhere waits: what it lost against may go first. */
static void mark_sharp(qc_ctx *ctx, network *w, double sharp) {
    int32_t side[2];
    double angle;
    for (int32_t c = 0; c < 3 * w->mesh->n_faces; c++) {
        if (!sector_at(w, c, side, &angle) || !(angle < sharp)) continue;
        const int32_t i = weaker(w, side), j = w->of[side[0]] + w->of[side[1]] - i;
        if (i < 0) continue;
        w->chain[i].lost = true;
        if (j != i) w->chain[j].won = true;
    }
    for (int32_t c = 0; c < 3 * w->mesh->n_faces; c++) {
        if (!sector_at(w, c, side, &angle) || !(angle < sharp)) continue;
        const int32_t i = weaker(w, side);
        if (i < 0 || w->chain[i].won || w->chain[i].drop) continue;
        w->chain[i].drop = true;
        if (w->named++ >= NAMED) continue;
        qc__log(ctx, QC_LOG_WARNING,
                "feature from vertex %d to %d dropped: at vertex %d it meets another one in %.0f "
                "degrees, which leaves no room for quads",
                (int)input_number(w->mesh, w->chain[i].end[0]),
                (int)input_number(w->mesh, w->chain[i].end[1]),
                (int)input_number(w->mesh, w->mesh->face_vertex[c]), angle * 57.29577951308232);
    }
}

static int32_t drop_marked(network *w) {
    int32_t dropped = 0;
    for (int32_t e = 0; e < w->mesh->n_edges; e++)
        if (w->of[e] >= 0 && w->chain[w->of[e]].drop) w->edge[e] = 0;
    for (int32_t i = 0; i < w->n; i++) dropped += w->chain[i].drop;
    return dropped;
}

static qc_status prune(qc_ctx *ctx, network *w, double half, double blunt, double least,
                       double sharp) {
    int32_t dropped = 1, noise = 0;
    find_chains(w);
    qc_status status = mark_blunt(ctx, w, half, blunt);
    if (status != QC_OK) return status;
    noise += drop_marked(w);
    while (dropped > 0) {
        find_chains(w);
        mark_short(w, least);
        dropped = drop_marked(w);
        noise += dropped;
        if (dropped == 0) {
            mark_sharp(ctx, w, sharp);
            dropped = drop_marked(w);
        }
        if (!qc__progress(ctx, 0.5)) return QC_ERR_CANCELLED;
    }
    if (noise > 0) qc__log(ctx, QC_LOG_INFO, "%d short creases dropped", (int)noise);
    if (w->named > NAMED)
        qc__log(ctx, QC_LOG_WARNING, "%d more features dropped for the same reason",
                (int)w->named - NAMED);
    return QC_OK;
}

qc_status qc_features_prune(qc_ctx *ctx, const qc_mesh *mesh, double weak, double half,
                            double blunt, double least, double sharp, uint8_t *edge) {
    network w;
    qc_status status = network_create(ctx, mesh, edge, &w);
    if (status == QC_OK) status = close_gaps(ctx, &w, weak);
    if (status == QC_OK) cut_corners(&w);
    if (status == QC_OK) status = prune(ctx, &w, half, blunt, least, sharp);
    for (int32_t e = 0; status == QC_OK && e < mesh->n_edges; e++) edge[e] = w.edge[e];
    network_free(&w);
    return status;
}
