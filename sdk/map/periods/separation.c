/* Which cones must be kept apart, and the forms which measure it (see separation.h). */
#include "sdk/map/periods/separation.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void qc__separation_free(qc__separation *s) {
    if (!s) return;
    qc__free(s->cone);
    qc__free(s->start);
    qc__free(s->variable);
    qc__free(s->value);
    qc__free(s);
}

typedef struct bridge { /* mesh edge joining the cells of two cones */
    int32_t a, b, edge; /* a < b */
    double length;
} bridge;

typedef struct finder {
    qc_ctx *ctx;
    const qc__seams *seams;
    double *distance;
    int32_t *predecessor; /* edge towards the cone */
    int32_t *cell;        /* nearest cone of a vertex, -1 */
    bridge *bridges;
    int64_t n_bridges, capacity;
    double _Complex *sum; /* n_free, dense accumulator of one form */
    int64_t value_capacity, variable_capacity;
} finder;

static int32_t other_end(const qc_mesh *mesh, int32_t edge, int32_t v) {
    const int32_t *ends = mesh->edge_vertex + 2 * (int64_t)edge;
    return ends[0] == v ? ends[1] : ends[0];
}

/* --- cells ------------------------------------------------------------------------------------ */

static qc_status grow_cells(finder *f) {
    const qc__seams *s = f->seams;
    const qc_mesh *mesh = s->mesh;
    uint8_t *source = QC__ZERO(f->ctx, uint8_t, mesh->n_vertices);
    f->distance = QC__NEW(f->ctx, double, mesh->n_vertices);
    f->predecessor = QC__NEW(f->ctx, int32_t, mesh->n_vertices);
    f->cell = QC__NEW(f->ctx, int32_t, mesh->n_vertices);
    qc_status status = source && f->distance && f->predecessor && f->cell ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        for (int32_t i = 0; i < s->n_cones; i++) source[s->cone_vertex[i]] = 1;
        status = qc_mesh_shortest_paths(f->ctx, mesh, NULL, source, f->distance, f->predecessor);
    }
    qc__free(source);
    if (status != QC_OK) return status;
    for (int32_t v = 0; v < mesh->n_vertices; v++) f->cell[v] = s->vertex_cone[v];
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

