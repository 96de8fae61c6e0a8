/* The vector between two points of the map, developed along a path of edges, as a linear form in
 * the free variables (see separation.h). */
#include "sdk/map/round/separation_finder.h"

typedef qc__finder finder;

void qc__separation_add_symbol(finder *f, int32_t symbol, double _Complex factor) {
    const qc__rows *rows = &f->seams->symbol_row;
    for (int64_t i = rows->start[symbol]; i < rows->start[symbol + 1]; i++)
        f->sum[rows->column[i]] += factor * rows->value[i];
}

static void add_translation(finder *f, int32_t segment, double _Complex factor) {
    qc__separation_add_symbol(f, qc__translation_symbol(segment, 0), factor);
    qc__separation_add_symbol(f, qc__translation_symbol(segment, 1), factor * I);
}

/* What is given of the value at corner c. */
static void add_corner(finder *f, int32_t c, int32_t turn, double _Complex sign) {
    const qc__seams *s = f->seams;
    const int32_t w = s->corner_wedge[c], row = 2 * s->vertex_given[s->mesh->face_vertex[c]];
    for (int32_t k = 0; k < 2; k++)
        for (int64_t i = s->given_start[row + k]; i < s->given_start[row + k + 1]; i++)
            qc__separation_add_symbol(f, s->given_symbol[i],
                                      s->given_value[i] *
                                          qc__turn(k ? sign * I : sign, turn + s->wedge_turn[w]));
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

qc_status qc__separation_develop(finder *f, const int32_t *path, int32_t n, qc__walk *walk,
                                 int32_t *v, int32_t *parts, double _Complex *way) {
    const qc__seams *s = f->seams;
    const qc_mesh *mesh = s->mesh;
    walk->turn = walk->n = 0;
    int32_t c = corner_in_face(mesh, mesh->edge_halfedge[2 * (int64_t)path[0]], *v);
    *way = 0;
    add_corner(f, c, 0, -1.0);
    *parts = given_parts(s, c, 0);
    for (int32_t i = 0; i < n; i++) {
        if (i > 0 && !turn_to_edge(f, walk, &c, path[i])) return QC_ERR_NOMEM;
        *v = qc__other_end(mesh, path[i], *v);
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

qc_status qc__separation_reserve(finder *f, qc__separation *s, int64_t n) {
    if (!qc__reserve(f->ctx, (void **)&s->vertex, &f->vertex_capacity, 2 * n + 1,
                     sizeof *s->vertex) ||
        !qc__reserve(f->ctx, (void **)&s->start, &f->start_capacity, n + 1, sizeof *s->start))
        return QC_ERR_NOMEM;
    if (s->n == 0) s->start[0] = 0;
    return QC_OK;
}

qc_status qc__separation_store(finder *f, qc__separation *s, const int32_t ends[2], int32_t parts) {
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
