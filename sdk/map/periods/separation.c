/* What must be kept apart, and the forms which measure it (see separation.h). */
#include "sdk/map/periods/separation.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void qc__separation_free(qc__separation *s) {
    if (!s) return;
    qc__free(s->vertex);
    qc__free(s->start);
    qc__free(s->variable);
    qc__free(s->value);
    qc__free(s);
}

/* Of a path to a feature: on coarse meshes the vertices of one beside a point lie askew. */
static const double least_slope = 0.7;

typedef struct bridge { /* mesh edge joining the cells of two sites */
    int32_t a, b, edge; /* a < b */
    double length;
} bridge;

typedef struct finder {
    qc_ctx *ctx;
    const qc__seams *seams;
    const int8_t *axis;
    const qc_complex *map;
    int32_t *site; /* n_vertices, -1: points by number, then pieces of features between them */
    double *distance;
    int32_t *predecessor; /* edge towards the site */
    int32_t *cell;        /* nearest site of a vertex, -1 */
    bridge *bridges;
    int64_t n_bridges, capacity;
    double _Complex *sum; /* n_free, dense accumulator of one form */
    int64_t value_capacity, variable_capacity, vertex_capacity, start_capacity;
} finder;

static int32_t other_end(const qc_mesh *mesh, int32_t edge, int32_t v) {
    const int32_t *ends = mesh->edge_vertex + 2 * (int64_t)edge;
    return ends[0] == v ? ends[1] : ends[0];
}

/* --- cells ------------------------------------------------------------------------------------ */

/* Pieces of features without the points between them become sites. */
static qc_status find_pieces(finder *f) {
    const qc_mesh *mesh = f->seams->mesh;
    int32_t *parent = QC__NEW(f->ctx, int32_t, mesh->n_vertices); /* -1: on no feature */
    if (!parent) return QC_ERR_NOMEM;
    memset(parent, -1, sizeof *parent * (size_t)mesh->n_vertices);
    for (int64_t i = 0; i < 2 * (int64_t)mesh->n_edges; i++)
        if (f->axis[i / 2] >= 0) parent[mesh->edge_vertex[i]] = mesh->edge_vertex[i];
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t a = mesh->edge_vertex[2 * (int64_t)e], b = mesh->edge_vertex[2 * (int64_t)e + 1];
        if (f->axis[e] < 0 || f->site[a] >= 0 || f->site[b] >= 0) continue;
        for (; parent[a] != a; a = parent[a]) parent[a] = parent[parent[a]];
        for (; parent[b] != b; b = parent[b]) parent[b] = parent[parent[b]];
        parent[a < b ? b : a] = a < b ? a : b;
    }
    int32_t n = f->seams->n_cones;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (parent[v] < 0 || f->site[v] >= 0) continue;
        int32_t root = v;
        while (parent[root] != root) root = parent[root];
        if (f->site[root] < 0) f->site[root] = n++;
        f->site[v] = f->site[root];
    }
    qc__free(parent);
    return QC_OK;
}

static qc_status grow_cells(finder *f) {
    const qc_mesh *mesh = f->seams->mesh;
    uint8_t *source = QC__NEW(f->ctx, uint8_t, mesh->n_vertices);
    if (!source) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < mesh->n_vertices; v++) source[v] = f->site[v] >= 0;
    const qc_status status =
        qc_mesh_shortest_paths(f->ctx, mesh, NULL, source, f->distance, f->predecessor);
    qc__free(source);
    if (status != QC_OK) return status;
    memcpy(f->cell, f->site, sizeof *f->cell * (size_t)mesh->n_vertices);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        int32_t root = v;
        while (f->cell[root] < 0 && f->predecessor[root] >= 0)
            root = other_end(mesh, f->predecessor[root], root);
        const int32_t cell = f->cell[root];
        for (int32_t w = v; f->cell[w] < 0 && f->predecessor[w] >= 0;
             w = other_end(mesh, f->predecessor[w], w))
            f->cell[w] = cell;
    }
    return QC_OK;
}

static int compare_bridges(const void *p, const void *q) {
    const bridge *x = p, *y = q;
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    if (x->b != y->b) return x->b < y->b ? -1 : 1;
    if (x->length != y->length) return x->length < y->length ? -1 : 1;
    return x->edge < y->edge ? -1 : x->edge > y->edge;
}

