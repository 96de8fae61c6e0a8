/* Neighbours on the surface: points and pieces of features whose Voronoi cells touch, and the edge
 * over which the shortest path between them leads (see separation.h). */
#include "sdk/map/round/separation_finder.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef qc__finder finder;
typedef qc__bridge bridge;

qc_status qc__separation_find_pieces(finder *f) {
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

qc_status qc__separation_grow_cells(finder *f) {
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
            root = qc__other_end(mesh, f->predecessor[root], root);
        const int32_t cell = f->cell[root];
        for (int32_t w = v; f->cell[w] < 0 && f->predecessor[w] >= 0;
             w = qc__other_end(mesh, f->predecessor[w], w))
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

double qc__edge_length(const qc_mesh *mesh, int32_t e) {
    const double *p = mesh->position + 3 * (int64_t)mesh->edge_vertex[2 * (int64_t)e];
    const double *q = mesh->position + 3 * (int64_t)mesh->edge_vertex[2 * (int64_t)e + 1];
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

qc_status qc__separation_find_bridges(finder *f, double reach, int32_t beyond) {
    const qc_mesh *mesh = f->seams->mesh;
    f->n_bridges = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t v = mesh->edge_vertex[2 * (int64_t)e];
        const int32_t w = mesh->edge_vertex[2 * (int64_t)e + 1];
        const int32_t a = f->cell[v], b = f->cell[w];
        if (a < 0 || b < 0 || a == b || (a < beyond && b < beyond)) continue;
        const double length = f->distance[v] + f->distance[w] + qc__edge_length(mesh, e);
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