/* The shortest bridge of each pair of touching cells. */
static qc_status find_bridges(finder *f, double reach) {
    const qc_mesh *mesh = f->seams->mesh;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t v = mesh->edge_vertex[2 * (int64_t)e];
        const int32_t w = mesh->edge_vertex[2 * (int64_t)e + 1];
        const int32_t a = f->cell[v], b = f->cell[w];
        if (a < 0 || b < 0 || a == b) continue;
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

/* The value at corner c of a vertex with both coordinates given. */
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

/* Follows the path cone a - bridge - cone b: edges towards a reversed, the bridge, edges towards b.
 * The form p_b - p_a in the chart of the first face: i^-turn (f_b - T) - f_a. */
static qc_status develop(finder *f, const bridge *link, qc__walk *walk, int32_t *path) {
    const qc__seams *s = f->seams;
    const qc_mesh *mesh = s->mesh;
    const int32_t *ends = mesh->edge_vertex + 2 * (int64_t)link->edge;
    const bool forward = f->cell[ends[0]] == link->a;
    int32_t n = 0;
    for (int32_t v = ends[forward ? 0 : 1]; s->vertex_cone[v] < 0; n++) {
        path[n] = f->predecessor[v];
        v = other_end(mesh, path[n], v);
    }
    for (int32_t i = 0, j = n - 1; i < j; i++, j--) {
        const int32_t swap = path[i];
        path[i] = path[j];
        path[j] = swap;
    }
    path[n++] = link->edge;
    for (int32_t v = ends[forward ? 1 : 0]; s->vertex_cone[v] < 0; n++) {
        path[n] = f->predecessor[v];
        v = other_end(mesh, path[n], v);
    }
    walk->turn = walk->n = 0;
    int32_t v = s->cone_vertex[link->a];
    const int32_t first = mesh->edge_halfedge[2 * (int64_t)path[0]];
    int32_t c = corner_in_face(mesh, first, v);
    add_corner(f, c, 0, -1.0);
    for (int32_t i = 0; i < n; i++) {
        if (i > 0 && !turn_to_edge(f, walk, &c, path[i])) return QC_ERR_NOMEM;
        v = other_end(mesh, path[i], v);
        c = corner_in_face(mesh, c, v);
    }
    add_corner(f, c, -walk->turn, 1.0);
    for (int32_t i = 0; i < walk->n; i++)
        add_translation(f, walk->segment[i], -qc__turn(1.0, walk->term_turn[i] - walk->turn));
    return QC_OK;
}

static qc_status store_form(finder *f, qc__separation *s, int32_t pair) {
    int64_t n = s->start[pair];
    const int32_t n_free = f->seams->n_free;
    for (int32_t j = 0; j < n_free; j++) {
        const double _Complex value = f->sum[j];
        f->sum[j] = 0;
        if (creal(value) == 0 && cimag(value) == 0) continue;
        if (!qc__reserve(f->ctx, (void **)&s->variable, &f->variable_capacity, n + 1,
                         sizeof *s->variable) ||
            !qc__reserve(f->ctx, (void **)&s->value, &f->value_capacity, n + 1, sizeof *s->value))
            return QC_ERR_NOMEM;
        s->variable[n] = j;
        s->value[n++] = value;
    }
    s->start[pair + 1] = n;
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
        s->cone[2 * (int64_t)s->n] = s->cone[2 * (int64_t)s->n + 1] = -1;
        add_symbol(f, p, unit * (1.0 - I));
        add_symbol(f, p + 1, unit * (1.0 + I));
        status = store_form(f, s, s->n++);
    }
    return status;
}

static qc_status make_forms(finder *f, qc__separation *s) {
    const int64_t n = f->n_bridges, most = n + f->seams->n_poles;
    s->cone = QC__NEW(f->ctx, int32_t, 2 * most);
    s->start = QC__ZERO(f->ctx, int64_t, most + 1);
    f->sum = QC__ZERO(f->ctx, double _Complex, f->seams->n_free);
    int32_t *path = QC__NEW(f->ctx, int32_t, f->seams->mesh->n_vertices + 1);
    qc__walk walk = {0};
    qc_status status = s->cone && s->start && f->sum && path ? QC_OK : QC_ERR_NOMEM;
    for (int64_t i = 0; i < n && status == QC_OK; i++) {
        s->cone[2 * i] = f->bridges[i].a;
        s->cone[2 * i + 1] = f->bridges[i].b;
        status = develop(f, &f->bridges[i], &walk, path);
        if (status == QC_OK) status = store_form(f, s, (int32_t)i);
        s->n = (int32_t)i + 1;
    }
    qc__walk_free(&walk);
    qc__free(path);
    return status;
}

qc_status qc__separation_create(qc_ctx *ctx, const qc__seams *seams, double reach,
                                const int32_t *pole_index4, qc__separation **out) {
    finder f = {.ctx = ctx, .seams = seams};
    qc__separation *s = QC__ZERO(ctx, qc__separation, 1);
    qc_status status = s ? grow_cells(&f) : QC_ERR_NOMEM;
    if (status == QC_OK) status = find_bridges(&f, reach);
    if (status == QC_OK) status = make_forms(&f, s);
    if (status == QC_OK) status = make_pole_forms(&f, pole_index4, s);
    qc__free(f.distance);
    qc__free(f.predecessor);
    qc__free(f.cell);
    qc__free(f.bridges);
    qc__free(f.sum);
    if (status != QC_OK) {
        qc__separation_free(s);
        return status;
    }
    *out = s;
    return QC_OK;
}
