/* Decimation in the parameter domain (docs/theory/quantization.md; after Coudert-Osmont et al.
 * 2024): vertices which need not be lattice points are removed in rounds, no two neighbours in one,
 * so that markers change their triangle a bounded number of times a round. */
#include "sdk/map/quantize/decimate.h"

#include <string.h>

enum {
    FIRST_DEGREE = 12, /* spokes of a vertex that is removed in the first rounds */
    MOST_DEGREE = 1 << 20
};

typedef struct decimation {
    qc__triangulation *T;
    uint8_t *fixed;     /* n_vertices */
    int32_t *round;     /* n_vertices: the last round which removed a neighbour */
    int32_t *living;    /* n_components: vertices left */
    int32_t *component; /* n_vertices */
} decimation;

/* Number of triangles about v; marks the neighbours with this round (> 0). */
static int32_t go_around(decimation *d, int32_t v, int32_t mark) {
    const qc__triangulation *T = d->T;
    const int32_t start = qc__first_spoke(T, v);
    int32_t h = start, n = 0;
    do {
        if (mark > 0) d->round[T->origin[qc_next(h)]] = d->round[T->origin[qc_prev(h)]] = mark;
        h = qc__spoke_ccw(T, h);
        n++;
    } while (h >= 0 && h != start);
    return n;
}

/* Removes v unless a neighbour was removed in this round or its degree is high. */
static bool try_vertex(decimation *d, int32_t v, int32_t round, int32_t most) {
    int32_t *living = &d->living[d->component[v]];
    if (*living < 2 || d->round[v] == round || go_around(d, v, 0) > most) return false;
    go_around(d, v, round);
    if (qc__remove_vertex(d->T, v)) {
        --*living;
        return true;
    }
    go_around(d, v, round - 1);
    return false;
}

/* One round; how many vertices were removed. */
static int32_t remove_round(decimation *d, int32_t round, int32_t most, int32_t *left) {
    int32_t removed = 0;
    *left = 0;
    for (int32_t v = 0; v < d->T->mesh->n_vertices; v++) {
        if (d->fixed[v] || d->T->spoke[v] < 0) continue;
        ++*left;
        removed += try_vertex(d, v, round, most);
    }
    return removed;
}

static qc_status remove_all(decimation *d) {
    int32_t most = FIRST_DEGREE, left = 1;
    qc_status status = qc__flip_to_delaunay(d->T);
    for (int32_t round = 1; status == QC_OK && left > 0; round++) {
        if (!qc__progress(d->T->ctx, 1.0 - 1.0 / round)) return QC_ERR_CANCELLED;
        const int32_t removed = remove_round(d, round, most, &left);
        left -= removed;
        if (removed == 0 && most == MOST_DEGREE) break;
        if (16 * removed < left || removed == 0) most = MOST_DEGREE;
        status = qc__flip_to_delaunay(d->T);
    }
    return status;
}

static qc_status decimate(qc__triangulation *T, const uint8_t *point) {
    const qc_mesh *m = T->mesh;
    decimation d = {.T = T,
                    .fixed = QC__NEW(T->ctx, uint8_t, m->n_vertices),
                    .round = QC__ZERO(T->ctx, int32_t, m->n_vertices),
                    .living = QC__ZERO(T->ctx, int32_t, m->n_components),
                    .component = QC__NEW(T->ctx, int32_t, m->n_vertices)};
    qc_status status = d.fixed && d.round && d.living && d.component ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) status = qc__find_fixed(T, point, d.fixed);
    for (int32_t v = 0; v < m->n_vertices && status == QC_OK; v++) {
        d.component[v] = m->face_component[m->vertex_corner[v] / 3];
        d.living[d.component[v]]++;
    }
    if (status == QC_OK) status = remove_all(&d);
    void *const blocks[] = {d.fixed, d.round, d.living, d.component};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    return status;
}

/* --- the result ------------------------------------------------------------------------------- */

void qc__coarse_map_free(qc__coarse_map *map) {
    if (!map) return;
    void *const blocks[] = {map->coarse.vector, map->coarse.twin,   map->coarse.rotation,
                            map->coarse.axis,   map->coarse.origin, map->triangle,
                            map->place,         map->turn};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    qc__free(map);
}

static qc_status allocate(qc_ctx *ctx, qc__coarse_map *map, int32_t n_triangles) {
    const int64_t n = 3 * (int64_t)n_triangles, n_faces = map->mesh->n_faces;
    qc__coarse *c = &map->coarse;
    c->n_triangles = n_triangles;
    c->vector = QC__NEW(ctx, qc__point, n);
    c->twin = QC__NEW(ctx, int32_t, n);
    c->rotation = QC__NEW(ctx, int8_t, n);
    c->axis = QC__NEW(ctx, int8_t, n);
    c->origin = QC__NEW(ctx, int32_t, n);
    map->triangle = QC__NEW(ctx, int32_t, n_faces);
    map->place = QC__NEW(ctx, qc__point, n_faces);
    map->turn = QC__NEW(ctx, int8_t, n_faces);
    return c->vector && c->twin && c->rotation && c->axis && c->origin && map->triangle &&
                   map->place && map->turn
               ? QC_OK
               : QC_ERR_NOMEM;
}

/* Numbers the living triangles anew. */
static void write_coarse(const qc__triangulation *T, const int32_t *number, qc__coarse_map *map) {
    qc__coarse *c = &map->coarse;
    for (int32_t h = 0; h < 3 * T->n_triangles; h++) {
        if (T->dead[h / 3]) continue;
        const int32_t at = 3 * number[h / 3] + h % 3, g = T->twin[h];
        c->vector[at] = T->vector[h];
        c->twin[at] = g < 0 ? -1 : 3 * number[g / 3] + g % 3;
        c->rotation[at] = T->rotation[h];
        c->axis[at] = T->axis[h];
        c->origin[at] = T->origin[h];
    }
    for (int32_t t = 0; t < T->n_triangles; t++)
        for (int32_t f = T->first_marker[t]; f >= 0; f = T->next_marker[f])
            map->triangle[f] = number[t];
    memcpy(map->place, T->place, sizeof *map->place * (size_t)map->mesh->n_faces);
    memcpy(map->turn, T->turn, sizeof *map->turn * (size_t)map->mesh->n_faces);
}

static qc_status publish(const qc__triangulation *T, int32_t bits, qc__coarse_map *map) {
    int32_t *number = QC__NEW(T->ctx, int32_t, T->n_triangles), n = 0;
    if (!number) return QC_ERR_NOMEM;
    for (int32_t t = 0; t < T->n_triangles; t++) number[t] = T->dead[t] ? -1 : n++;
    const qc_status status = allocate(T->ctx, map, n);
    map->coarse.bits = bits;
    if (status == QC_OK) write_coarse(T, number, map);
    qc__free(number);
    return status;
}

qc_status qc__coarse_map_create(qc_ctx *ctx, const qc__exact_map *map, qc__coarse_map **out) {
    qc__triangulation *T = NULL;
    qc__coarse_map *result = QC__ZERO(ctx, qc__coarse_map, 1);
    if (!result) return QC_ERR_NOMEM;
    result->mesh = map->mesh;
    qc_status status = qc__triangulation_create(ctx, map, &T);
    if (status == QC_OK) status = qc__poll(ctx);
    if (status == QC_OK) status = decimate(T, map->point);
    if (status == QC_OK) status = publish(T, map->bits + 2, result);
    qc__triangulation_free(T);
    if (status == QC_OK)
        *out = result;
    else
        qc__coarse_map_free(result);
    return status;
}
