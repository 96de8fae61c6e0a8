/* How far apart extraordinary vertices are: one search from all of them. The nearest other one of a
 * vertex is found where its cell of the graph meets another cell. */
#include "parts.h"

#include <stdlib.h>
#include <string.h>

typedef struct graph {
    int32_t n, *offset, *neighbour; /* n + 1, 2 edges */
} graph;

static bool make_graph(const qo_surface *surface, int32_t n, graph *g) {
    const int32_t n_edges = qo_surface_edges(surface, NULL);
    int32_t *edge = malloc((2 * (size_t)n_edges + 1) * sizeof *edge);
    *g = (graph){n, calloc((size_t)n + 2, sizeof(int32_t)),
                 malloc((2 * (size_t)n_edges + 1) * sizeof(int32_t))};
    const bool good = edge && g->offset && g->neighbour;
    if (good) {
        qo_surface_edges(surface, edge);
        for (int32_t i = 0; i < 2 * n_edges; i++) g->offset[edge[i] + 2]++;
        for (int32_t v = 1; v <= n; v++) g->offset[v + 1] += g->offset[v];
        for (int32_t i = 0; i < 2 * n_edges; i++)
            g->neighbour[g->offset[edge[i] + 1]++] = edge[i ^ 1];
    }
    free(edge);
    return good;
}

/* distance and source (-1 = not reached) of every vertex, breadth first. */
static void search(const graph *g, const uint8_t *flag, int32_t *queue, int32_t *distance,
                   int32_t *source) {
    int32_t head = 0, tail = 0;
    for (int32_t v = 0; v < g->n; v++) {
        source[v] = flag[v] ? v : -1;
        distance[v] = 0;
        if (flag[v]) queue[tail++] = v;
    }
    while (head < tail) {
        const int32_t v = queue[head++];
        for (int32_t i = g->offset[v]; i < g->offset[v + 1]; i++) {
            const int32_t w = g->neighbour[i];
            if (source[w] >= 0) continue;
            source[w] = source[v];
            distance[w] = distance[v] + 1;
            queue[tail++] = w;
        }
    }
}

/* nearest[s] = edges from s to the nearest other source, 0 = there is none. */
static void meet(const graph *g, const int32_t *distance, const int32_t *source, int32_t *nearest) {
    for (int32_t v = 0; v < g->n; v++)
        for (int32_t i = g->offset[v]; i < g->offset[v + 1]; i++) {
            const int32_t w = g->neighbour[i], s = source[v];
            if (s < 0 || source[w] < 0 || s == source[w]) continue;
            const int32_t length = distance[v] + distance[w] + 1;
            if (nearest[s] == 0 || length < nearest[s]) nearest[s] = length;
        }
}

qc_status qo_measure_spacing(const qc_run *run, const qo_surface *surface, int32_t n_vertices,
                             const uint8_t *flag, qc_subdivision_report *report) {
    graph g;
    const size_t n = (size_t)n_vertices + 1;
    const bool made = make_graph(surface, n_vertices, &g);
    int32_t *work = made ? calloc(4 * n, sizeof *work) : NULL;
    const bool done = work != NULL;
    if (done) {
        int32_t *nearest = work + 3 * n, count = 0;
        search(&g, flag, work, work + n, work + 2 * n);
        meet(&g, work + n, work + 2 * n, nearest);
        for (int32_t v = 0; v < n_vertices; v++) {
            if (nearest[v] == 0) continue;
            if (report->spacing == 0 || nearest[v] < report->spacing) report->spacing = nearest[v];
            report->mean_spacing += nearest[v];
            count++;
        }
        if (count > 0) report->mean_spacing /= count;
    }
    free(work);
    free(g.offset);
    free(g.neighbour);
    return done ? QC_OK : qo_nomem(run);
}
