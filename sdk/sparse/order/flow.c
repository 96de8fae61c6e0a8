/* Smallest set of rows which separates source elements from sink elements: maximum flow through
 * rows of capacity one by shortest augmenting paths (Dinic 1970).
 *
 * A row with flow a -> b may be entered from any element, to push the flow back to a, and from b
 * also to leave to any element: it is split into two nodes joined by an arc of capacity one. */
#include "sdk/sparse/order/internal.h"
#include <stdlib.h>
#include <string.h>

enum { SOURCE = QC__SOURCE, SINK = QC__SINK, FREE = QC__FREE };

typedef struct network {
    const qc__cover *C;
    qc__cut_work *w;
    int32_t border[2]; /* sources and sinks which share a row with other elements */
    int32_t *terminal[2];
    int32_t queued;
} network;

/* Sources from the front of w->border, sinks from its back. */
static void find_border(network *N, int32_t free_count, const int32_t *free_element) {
    const qc__cover *C = N->C;
    qc__cut_work *w = N->w;
    int32_t nsink = 0;
    N->terminal[0] = w->border;
    for (int32_t k = 0; k < free_count; k++) {
        const qc__element E = C->element[free_element[k]];
        for (int32_t p = E.begin; p < E.active; p++) {
            const qc__net net = C->net[C->entry[p]];
            for (int32_t q = net.begin; q < net.end; q++) {
                const int32_t v = C->element_of[q];
                if (w->side[v] == FREE || w->distance[v] != -1) continue;
                w->distance[v] = 0;
                if (w->side[v] == SOURCE)
                    w->border[N->border[0]++] = v;
                else
                    w->border[C->m - ++nsink] = v;
            }
        }
    }
    N->border[1] = nsink;
    N->terminal[1] = w->border + C->m - nsink;
    for (int s = 0; s < 2; s++)
        for (int32_t k = 0; k < N->border[s]; k++) w->distance[N->terminal[s][k]] = -1;
}

static inline void reach(network *N, int32_t e, int32_t d) {
    int32_t *distance = N->w->distance;
    const bool fresh = distance[e] == -1;
    N->w->queue[N->queued] = e;
    N->queued += fresh;
    distance[e] = fresh ? d : distance[e];
}

/* Distance to the sinks (own = SINK) in the residual network, up to the layer which holds the first
 * source; own = SOURCE: from the sources to the first sink. Returns whether they meet. */
static bool layers(network *N, uint8_t own) {
    const qc__cover *C = N->C;
    const uint8_t *side = N->w->side, goal = (uint8_t)(SOURCE + SINK - own);
    int32_t *distance = N->w->distance, *queue = N->w->queue, last = INT32_MAX;
    const int32_t *in = own == SINK ? N->w->to : N->w->from; /* the element a full row is left by */
    const int32_t *out = own == SINK ? N->w->from : N->w->to;
    for (int32_t k = 0; k < N->queued; k++) distance[queue[k]] = -1;
    N->queued = 0;
    for (int32_t k = 0; k < N->border[own]; k++) reach(N, N->terminal[own][k], 0);
    for (int32_t k = 0; k < N->queued; k++) {
        const int32_t u = queue[k], d = distance[u] + 1;
        if (d > last) break;
        if (side[u] == goal) {
            last = d - 1;
            break;
        }
        for (int32_t p = C->element[u].begin; p < C->element[u].active; p++) {
            const int32_t r = C->entry[p];
            if (in[r] != -1 && u != out[r]) {
                reach(N, in[r], d);
                continue;
            }
            for (int32_t q = C->net[r].begin; q < C->net[r].end; q++) {
                const int32_t v = C->element_of[q];
                if (side[v] != own) reach(N, v, d);
            }
        }
    }
    return last != INT32_MAX;
}

/* Flow along row r from u to v. */
static void push(network *N, int32_t r, int32_t u, int32_t v) {
    int32_t *from = N->w->from, *to = N->w->to;
    if (from[r] == -1) {
        from[r] = u;
        to[r] = v;
    } else if (to[r] == u) {
        to[r] = v;
    } else {
        from[r] = u;
    }
    if (from[r] == to[r]) from[r] = to[r] = -1;
}

/* Next element towards the sinks by row r, or -1. */
static int32_t step(const network *N, int32_t u, int32_t r) {
    const int32_t *distance = N->w->distance, d = distance[u] - 1;
    const int32_t a = N->w->from[r];
    if (a != -1 && N->w->to[r] != u) return distance[a] == d ? a : -1;
    for (int32_t q = N->C->net[r].begin; q < N->C->net[r].end; q++)
        if (distance[N->C->element_of[q]] == d) return N->C->element_of[q];
    return -1;
}

/* One path from source s by decreasing distance; w->next[e]: entry of e to try next. */
static bool augment(network *N, int32_t s) {
    const qc__cover *C = N->C;
    qc__cut_work *w = N->w;
    int32_t length = 0, u = s;
    while (w->side[u] != SINK) {
        int32_t v = -1;
        while (w->next[u] < C->element[u].active && v == -1) v = step(N, u, C->entry[w->next[u]++]);
        if (v != -1) {
            w->path[length++] = u;
            u = v;
        } else {
            w->distance[u] = -2; /* no way from here */
            if (length == 0) return false;
            u = w->path[--length];
        }
    }
    while (length > 0) {
        const int32_t v = u;
        u = w->path[--length];
        push(N, C->entry[w->next[u] - 1], u, v);
    }
    return true;
}

void qc__min_cut(const qc__cover *C, qc__cut_work *w, int32_t free_count,
                 const int32_t *free_element) {
    network N = {.C = C, .w = w};
    memset(w->distance, 255, (size_t)C->m * sizeof *w->distance);
    memset(w->from, 255, (size_t)C->n * sizeof *w->from);
    memset(w->to, 255, (size_t)C->n * sizeof *w->to);
    find_border(&N, free_count, free_element);
    while (layers(&N, SINK)) {
        for (int32_t k = 0; k < N.queued; k++) w->next[w->queue[k]] = C->element[w->queue[k]].begin;
        for (int32_t k = N.queued; k-- > 0;) {
            const int32_t s = w->queue[k];
            if (w->side[s] != SOURCE) continue;
            while (w->distance[s] >= 0 && augment(&N, s)) continue;
        }
    }
    /* Elements which no longer reach the sinks, or those which the sources no longer reach? The
     * cut which is better balanced. */
    int32_t fixed[2] = {0, 0}, behind = 0, ahead = 0;
    for (int32_t e = 0; e < C->m; e++) {
        fixed[0] += w->side[e] == SOURCE;
        fixed[1] += w->side[e] == SINK;
    }
    for (int32_t k = 0; k < free_count; k++) {
        const int32_t e = free_element[k];
        behind += w->distance[e] >= 0;
        w->next[e] = w->distance[e];
    }
    layers(&N, SOURCE);
    for (int32_t k = 0; k < free_count; k++) ahead += w->distance[free_element[k]] >= 0;
    const int32_t late = abs(fixed[0] + free_count - behind - (fixed[1] + behind)),
                  early = abs(fixed[0] + ahead - (fixed[1] + free_count - ahead));
    for (int32_t k = 0; k < free_count; k++) {
        const int32_t e = free_element[k];
        const bool sink = late <= early ? w->next[e] >= 0 : w->distance[e] < 0;
        w->side[e] = sink ? SINK : SOURCE;
    }
}
