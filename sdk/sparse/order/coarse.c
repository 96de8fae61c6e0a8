/* A first bisection on clusters of elements: smallest cut of the weighted graph of clusters between
 * its two ends (Schild, Sommer 2015: flow between the outer parts of a linear order). */
#include "sdk/sparse/order/internal.h"
#include <string.h>

#ifndef ALPHA
#define ALPHA 0.30
#endif
enum { WIDE_NET = 8 };

typedef struct clusters {
    int32_t n; /* clusters */
    int32_t arcs, capacity;
    int32_t *start, *size, *distance, *queue, *next, *path, *order; /* n, start n + 1 */
    int32_t *arc, *reverse, *weight, *flow;                         /* arcs */
    uint8_t *side;
} clusters;

/* Elements of a cluster are consecutive. */
static bool build(const qc__cover *C, qc__cut_work *w, clusters *G) {
    int32_t n = 0;
    for (int32_t e = 0; e < C->m; e++) {
        if (e == 0 || C->element[e].cluster != C->element[e - 1].cluster) n++;
        w->label[e] = n - 1;
    }
    if (n > C->m / 4) return false;
    const int32_t *of = w->label;
    int32_t *block = w->coarse;
    G->n = n;
    G->start = block, block += n + 1;
    G->size = block, block += n;
    G->distance = block, block += n;
    G->queue = block, block += n + 1;
    G->next = block, block += n;
    G->path = block, block += n;
    G->order = block, block += n;
    G->side = (uint8_t *)block;
    G->capacity = C->element[C->m - 1].end / 2;
    G->arc = w->arcs;
    G->reverse = G->arc + G->capacity;
    G->weight = G->reverse + G->capacity;
    G->flow = G->weight + G->capacity;
    G->arcs = 0;
    int32_t *mark = G->next;
    for (int32_t k = 0; k < n; k++) {
        mark[k] = -1;
        G->size[k] = 0;
    }
    for (int32_t e = 0, k = -1; e < C->m; e++) {
        if (of[e] != k) G->start[++k] = G->arcs;
        G->size[k]++;
        for (int32_t p = C->element[e].begin; p < C->element[e].active; p++) {
            const qc__net net = C->net[C->entry[p]];
            if (net.end - net.begin > WIDE_NET) continue;
            for (int32_t q = net.begin; q < net.end; q++) {
                const int32_t j = of[C->element_of[q]];
                if (j == k) continue;
                if (mark[j] < G->start[k]) {
                    if (G->arcs == G->capacity) return false;
                    G->arc[mark[j] = G->arcs++] = j;
                    G->weight[mark[j]] = 0;
                }
                G->weight[mark[j]]++;
            }
        }
    }
    G->start[n] = G->arcs;
    for (int32_t k = 0; k < n; k++)
        for (int32_t a = G->start[k]; a < G->start[k + 1]; a++) {
            int32_t b = G->start[G->arc[a]];
            while (G->arc[b] != k) b++;
            G->reverse[a] = b;
        }
    return true;
}

/* Clusters in the order of their discovery from `root`, component after component. */
static void breadth_first(const clusters *G, int32_t root, int32_t *order) {
    int32_t queued = 0, next = 0;
    for (int32_t k = 0; k < G->n; k++) G->distance[k] = -1;
    for (;;) {
        G->distance[root] = 0;
        order[queued++] = root;
        for (int32_t i = queued - 1; i < queued; i++) {
            const int32_t u = order[i];
            for (int32_t a = G->start[u]; a < G->start[u + 1]; a++) {
                const int32_t v = G->arc[a];
                if (G->distance[v] != -1) continue;
                G->distance[v] = G->distance[u] + 1;
                order[queued++] = v;
            }
        }
        if (queued == G->n) return;
        while (G->distance[next] != -1) next++;
        root = next;
    }
}

/* Distance of clusters to the sinks by arcs which are not full; whether a source was found. */
static bool layers(clusters *G) {
    int32_t queued = 0;
    bool found = false;
    for (int32_t k = 0; k < G->n; k++) {
        G->distance[k] = G->side[k] == QC__SINK ? 0 : -1;
        if (G->side[k] == QC__SINK) G->queue[queued++] = k;
    }
    for (int32_t i = 0; i < queued; i++) {
        const int32_t u = G->queue[i];
        if (G->side[u] == QC__SOURCE) {
            found = true;
            continue;
        }
        for (int32_t a = G->start[u]; a < G->start[u + 1]; a++) {
            const int32_t v = G->arc[a];
            if (G->distance[v] != -1 || G->flow[G->reverse[a]] == G->weight[a]) continue;
            G->distance[v] = G->distance[u] + 1;
            G->queue[queued++] = v;
        }
    }
    return found;
}

static bool augment(clusters *G, int32_t s) {
    int32_t length = 0, u = s;
    while (G->side[u] != QC__SINK) {
        int32_t a = G->next[u];
        while (a < G->start[u + 1] &&
               (G->distance[G->arc[a]] != G->distance[u] - 1 || G->flow[a] == G->weight[a]))
            a++;
        G->next[u] = a;
        if (a < G->start[u + 1]) {
            G->path[length++] = a;
            u = G->arc[a];
        } else {
            G->distance[u] = -2;
            if (length == 0) return false;
            u = G->arc[G->reverse[G->path[--length]]];
        }
    }
    int32_t least = INT32_MAX;
    for (int32_t i = 0; i < length; i++) {
        const int32_t a = G->path[i], room = G->weight[a] - G->flow[a];
        if (room < least) least = room;
    }
    for (int32_t i = 0; i < length; i++) {
        const int32_t a = G->path[i];
        G->flow[a] += least;
        G->flow[G->reverse[a]] -= least;
    }
    return true;
}

static void min_cut(clusters *G) {
    memset(G->flow, 0, (size_t)G->arcs * sizeof *G->flow);
    while (layers(G)) {
        for (int32_t k = 0; k < G->n; k++) G->next[k] = G->start[k];
        for (int32_t k = 0; k < G->n; k++)
            while (G->side[k] == QC__SOURCE && G->distance[k] >= 0 && augment(G, k)) continue;
    }
    for (int32_t k = 0; k < G->n; k++) G->side[k] = G->distance[k] >= 0 ? QC__SINK : QC__SOURCE;
}

bool qc__bisect_clusters(const qc__cover *C, qc__cut_work *w) {
    clusters G;
    if (!build(C, w, &G)) return false;
    breadth_first(&G, 0, G.order);
    breadth_first(&G, G.order[G.n - 1], G.order);
    const int32_t fixed = (int32_t)(ALPHA * C->m);
    for (int32_t i = 0, sum = 0; i < G.n; i++) {
        const int32_t k = G.order[i];
        G.side[k] = sum < fixed ? QC__SOURCE : sum + G.size[k] > C->m - fixed ? QC__SINK : QC__FREE;
        sum += G.size[k];
    }
    min_cut(&G);
    for (int32_t e = 0; e < C->m; e++) w->side[e] = G.side[w->label[e]];
    return true;
}
