/* Bisection of the elements of a piece. */
#include "sdk/sparse/order/internal.h"
#include <string.h>
#ifndef ALPHA
#define ALPHA 0.30
#endif
#ifndef DIRECT
#define DIRECT 1000
#endif
#ifndef BAND
#define BAND 16
#endif

/* Breadth-first search through all components, the first from element `root`: elements in the
 * order of their discovery. */
static void breadth_first(const qc__cover *C, int32_t root, int32_t *distance, int32_t *queue) {
    int32_t queued = 0, next = 0;
    memset(distance, 255, (size_t)C->m * sizeof *distance);
    for (;;) {
        distance[root] = 0;
        queue[queued++] = root;
        for (int32_t k = queued - 1; k < queued; k++) {
            const int32_t u = queue[k], d = distance[u] + 1;
            for (int32_t p = C->element[u].begin; p < C->element[u].active; p++) {
                const qc__net net = C->net[C->entry[p]];
                for (int32_t q = net.begin; q < net.end; q++) {
                    const int32_t v = C->element_of[q];
                    const bool fresh = distance[v] == -1;
                    queue[queued] = v;
                    queued += fresh;
                    distance[v] = fresh ? d : distance[v];
                }
            }
        }
        if (queued == C->m) return;
        while (distance[next] != -1) next++;
        root = next;
    }
}

static void direct(const qc__cover *C, qc__cut_work *w) {
    const int32_t m = C->m;
    breadth_first(C, 0, w->distance, w->queue);
    breadth_first(C, w->queue[m - 1], w->distance, w->list);
    const int32_t fixed = (int32_t)(ALPHA * m) > 0 ? (int32_t)(ALPHA * m) : 1;
    for (int32_t k = 0; k < m; k++) w->side[w->list[k]] = k < fixed ? 0 : k >= m - fixed ? 1 : 2;
    qc__min_cut(C, w, m - 2 * fixed, w->list + fixed);
}

/* Frees the elements around the cut, nearest first, and cuts again. */
static void refine(const qc__cover *C, qc__cut_work *w) {
    int32_t size[2] = {0, 0}, queued = 0, *queue = w->list;
    for (int32_t e = 0; e < C->m; e++) size[w->side[e]]++;
    int32_t cut = 0;
    for (int32_t r = 0; r < C->n; r++) {
        const qc__net net = C->net[r];
        const uint8_t s = w->side[C->element_of[net.begin]];
        bool split = false;
        for (int32_t q = net.begin + 1; q < net.end; q++) split |= w->side[C->element_of[q]] != s;
        w->from[cut] = r;
        cut += split;
    }
    int32_t room[2] = {size[0] - C->m / 5, size[1] - C->m / 5};
    const int32_t limit = BAND * cut / 2;
    if (room[0] > limit) room[0] = limit;
    if (room[1] > limit) room[1] = limit;
    for (int32_t k = 0; k < cut; k++) {
        const qc__net net = C->net[w->from[k]];
        for (int32_t q = net.begin; q < net.end; q++) {
            const int32_t v = C->element_of[q];
            if (w->side[v] == QC__FREE || room[w->side[v]] <= 0) continue;
            room[w->side[v]]--;
            w->side[v] = QC__FREE;
            queue[queued++] = v;
        }
    }
    for (int32_t k = 0; k < queued; k++) {
        const int32_t u = queue[k];
        for (int32_t p = C->element[u].begin; p < C->element[u].active; p++) {
            const qc__net net = C->net[C->entry[p]];
            for (int32_t q = net.begin; q < net.end; q++) {
                const int32_t v = C->element_of[q];
                if (w->side[v] == QC__FREE || room[w->side[v]] <= 0) continue;
                room[w->side[v]]--;
                w->side[v] = QC__FREE;
                queue[queued++] = v;
            }
        }
    }
    qc__min_cut(C, w, queued, queue);
}

void qc__bisect(const qc__cover *C, qc__cut_work *w) {
    if (C->m < DIRECT || !qc__bisect_clusters(C, w))
        direct(C, w);
    else
        refine(C, w);
}