static double edge_length(const qc_mesh *mesh, int32_t e) {
    const double *p = mesh->position + 3 * (int64_t)mesh->edge_vertex[2 * (int64_t)e];
    const double *q = mesh->position + 3 * (int64_t)mesh->edge_vertex[2 * (int64_t)e + 1];
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

/* The shortest bridge of each pair of touching cells, one of them at least beyond the first ones.
 */
static qc_status find_bridges(finder *f, double reach, int32_t beyond) {
    const qc_mesh *mesh = f->seams->mesh;
    f->n_bridges = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t v = mesh->edge_vertex[2 * (int64_t)e];
        const int32_t w = mesh->edge_vertex[2 * (int64_t)e + 1];
        const int32_t a = f->cell[v], b = f->cell[w];
        if (a < 0 || b < 0 || a == b || (a < beyond && b < beyond)) continue;
        const double length = f->distance[v] + f->distance[w] + edge_length(mesh, e);
        if (!(length < reach)) continue;
        if (!qc__reserve(f->ctx, (void **)&f->bridges, &f->capacity, f->n_bridges + 1,
                         sizeof(bridge)))
            return QC_ERR_NOMEM;
        f->bridges[f->n_bridges++] = (bridge){a < b ? a : b, a < b ? b : a, e, length};
    }
    if (f->n_bridges == 0) return QC_OK;
    qsort(f->bridges, (size_t)f->n_bridges, sizeof(bridge), compare_bridges);
    int64_t kept = 0;
    for (int64_t i = 0; i < f->n_bridges; i++)
        if (i == 0 || f->bridges[i].a != f->bridges[kept - 1].a ||
            f->bridges[i].b != f->bridges[kept - 1].b)
            f->bridges[kept++] = f->bridges[i];
    f->n_bridges = kept;
    return QC_OK;
}

/* --- forms ------------------------------------------------------------------------------------ */

static void add_symbol(finder *f, int32_t symbol, double _Complex factor) {
    const qc__rows *rows = &f->seams->symbol_row;
    for (int64_t i = rows->start[symbol]; i < rows->start[symbol + 1]; i++)
        f->sum[rows->column[i]] += factor * rows->value[i];
}

static void add_translation(finder *f, int32_t segment, double _Complex factor) {
    add_symbol(f, qc__translation_symbol(segment, 0), factor);
    add_symbol(f, qc__translation_symbol(segment, 1), factor * I);
}

/* What is given of the value at corner c. */
static void add_corner(finder *f, int32_t c, int32_t turn, double _Complex sign) {
    const qc__seams *s = f->seams;
    const int32_t w = s->corner_wedge[c], row = 2 * s->vertex_given[s->mesh->face_vertex[c]];
    for (int32_t k = 0; k < 2; k++)
        for (int64_t i = s->given_start[row + k]; i < s->given_start[row + k + 1]; i++)
            add_symbol(f, s->given_symbol[i],
                       s->given_value[i] * qc__turn(k ? sign * I : sign, turn + s->wedge_turn[w]));
    for (int64_t i = s->wedge_start[w]; i < s->wedge_start[w + 1]; i++)
        add_translation(f, s->term_segment[i], qc__turn(sign, turn + s->term_turn[i]));
}

/* Turns corner c about its vertex, into the face where the edge `to` leaves or enters it, carrying
 * the chart; counter-clockwise, or clockwise when the boundary is in the way. */
static bool turn_to_edge(finder *f, qc__walk *walk, int32_t *c, int32_t to) {
    const qc_mesh *mesh = f->seams->mesh;
    for (int32_t way = 0; way < 2; way++) {
        int32_t at = *c;
        do {
            if (mesh->halfedge_edge[qc_next(at)] == to || mesh->halfedge_edge[qc_prev(at)] == to) {
                /* now carry the chart along the same way */
                while (*c != at) {
                    const int32_t h = way == 0 ? qc_next(*c) : qc_prev(*c);
                    if (!qc__walk_cross(f->ctx, f->seams, walk, h)) return false;
                    *c = way == 0 ? qc_corner_ccw(mesh, *c) : qc_corner_cw(mesh, *c);
                }
                return true;
            }
            at = way == 0 ? qc_corner_ccw(mesh, at) : qc_corner_cw(mesh, at);
        } while (at >= 0 && at != *c);
    }
    return true; /* not reached: every edge at a vertex lies in its fan */
}

