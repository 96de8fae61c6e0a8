/* Whether features are chains of quad edges: the vertices of the lines which lie on a chain, sorted
 * by arc length, are joined by lines one after the other, from its first vertex to its last or
 * round, and no line is left over. Nothing here is taken from the map which the quads were made of.
 */
#ifndef QC_TESTS_COVER_H
#define QC_TESTS_COVER_H

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <qc/mesh.h>

typedef struct cover {
    int32_t n_chains, n_broken;         /* chains, those which are no chain of lines              */
    int32_t n_lines, n_used, n_foreign; /* lines, those on a chain, those which are no quad edge */
    double off;     /* largest distance of an end of a line to its chain           */
    double sagitta; /* of the middles of lines to the features, and of the vertices and the middles
                       of the edges of features to the lines */
} cover;

typedef struct cover_node {
    double arc;
    int32_t vertex;
} cover_node;

/* Squared distance to a segment; *t is the place in it. */
static inline double cover_distance2(const double *p, const double *a, const double *b, double *t) {
    double along = 0, length2 = 0, d = 0;
    for (int k = 0; k < 3; k++) {
        along += (p[k] - a[k]) * (b[k] - a[k]);
        length2 += (b[k] - a[k]) * (b[k] - a[k]);
    }
    *t = length2 > 0 ? fmin(1, fmax(0, along / length2)) : 0;
    for (int k = 0; k < 3; k++) d += pow(p[k] - a[k] - *t * (b[k] - a[k]), 2);
    return d;
}

static inline double cover_nearest(const double *p, const double *position, const int32_t *segment,
                                   int32_t n) {
    double least = INFINITY, t;
    for (int32_t i = 0; i < n; i++)
        least = fmin(least, cover_distance2(p, position + 3 * (size_t)segment[2 * i],
                                            position + 3 * (size_t)segment[2 * i + 1], &t));
    return sqrt(least);
}

/* Largest distance of the ends and middles of segments to other segments. */
static inline double cover_hausdorff(const double *position, const int32_t *segment, int32_t n,
                                     const double *other, const int32_t *to, int32_t n_to) {
    double most = 0, p[3];
    for (int32_t i = 0; i < n; i++)
        for (int j = 0; j < 2; j++) {
            const double *a = position + 3 * (size_t)segment[2 * i];
            const double *b = position + 3 * (size_t)segment[2 * i + 1];
            for (int k = 0; k < 3; k++) p[k] = j ? 0.5 * (a[k] + b[k]) : a[k];
            most = fmax(most, cover_nearest(p, other, to, n_to));
        }
    return most;
}

static inline int cover_compare_nodes(const void *p, const void *q) {
    const cover_node *a = p, *b = q;
    return a->arc < b->arc ? -1 : a->arc > b->arc;
}

/* The chain which begins with edge `first` of n at end `from` of it, up to a vertex with other than
 * two edges or round: its vertices in order. Its edges are marked as done; returns their number. */
static inline int32_t cover_walk(const int32_t *segment, int32_t n, const int32_t *degree,
                                 int32_t first, int from, uint8_t *done, int32_t *path) {
    int32_t length = 0, e = first;
    path[0] = segment[2 * first + from];
    while (e < n) {
        done[e] = 1;
        path[length + 1] = segment[2 * e] + segment[2 * e + 1] - path[length];
        const int32_t v = path[++length];
        if (degree[v] != 2) break;
        for (e = 0; e < n; e++)
            if (!done[e] && (segment[2 * e] == v || segment[2 * e + 1] == v)) break;
    }
    return length;
}

static inline double cover_length(const qc_mesh *mesh, const int32_t *path, int32_t n) {
    double length = 0, t;
    for (int32_t i = 0; i < n; i++) {
        const double *a = mesh->position + 3 * (size_t)path[i];
        const double *b = mesh->position + 3 * (size_t)path[i + 1];
        length += sqrt(cover_distance2(a, b, b, &t));
    }
    return length;
}

