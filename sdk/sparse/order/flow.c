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
    int32_t *terminal[2], count[2]; /* sources and sinks which share a row with free elements */
    int32_t queued;
} network;

enum { UNSEEN = -1, DEAD = -2, FIXED = -3 };

/* Sources from the front of w->border, sinks from its back; distance of all elements. */
static void find_terminals(network *N, int32_t count, const int32_t *element) {
    const qc__cover *C = N->C;
    qc__cut_work *w = N->w;
    int32_t border[2] = {0, 0};
    for (int32_t e = 0; e < C->m; e++) w->distance[e] = FIXED;
    for (int32_t k = 0; k < count; k++) w->distance[element[k]] = UNSEEN;
    for (int32_t k = 0; k < count; k++) {
        const qc__element E = C->element[element[k]];
        for (int32_t p = E.begin; p < E.active; p++) {
            const qc__net net = C->net[C->entry[p]];
            for (int32_t q = net.begin; q < net.end; q++) {
                const int32_t v = C->element_of[q];
                if (w->distance[v] != FIXED) continue;
                w->distance[v] = UNSEEN;
                w->border[w->side[v] == SOURCE ? border[0]++ : C->m - ++border[1]] = v;
            }
        }
    }
    for (int s = 0; s < 2; s++) {
        N->count[s] = border[s];
        N->terminal[s] = s == SOURCE ? w->border : w->border + C->m - border[1];
    }
}

static inline void reach(network *N, int32_t e, int32_t d) {
    int32_t *distance = N->w->distance;
    const bool unseen = distance[e] == UNSEEN;
    N->w->queue[N->queued] = e;
    N->queued += unseen;
    distance[e] = unseen ? d : distance[e];
}

/* Distance to the sinks (own = SINK) in the residual network up to the first source; own = SOURCE:
 * from the sources to the first sink. Returns whether they meet. */
static bool layers(network *N, int own) {
    const qc__cover *C = N->C;
    const int32_t *flow = N->w->flow;
    int32_t *distance = N->w->distance, *queue = N->w->queue;
    for (int32_t k = 0; k < N->queued; k++) distance[queue[k]] = UNSEEN;
    N->queued = 0;
    bool meet = false;
    for (int32_t k = 0; k < N->count[own]; k++) reach(N, N->terminal[own][k], 0);
    for (int32_t k = 0; k < N->queued; k++) {
        const int32_t u = queue[k], d = distance[u] + 1;
        if (N->w->side[u] == !own) {
            meet = true;
            continue;
        }
        for (int32_t p = C->element[u].begin; p < C->element[u].active; p++) {
            const int32_t r = C->entry[p], in = flow[2 * r + own], out = flow[2 * r + !own];
            if (in != -1 && u != out) { /* a full row only takes flow back */
                reach(N, in, d);
                continue;
            }
            const qc__net net = C->net[r];
            if (net.end - net.begin == 2) {
                const int32_t a = C->element_of[net.begin], b = C->element_of[net.begin + 1];
                reach(N, u == a ? b : a, d);
                continue;
            }
            for (int32_t q = net.begin; q < net.end; q++) reach(N, C->element_of[q], d);
        }
    }
    return meet;
}

/* Flow along row r from u to v. */
static void push(network *N, int32_t r, int32_t u, int32_t v) {
    int32_t *flow = N->w->flow + 2 * r;
    if (flow[0] == -1) {
        flow[0] = u;
        flow[1] = v;
    } else {
        flow[flow[1] == u] = flow[1] == u ? v : u;
    }
    if (flow[0] == flow[1]) flow[0] = flow[1] = -1;
}

/* Next element towards the sinks by row r, or -1. */
static int32_t step(const network *N, int32_t u, int32_t r) {
    const int32_t *distance = N->w->distance, d = distance[u] - 1;
    const int32_t a = N->w->flow[2 * r];
    if (a != -1 && N->w->flow[2 * r + 1] != u) return distance[a] == d ? a : -1;
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
            w->distance[u] = DEAD; /* no way from here */
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

static int32_t count_side(const qc__cover *C, const uint8_t *side, uint8_t which) {
    int32_t count = 0;
    for (int32_t e = 0; e < C->m; e++) count += side[e] == which;
    return count;
}

void qc__min_cut(const qc__cover *C, qc__cut_work *w, int32_t count, const int32_t *element) {
    network N = {.C = C, .w = w};
    memset(w->flow, 255, 2 * (size_t)C->n * sizeof *w->flow);
    find_terminals(&N, count, element);
    while (layers(&N, SINK)) {
        for (int32_t k = 0; k < N.queued; k++) w->next[w->queue[k]] = C->element[w->queue[k]].begin;
        for (int32_t k = 0; k < N.count[SOURCE]; k++) {
            const int32_t s = N.terminal[SOURCE][k];
            while (w->distance[s] >= 0 && augment(&N, s)) continue;
        }
    }
    /* Two smallest cuts: around what still reaches the sinks, and around what the sources still
     * reach. The better balanced one is taken. */
    const int32_t sources = count_side(C, w->side, SOURCE), sinks = C->m - count - sources;
    int32_t *late = w->next, behind = 0, ahead = 0;
    for (int32_t k = 0; k < count; k++) {
        late[k] = w->distance[element[k]] >= 0;
        behind += late[k];
    }
    layers(&N, SOURCE);
    for (int32_t k = 0; k < count; k++) ahead += w->distance[element[k]] >= 0;
    const bool take_late = abs(sources + count - behind - (sinks + behind)) <=
                           abs(sources + ahead - (sinks + count - ahead));
    for (int32_t k = 0; k < count; k++) {
        const bool sink = take_late ? late[k] : w->distance[element[k]] < 0;
        w->side[element[k]] = sink ? SINK : SOURCE;
    }
}