/* Corner of vertex v in the face of corner c. */
static int32_t corner_in_face(const qc_mesh *mesh, int32_t c, int32_t v) {
    for (int32_t k = 0; k < 3; k++)
        if (mesh->face_vertex[3 * (c / 3) + k] == v) return 3 * (c / 3) + k;
    return -1;
}

/* Parts (1 re, 2 im, 3 both) of the value at corner c, in a chart `turn` before that of its face,
 * which are given. */
static int32_t given_parts(const qc__seams *s, int32_t c, int32_t turn) {
    const int32_t v = s->mesh->face_vertex[c], a = s->wedge_turn[s->corner_wedge[c]];
    int32_t parts = 0;
    for (int32_t k = 0; k < 2; k++)
        if (qc__seams_is_given(s, v, k)) parts |= 1 << ((k + a + turn) & 1);
    return parts;
}

/* Edges from a site to a site through the bridge: reversed to the first one, then on to the other.
 * Returns their number; *v is the first site. */
static int32_t find_path(const finder *f, const bridge *link, int32_t *v, int32_t *path) {
    const qc_mesh *mesh = f->seams->mesh;
    const int32_t *ends = mesh->edge_vertex + 2 * (int64_t)link->edge;
    const bool forward = f->cell[ends[0]] == link->a;
    int32_t n = 0;
    for (*v = ends[forward ? 0 : 1]; f->site[*v] < 0; n++) {
        path[n] = f->predecessor[*v];
        *v = other_end(mesh, path[n], *v);
    }
    for (int32_t i = 0, j = n - 1; i < j; i++, j--) {
        const int32_t swap = path[i];
        path[i] = path[j];
        path[j] = swap;
    }
    path[n++] = link->edge;
    for (int32_t w = ends[forward ? 1 : 0]; f->site[w] < 0; n++) {
        path[n] = f->predecessor[w];
        w = other_end(mesh, path[n], w);
    }
    return n;
}

/* Follows n edges from vertex `*v` to the last one, left in *v. The form f_b - f_a in the chart of
 * the first face, i^-turn (f_b - T) - f_a, is left in the sum; *parts tells which parts of it are
 * given, *way is the vector in the map. */
static qc_status develop(finder *f, const int32_t *path, int32_t n, qc__walk *walk, int32_t *v,
                         int32_t *parts, double _Complex *way) {
    const qc__seams *s = f->seams;
    const qc_mesh *mesh = s->mesh;
    walk->turn = walk->n = 0;
    int32_t c = corner_in_face(mesh, mesh->edge_halfedge[2 * (int64_t)path[0]], *v);
    *way = 0;
    add_corner(f, c, 0, -1.0);
    *parts = given_parts(s, c, 0);
    for (int32_t i = 0; i < n; i++) {
        if (i > 0 && !turn_to_edge(f, walk, &c, path[i])) return QC_ERR_NOMEM;
        *v = other_end(mesh, path[i], *v);
        const int32_t to = corner_in_face(mesh, c, *v);
        *way += qc__turn(qc__complex(f->map[to]) - qc__complex(f->map[c]), -walk->turn);
        c = to;
    }
    add_corner(f, c, -walk->turn, 1.0);
    for (int32_t i = 0; i < walk->n; i++)
        add_translation(f, walk->segment[i], -qc__turn(1.0, walk->term_turn[i] - walk->turn));
    *parts &= given_parts(s, c, walk->turn);
    return QC_OK;
}

/* The path from site a to site b through a bridge; it must not lead along a feature unless both are
 * points. */
static qc_status develop_bridge(finder *f, const bridge *link, qc__walk *walk, int32_t *path,
                                int32_t ends[2], int32_t *parts) {
    double _Complex way = 0;
    const int32_t n = find_path(f, link, &ends[0], path);
    ends[1] = ends[0];
    const qc_status status = develop(f, path, n, walk, &ends[1], parts, &way);
    if ((*parts == 1 && fabs(creal(way)) < least_slope * fabs(cimag(way))) ||
        (*parts == 2 && fabs(cimag(way)) < least_slope * fabs(creal(way))))
        *parts = 0;
    return status;
}