/* The places where a path passes within `near` of a vertex: it may touch itself in space. */
static inline int32_t cover_passages(const qc_mesh *mesh, const int32_t *path, int32_t n_edges,
                                     const double *p, int32_t vertex, double near, int32_t most,
                                     cover_node *node, double *off) {
    double arc = 0, best = INFINITY, t, unused;
    int32_t n = 0;
    for (int32_t i = 0; i < n_edges; i++) {
        const double *a = mesh->position + 3 * (size_t)path[i];
        const double *b = mesh->position + 3 * (size_t)path[i + 1];
        const double d = sqrt(cover_distance2(p, a, b, &t));
        const double length = sqrt(cover_distance2(a, b, b, &unused));
        if (d <= near && isinf(best) && n < most) n++;
        if (d <= near && d < best) {
            node[n - 1] = (cover_node){arc + t * length, vertex};
            *off = fmax(*off, d);
        }
        best = d <= near ? fmin(d, best) : INFINITY;
        arc += length;
    }
    return n;
}

enum { COVER_PASSAGES = 8 };

/* Those of all vertices of lines by arc length. Returns their number. */
static inline int32_t cover_nodes(const qc_mesh *mesh, const int32_t *path, int32_t n_edges,
                                  const double *position, const int32_t *corner, int32_t n_corners,
                                  double near, cover_node *node, double *off) {
    int32_t n = 0;
    for (int32_t c = 0; c < n_corners; c++)
        n += cover_passages(mesh, path, n_edges, position + 3 * (size_t)corner[c], corner[c], near,
                            COVER_PASSAGES, node + n, off);
    qsort(node, (size_t)n, sizeof *node, cover_compare_nodes);
    return n;
}

static inline int cover_take(const int32_t *line, int32_t n, uint8_t *used, int32_t a, int32_t b) {
    for (int32_t i = 0; i < n; i++) {
        const int32_t *l = line + 2 * (size_t)i;
        if (used[i] || !((l[0] == a && l[1] == b) || (l[0] == b && l[1] == a))) continue;
        used[i] = 1;
        return 1;
    }
    return 0;
}

/* Goes along unused lines from node to node, in the order of arcs, and takes them. Nodes of another
 * chain which lies here in space as well are passed over; were it one of this chain, its lines
 * would be left over. Returns whether it comes to the end, or round. */
static inline bool cover_follow(const cover_node *node, int32_t n, int32_t start, bool closed,
                                double last, const int32_t *line, int32_t n_lines, uint8_t *used) {
    const int32_t limit = closed ? start + n : n - 1;
    int32_t at = start, next = start + 1;
    while (next <= limit) {
        if (cover_take(line, n_lines, used, node[at % n].vertex, node[next % n].vertex)) at = next;
        next++;
    }
    return closed ? at == limit : node[at].arc >= last;
}

/* Whether some start leads along the whole path; its lines are taken then. */
static inline bool cover_chain(const cover_node *node, int32_t n, double length, bool closed,
                               double near, const int32_t *line, int32_t n_lines, uint8_t *used) {
    uint8_t *before = malloc((size_t)n_lines + 1);
    bool whole = false;
    memcpy(before, used, (size_t)n_lines);
    for (int32_t i = 0; i < n && !whole && (closed || node[i].arc <= near); i++) {
        memcpy(used, before, (size_t)n_lines);
        whole = cover_follow(node, n, i, closed, length - near, line, n_lines, used);
    }
    if (!whole) memcpy(used, before, (size_t)n_lines);
    free(before);
    return whole;
}

static inline int cover_compare_numbers(const void *p, const void *q) {
    const int32_t a = *(const int32_t *)p, b = *(const int32_t *)q;
    return a < b ? -1 : a > b;
}

/* The ends of lines, each once; returns their number. */
static inline int32_t cover_ends(const int32_t *line, int32_t n, int32_t *end) {
    int32_t m = 0;
    memcpy(end, line, 2 * (size_t)n * sizeof *end);
    qsort(end, 2 * (size_t)n, sizeof *end, cover_compare_numbers);
    for (int32_t i = 0; i < 2 * n; i++)
        if (m == 0 || end[m - 1] != end[i]) end[m++] = end[i];
    return m;
}

static inline bool cover_is_edge(const qc_polygon_mesh *quads, int32_t a, int32_t b) {
    for (int32_t f = 0; f < quads->n_faces; f++)
        for (int i = 0; i < 4; i++) {
            const int32_t *v = quads->face_vertex + 4 * (size_t)f;
            if ((v[i] == a && v[(i + 1) % 4] == b) || (v[i] == b && v[(i + 1) % 4] == a))
                return true;
        }
    return false;
}

