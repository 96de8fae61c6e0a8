/* Weighted graphs of clusters: of elements, and of nodes of a finer graph. Two nodes are joined by
 * as much weight as rows connect them. */
#include "sdk/sparse/order/internal.h"
#include <string.h>

enum { CLUSTER = 8 };

static int32_t *take(qc__heap *heap, int64_t count) {
    if (heap->free < count) return NULL;
    int32_t *block = heap->next;
    heap->next += count;
    heap->free -= count;
    return block;
}

/* Node arrays, and arc arrays which may use all the rest until close_arcs. */
static bool open_graph(qc__heap *heap, int32_t n, bool centers, qc__graph *G) {
    int32_t *block =
        take(heap, 8 * (int64_t)n + 1 + n / 2 + 1 + (centers ? 3 * ((int64_t)n + 1) / 2 : 0));
    if (!block) return false;
    G->n = n;
    G->arcs = 0;
    G->start = block;
    G->size = G->start + n + 1;
    G->distance = G->size + n;
    G->next = G->distance + n;
    G->path = G->next + n;
    G->queue = G->path + n;
    G->order = G->queue + n;
    G->nearest = G->order + n;
    G->center = centers ? (int16_t *)(G->nearest + n) : NULL;
    G->side = (uint8_t *)(G->nearest + n + (centers ? 3 * ((int64_t)n + 1) / 2 : 0));
    G->best = G->side + n;
    G->capacity = heap->free / 4 < INT32_MAX ? (int32_t)(heap->free / 4) : INT32_MAX;
    G->arc = heap->next;
    G->weight = G->arc + G->capacity;
    memset(G->size, 0, (size_t)n * sizeof *G->size);
    memset(G->next, 255, (size_t)n * sizeof *G->next); /* last arc to a node */
    return true;
}

static bool add_arc(qc__graph *G, int32_t from, int32_t to, int32_t weight) {
    int32_t a = G->next[to];
    if (a < G->start[from]) {
        if (G->arcs == G->capacity) return false;
        a = G->next[to] = G->arcs++;
        G->arc[a] = to;
        G->weight[a] = 0;
    }
    G->weight[a] += weight;
    return true;
}

static void close_arcs(qc__heap *heap, qc__graph *G) {
    int32_t *block = heap->next;
    memmove(block + G->arcs, G->weight, (size_t)G->arcs * sizeof *block);
    G->weight = block + G->arcs;
    G->reverse = G->weight + G->arcs;
    G->flow = G->reverse + G->arcs;
    take(heap, 4 * (int64_t)G->arcs);
    G->start[G->n] = G->arcs;
    for (int32_t k = 0; k < G->n; k++)
        for (int32_t a = G->start[k]; a < G->start[k + 1]; a++) {
            int32_t b = G->start[G->arc[a]];
            while (G->arc[b] != k) b++;
            G->reverse[a] = b;
        }
}

bool qc__graph_of_clusters(const qc__cover *C, const int16_t *center, qc__heap *heap, int32_t *of,
                           qc__graph *G) {
    int32_t n = 0;
    for (int32_t e = 0; e < C->m; e++) {
        n += e == 0 || C->element[e].cluster != C->element[e - 1].cluster;
        of[e] = n - 1;
    }
    if (n > C->m / 4 || !open_graph(heap, n, center, G)) return false;
    for (int32_t e = 0, k = -1; e < C->m; e++) {
        if (of[e] != k) {
            G->start[++k] = G->arcs;
            for (int d = 0; d < 3 && center; d++)
                G->center[3 * k + d] = center[3 * (int64_t)C->element[e].cluster + d];
        }
        G->size[k]++;
        for (int32_t p = C->element[e].begin; p < C->element[e].active; p++) {
            const qc__net net = C->net[C->entry[p]];
            if (net.end - net.begin > QC__WIDE_NET) continue;
            for (int32_t q = net.begin; q < net.end; q++) {
                const int32_t j = of[C->element_of[q]];
                if (j != k && !add_arc(G, k, j, 1)) return false;
            }
        }
    }
    close_arcs(heap, G);
    return true;
}

/* of[k]: cluster of node k; members: nodes by cluster. Returns the number of clusters. */
static int32_t cluster_nodes(const qc__graph *G, int32_t *of, int32_t *members) {
    int32_t count = 0, clusters = 0, around = 0;
    memset(of, 255, (size_t)G->n * sizeof *of);
    for (int32_t root = 0; root < G->n; root++) {
        int32_t seed = of[root] == -1 ? root : -1;
        while (seed != -1) {
            const int32_t begin = count;
            of[seed] = clusters;
            members[count++] = seed;
            for (int32_t i = begin; i < count && count < begin + CLUSTER; i++)
                for (int32_t a = G->start[members[i]]; a < G->start[members[i] + 1]; a++) {
                    if (of[G->arc[a]] != -1 || count == begin + CLUSTER) continue;
                    of[G->arc[a]] = clusters;
                    members[count++] = G->arc[a];
                }
            clusters++;
            for (seed = -1; around < count && seed == -1; around += seed == -1)
                for (int32_t a = G->start[members[around]]; a < G->start[members[around] + 1]; a++)
                    if (of[G->arc[a]] == -1) seed = G->arc[a];
        }
    }
    return clusters;
}

static void average_centers(const qc__graph *G, const int32_t *of, qc__graph *H) {
    for (int d = 0; d < 3; d++) {
        memset(H->queue, 0, (size_t)H->n * sizeof *H->queue);
        memset(H->order, 0, (size_t)H->n * sizeof *H->order);
        for (int32_t k = 0; k < G->n; k++) {
            H->queue[of[k]] += G->center[3 * k + d];
            H->order[of[k]]++;
        }
        for (int32_t k = 0; k < H->n; k++)
            H->center[3 * k + d] = (int16_t)(H->queue[k] / H->order[k]);
    }
}

bool qc__graph_coarsen(const qc__graph *G, qc__heap *heap, int32_t *of, qc__graph *H) {
    int32_t *members = G->queue;
    const int32_t n = cluster_nodes(G, of, members);
    if (n > G->n / 2 || !open_graph(heap, n, G->center, H)) return false;
    for (int32_t i = 0, k = -1; i < G->n; i++) {
        const int32_t u = members[i];
        if (of[u] != k) H->start[++k] = H->arcs;
        H->size[k] += G->size[u];
        for (int32_t a = G->start[u]; a < G->start[u + 1]; a++) {
            const int32_t j = of[G->arc[a]];
            if (j != k && !add_arc(H, k, j, G->weight[a])) return false;
        }
    }
    close_arcs(heap, H);
    if (G->center) average_centers(G, of, H);
    return true;
}