/* Appends the parts of the sum, unless they vanish, and clears it. */
static qc_status store_form(finder *f, qc__separation *s, const int32_t ends[2], int32_t parts) {
    const int64_t start = s->start[s->n];
    int64_t n = start;
    for (int32_t j = 0; j < f->seams->n_free; j++) {
        const double _Complex value =
            (parts & 1 ? creal(f->sum[j]) : 0) + (parts & 2 ? cimag(f->sum[j]) : 0) * I;
        f->sum[j] = 0;
        if (creal(value) == 0 && cimag(value) == 0) continue;
        if (!qc__reserve(f->ctx, (void **)&s->variable, &f->variable_capacity, n + 1,
                         sizeof *s->variable) ||
            !qc__reserve(f->ctx, (void **)&s->value, &f->value_capacity, n + 1, sizeof *s->value))
            return QC_ERR_NOMEM;
        s->variable[n] = j;
        s->value[n++] = value;
    }
    if (n == start && parts != 3) return QC_OK;
    s->vertex[2 * s->n] = ends[0];
    s->vertex[2 * s->n + 1] = ends[1];
    s->start[++s->n] = n;
    return QC_OK;
}

/* d = (1 - i) p, in units which make the shifts by less than four lines shorter than half. */
static qc_status make_pole_forms(finder *f, const int32_t *pole_index4, qc__separation *s) {
    static const double unit = 0.2;
    const qc__seams *seams = f->seams;
    qc_status status = QC_OK;
    for (int32_t i = 0; i < seams->n_poles && pole_index4 && status == QC_OK; i++) {
        if (pole_index4[seams->cone_pole[i]] != 4) continue;
        const int32_t p = qc__position_symbol(seams, seams->n_cones + i, 0);
        const int32_t none[2] = {-1, -1};
        add_symbol(f, p, unit * (1.0 - I));
        add_symbol(f, p + 1, unit * (1.0 + I));
        status = store_form(f, s, none, 3);
    }
    return status;
}

static qc_status reserve_forms(finder *f, qc__separation *s, int64_t n) {
    if (!qc__reserve(f->ctx, (void **)&s->vertex, &f->vertex_capacity, 2 * n + 1,
                     sizeof *s->vertex) ||
        !qc__reserve(f->ctx, (void **)&s->start, &f->start_capacity, n + 1, sizeof *s->start))
        return QC_ERR_NOMEM;
    if (s->n == 0) s->start[0] = 0;
    return QC_OK;
}

static qc_status make_forms(finder *f, qc__separation *s) {
    qc_status status = reserve_forms(f, s, s->n + f->n_bridges + f->seams->n_poles);
    if (status != QC_OK) return status;
    int32_t *path = QC__NEW(f->ctx, int32_t, f->seams->mesh->n_vertices + 1);
    qc__walk walk = {0};
    status = path ? QC_OK : QC_ERR_NOMEM;
    for (int64_t i = 0; i < f->n_bridges && status == QC_OK; i++) {
        int32_t ends[2], parts = 0;
        status = develop_bridge(f, &f->bridges[i], &walk, path, ends, &parts);
        if (status == QC_OK) status = store_form(f, s, ends, parts);
    }
    qc__walk_free(&walk);
    qc__free(path);
    return status;
}

/* --- along features --------------------------------------------------------------------------- */

/* A feature edge at v which is not used; -1 = none. */
static int32_t next_on_feature(const finder *f, const uint8_t *used, int32_t v) {
    const qc_mesh *mesh = f->seams->mesh;
    const int32_t first = mesh->vertex_corner[v];
    for (int32_t c = first;;) {
        const int32_t before = mesh->halfedge_edge[qc_prev(c)];
        const int32_t after = mesh->halfedge_edge[qc_next(c)];
        if (f->axis[before] >= 0 && !used[before]) return before;
        if (f->axis[after] >= 0 && !used[after]) return after;
        c = qc_corner_ccw(mesh, c);
        if (c < 0 || c == first) return -1;
    }
}

/* The piece of a feature which leaves v, up to the next point or back to v: kept when it is shorter
 * than the reach, as points which follow each other on a feature may each be nearer to a third. */