/* The edges of quads with one face: pairs in a new array, *n of them. */
static inline int32_t *cover_boundary(const qc_polygon_mesh *quads, int32_t *n) {
    const size_t n_corners = 4 * (size_t)quads->n_faces;
    int32_t *valence = calloc((size_t)quads->n_vertices + 1, sizeof *valence);
    int32_t *next = malloc(n_corners * sizeof *next), *pair = malloc(2 * n_corners * sizeof *pair);
    *n = 0;
    for (size_t c = 0; c < n_corners; c++) valence[quads->face_vertex[c] + 1]++;
    for (int32_t v = 0; v < quads->n_vertices; v++) valence[v + 1] += valence[v];
    int32_t *first = malloc(((size_t)quads->n_vertices + 1) * sizeof *first);
    memcpy(first, valence, ((size_t)quads->n_vertices + 1) * sizeof *first);
    for (size_t c = 0; c < n_corners; c++)
        next[first[quads->face_vertex[c]]++] = quads->face_vertex[c % 4 == 3 ? c - 3 : c + 1];
    for (size_t c = 0; c < n_corners; c++) {
        const int32_t a = quads->face_vertex[c], b = quads->face_vertex[c % 4 == 3 ? c - 3 : c + 1];
        bool back = false;
        for (int32_t i = valence[b]; i < valence[b + 1]; i++) back |= next[i] == a;
        if (back) continue;
        pair[2 * *n] = a;
        pair[2 * (*n)++ + 1] = b;
    }
    free(first);
    free(next);
    free(valence);
    return pair;
}

/* One chain; `end`: the n_ends vertices of lines, node: room for all passages. */
static inline bool cover_path(const qc_mesh *mesh, const int32_t *path, int32_t n_edges,
                              const qc_polygon_mesh *quads, const int32_t *line, int32_t n_lines,
                              const int32_t *end, int32_t n_ends, double near, cover_node *node,
                              uint8_t *used, double *off) {
    const int32_t n =
        cover_nodes(mesh, path, n_edges, quads->position, end, n_ends, near, node, off);
    return cover_chain(node, n, cover_length(mesh, path, n_edges), path[0] == path[n_edges], near,
                       line, n_lines, used);
}

/* The flagged edges of the mesh against lines of the quads; `near` in units of the mesh. */
static inline cover cover_measure(const qc_mesh *mesh, const uint8_t *edge,
                                  const qc_polygon_mesh *quads, const int32_t *line,
                                  int32_t n_lines, double near) {
    const size_t m = (size_t)mesh->n_edges, l = (size_t)n_lines + 1;
    cover out = {.n_lines = n_lines};
    int32_t n = 0, *segment = malloc(2 * m * sizeof *segment);
    int32_t *path = malloc((m + 1) * sizeof *path), *end = malloc(2 * l * sizeof *end);
    int32_t *degree = calloc((size_t)mesh->n_vertices, sizeof *degree);
    uint8_t *used = calloc(l, 1), *done = calloc(m, 1);
    cover_node *node = malloc(2 * COVER_PASSAGES * l * sizeof *node);
    for (size_t e = 0; e < m; e++)
        if (edge[e])
            for (int i = 0; i < 2; i++) {
                degree[mesh->edge_vertex[2 * e + (size_t)i]]++;
                segment[n++] = mesh->edge_vertex[2 * e + (size_t)i];
            }
    n /= 2;
    const int32_t n_ends = cover_ends(line, n_lines, end);
    for (int closed = 0; closed < 2; closed++)
        for (int32_t i = 0; i < 2 * n; i++) {
            if (done[i / 2] || (!closed && degree[segment[i]] == 2)) continue;
            const int32_t n_edges = cover_walk(segment, n, degree, i / 2, i % 2, done, path);
            out.n_chains++;
            out.n_broken += !cover_path(mesh, path, n_edges, quads, line, n_lines, end, n_ends,
                                        near, node, used, &out.off);
        }
    for (int32_t i = 0; i < n_lines; i++) {
        out.n_used += used[i];
        out.n_foreign += !cover_is_edge(quads, line[2 * i], line[2 * i + 1]);
    }
    out.sagitta = fmax(cover_hausdorff(mesh->position, segment, n, quads->position, line, n_lines),
                       cover_hausdorff(quads->position, line, n_lines, mesh->position, segment, n));
    free(node);
    free(done);
    free(used);
    free(degree);
    free(end);
    free(path);
    free(segment);
    return out;
}

#endif
