/* Vertices and duplicate faces of a polygon mesh: fans, valences, boundary loops. */
#include <string.h>

#include "sdk/mesh/internal.h"

/* --- duplicates: equal vertex sets, found by sorting a commutative hash of the vertices */

static uint64_t mix(uint64_t x) { /* finaliser of splitmix64 (Steele, Lea, Flood 2014) */
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/* Equal as multisets, judged by a second, independent 64-bit hash. */
static bool same_vertices(const qc_polygon_mesh *p, int32_t f, int32_t g) {
    int32_t n = p->face_offset[f + 1] - p->face_offset[f];
    if (p->face_offset[g + 1] - p->face_offset[g] != n) return false;
    uint64_t difference = 0;
    for (int32_t i = 0; i < n; i++) {
        difference += mix(~(uint64_t)(uint32_t)p->face_vertex[p->face_offset[f] + i]);
        difference -= mix(~(uint64_t)(uint32_t)p->face_vertex[p->face_offset[g] + i]);
    }
    return difference == 0;
}

qc_status qc__polygon_duplicates(qc_ctx *ctx, const qc_polygon_mesh *p, int32_t *count,
                                 int32_t *first) {
    uint64_t *key = QC__NEW(ctx, uint64_t, p->n_faces);
    int32_t *face = QC__NEW(ctx, int32_t, p->n_faces);
    qc_status status = key && face ? QC_OK : QC_ERR_NOMEM;
    for (int32_t f = 0; status == QC_OK && f < p->n_faces; f++) {
        uint64_t sum = 0;
        for (int32_t c = p->face_offset[f]; c < p->face_offset[f + 1]; c++)
            sum += mix((uint64_t)(uint32_t)p->face_vertex[c]);
        key[f] = sum;
        face[f] = f;
    }
    if (status == QC_OK) status = qc__sort_keys(ctx, p->n_faces, key, face);
    for (int32_t i = 1; status == QC_OK && i < p->n_faces; i++) {
        if (key[i] != key[i - 1] || !same_vertices(p, face[i - 1], face[i])) continue;
        ++*count;
        if (*first < 0 || face[i] < *first) *first = face[i];
    }
    qc__free(key);
    qc__free(face);
    return status;
}

/* --- vertices --------------------------------------------------------------------------------- */

typedef struct vertices {
    int32_t *previous; /* by corner: previous corner of the face                                  */
    int32_t *twin; /* by side: the other side of a consistent interior edge, else -1           */
    int32_t *set;  /* by corner: union-find of the corners of a vertex joined by edges         */
    int32_t *fans, *valence; /* by vertex */
    uint8_t *interior;       /* by vertex: all its edges are consistent interior edges       */
    uint8_t *boundary;       /* by side: its edge has no other face       */
} vertices;

static bool vertices_create(qc_ctx *ctx, const qc_polygon_mesh *p, vertices *w) {
    w->previous = QC__NEW(ctx, int32_t, p->n_corners);
    w->twin = QC__NEW(ctx, int32_t, p->n_corners);
    w->set = QC__NEW(ctx, int32_t, p->n_corners);
    w->fans = QC__ZERO(ctx, int32_t, p->n_vertices);
    w->valence = QC__ZERO(ctx, int32_t, p->n_vertices);
    w->interior = QC__NEW(ctx, uint8_t, p->n_vertices);
    w->boundary = QC__ZERO(ctx, uint8_t, p->n_corners);
    return w->previous && w->twin && w->set && w->fans && w->valence && w->interior && w->boundary;
}

static void vertices_free(vertices *w) {
    qc__free(w->previous);
    qc__free(w->twin);
    qc__free(w->set);
    qc__free(w->fans);
    qc__free(w->valence);
    qc__free(w->interior);
    qc__free(w->boundary);
}

/* Corner of vertex v at side c (one of its two ends). */
static int32_t corner_at(const qc_polygon_mesh *p, const qc__sides *s, int32_t c, int32_t v) {
    return p->face_vertex[c] == v ? c : s->next[c];
}

static void join_edges(const qc_polygon_mesh *p, const qc__sides *s, vertices *w) {
    for (int32_t c = 0; c < s->n; c++) {
        w->previous[s->next[c]] = c;
        w->twin[c] = -1;
    }
    qc__sets_init(w->set, s->n);
    memset(w->interior, 1, (size_t)p->n_vertices);
    for (int32_t g = 0; g < s->n_groups; g++) {
        int32_t begin = s->group[g], n = s->group[g + 1] - begin, c = s->order[begin];
        int32_t a = p->face_vertex[c], b = p->face_vertex[s->next[c]];
        if (n == 2 && p->face_vertex[s->order[begin + 1]] == b && a != b) {
            w->twin[c] = s->order[begin + 1];
            w->twin[s->order[begin + 1]] = c;
        } else {
            w->interior[a] = w->interior[b] = 0;
            w->boundary[c] = n == 1 && a != b;
        }
        for (int32_t i = 1; i < n && a != b; i++) {
            int32_t d = s->order[begin + i];
            qc__sets_unite(w->set, corner_at(p, s, c, a), corner_at(p, s, d, a));
            qc__sets_unite(w->set, corner_at(p, s, c, b), corner_at(p, s, d, b));
        }
    }
}

/* The boundary side after c: turn round its end vertex until an edge without twin; -1 when that is
 * no boundary edge. The map is injective, so each orbit (closed or not) is met once. */
static int32_t next_boundary(const qc__sides *s, const vertices *w, int32_t c) {
    int32_t d = s->next[c];
    while (w->twin[d] >= 0) d = s->next[w->twin[d]];
    return w->boundary[d] ? d : -1;
}

static qc_status count_loops(qc_ctx *ctx, const qc__sides *s, const vertices *w, int32_t *loops) {
    int32_t *set = QC__NEW(ctx, int32_t, s->n);
    if (!set) return QC_ERR_NOMEM;
    qc__sets_init(set, s->n);
    for (int32_t c = 0; c < s->n; c++) {
        int32_t d = w->boundary[c] ? next_boundary(s, w, c) : -1;
        if (d >= 0) qc__sets_unite(set, c, d);
    }
    for (int32_t c = 0; c < s->n; c++) *loops += w->boundary[c] && set[c] == c;
    qc__free(set);
    return QC_OK;
}

qc_status qc__polygon_vertices(qc_ctx *ctx, const qc_polygon_mesh *p, const qc__sides *s,
                               qc_polygon_topology *out, int32_t *first_non_manifold) {
    vertices w = {0};
    qc_status status = vertices_create(ctx, p, &w) ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        join_edges(p, s, &w);
        for (int32_t c = 0; c < s->n; c++) {
            w.valence[p->face_vertex[c]]++;
            w.fans[p->face_vertex[c]] += w.set[c] == c;
        }
        for (int32_t v = 0; v < p->n_vertices; v++) {
            if (w.fans[v] > 1 && out->non_manifold_vertices++ == 0) *first_non_manifold = v;
            out->irregular += w.fans[v] == 1 && w.interior[v] && w.valence[v] != 4;
        }
        status = count_loops(ctx, s, &w, &out->boundary_loops);
    }
    vertices_free(&w);
    return status;
}
