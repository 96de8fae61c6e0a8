/* Maximum flow in a weighted graph by shortest augmenting paths (Dinic 1970), from the nodes of
 * side QC__SOURCE to those of side QC__SINK. An arc and its reverse carry opposite flow. */
#include "sdk/sparse/order/internal.h"

/* Distance of the nodes to the sinks by arcs which are not full, -1: none; whether a source has
 * one. */
static bool layers(qc__graph *G) {
    int32_t queued = 0;
    bool found = false;
    for (int32_t k = 0; k < G->n; k++) {
        const bool sink = G->side[k] == QC__SINK;
        G->distance[k] = sink ? 0 : -1;
        G->queue[queued] = k;
        queued += sink;
    }
    for (int32_t i = 0; i < queued; i++) {
        const int32_t u = G->queue[i];
        if (G->side[u] == QC__SOURCE) {
            found = true;
            continue;
        }
        for (int32_t a = G->start[u]; a < G->start[u + 1]; a++) {
            const int32_t v = G->arc[a];
            if (G->distance[v] != -1 || G->flow[a] == -G->weight[a]) continue;
            G->distance[v] = G->distance[u] + 1;
            G->queue[queued++] = v;
        }
    }
    return found;
}

static int32_t open_arc(const qc__graph *G, int32_t u) {
    int32_t a = G->next[u];
    while (a < G->start[u + 1] &&
           (G->distance[G->arc[a]] != G->distance[u] - 1 || G->flow[a] == G->weight[a]))
        a++;
    return G->next[u] = a;
}

static bool augment(qc__graph *G, int32_t s) {
    int32_t length = 0, u = s, least = INT32_MAX;
    while (G->side[u] != QC__SINK) {
        const int32_t a = open_arc(G, u);
        if (a < G->start[u + 1]) {
            G->path[length++] = a;
            u = G->arc[a];
        } else {
            G->distance[u] = -2; /* no way from here */
            if (length == 0) return false;
            u = G->arc[G->reverse[G->path[--length]]];
        }
    }
    for (int32_t i = 0; i < length; i++) {
        const int32_t a = G->path[i], room = G->weight[a] - G->flow[a];
        if (room < least) least = room;
    }
    for (int32_t i = 0; i < length; i++) {
        G->flow[G->path[i]] += least;
        G->flow[G->reverse[G->path[i]]] -= least;
    }
    G->value += least;
    return true;
}

void qc__graph_flow(qc__graph *G) {
    while (layers(G)) {
        for (int32_t k = 0; k < G->n; k++) G->next[k] = G->start[k];
        for (int32_t k = 0; k < G->n; k++)
            while (G->side[k] == QC__SOURCE && G->distance[k] >= 0 && augment(G, k)) continue;
    }
}