static qc_status separate_piece(finder *f, qc__separation *s, double reach, int32_t v,
                                uint8_t *used, int32_t *path, qc__walk *walk) {
    int32_t ends[2] = {v, v}, n = 0, parts = 0;
    double length = 0;
    double _Complex way = 0;
    for (int32_t w = v, e; (e = next_on_feature(f, used, w)) >= 0;) {
        used[e] = 1;
        path[n++] = e;
        length += edge_length(f->seams->mesh, e);
        w = other_end(f->seams->mesh, e, w);
        if (w == v || f->seams->vertex_cone[w] >= 0) break;
    }
    if (n == 0 || !(length < reach)) return QC_OK;
    qc_status status = reserve_forms(f, s, s->n + 1);
    if (status == QC_OK) status = develop(f, path, n, walk, &ends[1], &parts, &way);
    return status == QC_OK ? store_form(f, s, ends, 3) : status;
}

/* Pieces between points, then closed features without any. */
static qc_status separate_along(finder *f, qc__separation *s, double reach) {
    const qc__seams *seams = f->seams;
    const qc_mesh *mesh = seams->mesh;
    uint8_t *used = QC__ZERO(f->ctx, uint8_t, mesh->n_edges);
    int32_t *path = QC__NEW(f->ctx, int32_t, mesh->n_edges);
    qc__walk walk = {0};
    qc_status status = used && path ? QC_OK : QC_ERR_NOMEM;
    for (int32_t i = 0; i < seams->n_cones && status == QC_OK; i++) {
        const int32_t v = seams->cone_vertex[i];
        while (status == QC_OK && next_on_feature(f, used, v) >= 0)
            status = separate_piece(f, s, reach, v, used, path, &walk);
    }
    for (int32_t e = 0; e < mesh->n_edges && status == QC_OK; e++)
        if (f->axis[e] >= 0 && !used[e])
            status =
                separate_piece(f, s, reach, mesh->edge_vertex[2 * (int64_t)e], used, path, &walk);
    qc__walk_free(&walk);
    qc__free(used);
    qc__free(path);
    return status;
}

/* Pairs of points; then, with features, pairs of sites which are not both points. */
static qc_status find_pairs(finder *f, double reach, qc__separation *s) {
    const int32_t n_vertices = f->seams->mesh->n_vertices;
    f->sum = QC__ZERO(f->ctx, double _Complex, f->seams->n_free);
    f->site = QC__NEW(f->ctx, int32_t, n_vertices);
    f->distance = QC__NEW(f->ctx, double, n_vertices);
    f->predecessor = QC__NEW(f->ctx, int32_t, n_vertices);
    f->cell = QC__NEW(f->ctx, int32_t, n_vertices);
    if (!f->sum || !f->site || !f->distance || !f->predecessor || !f->cell) return QC_ERR_NOMEM;
    memcpy(f->site, f->seams->vertex_cone, sizeof *f->site * (size_t)n_vertices);
    qc_status status = QC_OK;
    for (int32_t pass = 0; pass < (f->axis ? 2 : 1) && status == QC_OK; pass++) {
        if (pass == 1) status = find_pieces(f);
        if (status == QC_OK) status = grow_cells(f);
        if (status == QC_OK) status = find_bridges(f, reach, pass == 1 ? f->seams->n_cones : 0);
        if (status == QC_OK) status = make_forms(f, s);
    }
    if (f->axis && status == QC_OK) status = separate_along(f, s, reach);
    if (status == QC_OK) status = reserve_forms(f, s, s->n + f->seams->n_poles);
    return status;
}

qc_status qc__separation_create(qc_ctx *ctx, const qc__seams *seams, const int8_t *axis,
                                const int32_t *pole_index4, const qc_complex *map, double reach,
                                qc__separation **out) {
    finder f = {.ctx = ctx, .seams = seams, .axis = axis, .map = map};
    qc__separation *s = QC__ZERO(ctx, qc__separation, 1);
    qc_status status = s ? find_pairs(&f, reach, s) : QC_ERR_NOMEM;
    if (status == QC_OK) status = make_pole_forms(&f, pole_index4, s);
    void *const blocks[] = {f.site, f.distance, f.predecessor, f.cell, f.bridges, f.sum};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    if (status != QC_OK) {
        qc__separation_free(s);
        return status;
    }
    *out = s;
    return QC_OK;
}
