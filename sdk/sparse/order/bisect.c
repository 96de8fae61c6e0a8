/* Bisection of the elements of a piece: by clusters and then refined, or directly. In both cases
 * the last step is a smallest cut with some elements free and the others fixed to their side. */
#include "sdk/sparse/order/internal.h"
#include <string.h>

enum { DIRECT = 500, BAND = 16 };

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
                for (int32_t q = net.begin + (C->element_of[net.begin] == u); q < net.end; q++) {
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

/* Smallest cut between the first and the last three tenths of a breadth-first order which begins
 * far out. */
static void direct(const qc__cover *C, qc__cut_work *w) {
    const int32_t m = C->m;
    breadth_first(C, 0, w->distance, w->queue);
    breadth_first(C, w->queue[m - 1], w->distance, w->list);
    const int32_t fixed = m < 4 ? 1 : (int32_t)(0.3 * m);
    for (int32_t k = 0; k < m; k++)
        w->side[w->list[k]] = k < fixed ? QC__SOURCE : k >= m - fixed ? QC__SINK : QC__FREE;
    qc__min_cut(C, w, m - 2 * fixed, w->list + fixed);
}

/* Rows with elements on both sides. */
static int32_t find_cut(const qc__cover *C, const uint8_t *side, int32_t *row) {
    int32_t count = 0;
    for (int32_t r = 0; r < C->n; r++) {
        const qc__net net = C->net[r];
        bool split = false;
        for (int32_t q = net.begin + 1; q < net.end; q++)
            split |= side[C->element_of[q]] != side[C->element_of[net.begin]];
        row[count] = r;
        count += split;
    }
    return count;
}

/* Frees the elements of row r while its sides may lose some. Returns the new length of list. */
static int32_t set_free(const qc__cover *C, int32_t r, uint8_t *side, int32_t room[2],
                        int32_t *list, int32_t count) {
    for (int32_t q = C->net[r].begin; q < C->net[r].end; q++) {
        const int32_t e = C->element_of[q];
        if (side[e] == QC__FREE || room[side[e]] <= 0) continue;
        room[side[e]]--;
        side[e] = QC__FREE;
        list[count++] = e;
    }
    return count;
}

/* Smallest cut near the given one: as many elements are free, nearest first, as make a band which
 * is a fixed number of elements wide, as long as either side keeps a fifth. */
static void refine(const qc__cover *C, qc__cut_work *w) {
    int32_t room[2] = {-(C->m / 5), -(C->m / 5)}, count = 0;
    for (int32_t e = 0; e < C->m; e++) room[w->side[e]]++;
    const int32_t cut = find_cut(C, w->side, w->flow), limit = BAND / 2 * cut;
    for (int s = 0; s < 2; s++)
        if (room[s] > limit) room[s] = limit;
    for (int32_t k = 0; k < cut; k++)
        count = set_free(C, w->flow[k], w->side, room, w->list, count);
    for (int32_t k = 0; k < count; k++) {
        const qc__element E = C->element[w->list[k]];
        for (int32_t p = E.begin; p < E.active; p++)
            count = set_free(C, C->entry[p], w->side, room, w->list, count);
    }
    qc__min_cut(C, w, count, w->list);
}

void qc__bisect(const qc__cover *C, const int16_t *center, qc__cut_work *w) {
    if (C->m < DIRECT || !qc__bisect_clusters(C, center, w))
        direct(C, w);
    else
        refine(C, w);
}
