/* A first bisection on clusters of elements. On the coarsest graph it is a smallest cut between the
 * two ends of a linear order (Schild, Sommer 2015), the best compromise between size and balance
 * among several; on finer ones the smallest cut near the one found. */
#include "sdk/sparse/order/internal.h"
#include <string.h>

enum { COARSEST = 600, BAND = 4, STEPS = 6, ENDS = 4, THOROUGH = 3000 };

/* Nodes in the order of their discovery from `root`, component after component. */
static void breadth_first(const qc__graph *G, int32_t root) {
    int32_t queued = 0, next = 0;
    memset(G->distance, 255, (size_t)G->n * sizeof *G->distance);
    for (;; root = next) {
        G->distance[root] = 0;
        G->order[queued++] = root;
        for (int32_t i = queued - 1; i < queued; i++) {
            const int32_t u = G->order[i];
            for (int32_t a = G->start[u]; a < G->start[u + 1]; a++) {
                const int32_t v = G->arc[a];
                if (G->distance[v] != -1) continue;
                G->distance[v] = G->distance[u] + 1;
                G->order[queued++] = v;
            }
        }
        if (queued == G->n) return;
        while (G->distance[next] != -1) next++;
    }
}

/* Keeps the present cut if it is better (O.3). */
static void consider(qc__graph *G, double m, double *least) {
    double size[2] = {0, 0};
    for (int32_t k = 0; k < G->n; k++) size[G->distance[k] >= 0] += G->size[k];
    const double cut = (double)G->value,
                 cost = cut * cut + 6 * (size[0] * size[0] + size[1] * size[1]) / m;
    if (cost >= *least) return;
    *least = cost;
    for (int32_t k = 0; k < G->n; k++) G->best[k] = G->distance[k] >= 0 ? QC__SINK : QC__SOURCE;
}

/* Smallest cuts between the first and the last nodes of G->order, more and more of them: growing
 * terminals leave a flow valid. */
static void cut_ends(qc__graph *G, int32_t m, double *least) {
    memset(G->flow, 0, (size_t)G->arcs * sizeof *G->flow);
    G->value = 0;
    for (int t = 1; t <= STEPS; t += m > THOROUGH ? 1 : 2) {
        const int32_t fixed = (int32_t)((0.15 + 0.05 * t) * m);
        for (int32_t i = 0, sum = 0; i < G->n; i++) {
            const int32_t k = G->order[i];
            const bool last = sum + G->size[k] > m - fixed;
            G->side[k] = sum < fixed ? QC__SOURCE : last ? QC__SINK : QC__FREE;
            sum += G->size[k];
        }
        qc__graph_flow(G);
        consider(G, m, least);
    }
}

/* Nodes by their coordinate; stable. */
static void sort_along(qc__graph *G, int axis) {
    int32_t count[QC__PLACES + 1] = {0}; /* of the coordinates below */
    for (int32_t k = 0; k < G->n; k++) count[G->center[3 * k + axis] + 1]++;
    for (int32_t c = 0; c < QC__PLACES; c++) count[c + 1] += count[c];
    for (int32_t k = 0; k < G->n; k++) G->order[count[G->center[3 * k + axis]]++] = k;
}

/* Orders: along the axes, and by the distance from ends which are far from each other. */
static void cut_coarsest(qc__graph *G, int32_t m) {
    double least = INFINITY;
    for (int axis = 0; axis < 3 && G->center; axis++) {
        sort_along(G, axis);
        cut_ends(G, m, &least);
    }
    breadth_first(G, 0);
    int32_t end = G->order[G->n - 1], *nearest = G->nearest;
    for (int t = 0; t < (m > THOROUGH ? ENDS : 1); t++) {
        breadth_first(G, end);
        end = 0;
        for (int32_t k = 0; k < G->n; k++) {
            if (t == 0 || G->distance[k] < nearest[k]) nearest[k] = G->distance[k];
            if (nearest[k] > nearest[end]) end = k;
        }
        if (t != 1)
            cut_ends(G, m, &least); /* the second end gives the first one's order reversed */
    }
}

/* Frees node v unless its side would become too small. */
static void set_free(qc__graph *G, int32_t v, int32_t room[2], int32_t *count) {
    if (G->best[v] == QC__FREE || room[G->best[v]] < G->size[v]) return;
    room[G->best[v]] -= G->size[v];
    G->best[v] = QC__FREE;
    G->order[(*count)++] = v;
}

/* Nodes at the cut, into G->queue. */
static int32_t find_border(const qc__graph *G) {
    int32_t count = 0;
    for (int32_t k = 0; k < G->n; k++) {
        bool split = false;
        for (int32_t a = G->start[k]; a < G->start[k + 1]; a++)
            split |= G->best[G->arc[a]] != G->best[k];
        G->queue[count] = k;
        count += split;
    }
    return count;
}

/* best: a cut; becomes the smallest one among those near it. */
static void cut_near(qc__graph *G, int32_t m) {
    int32_t size[2] = {0, 0}, count = 0;
    for (int32_t k = 0; k < G->n; k++) size[G->best[k]] += G->size[k];
    const int32_t border = find_border(G), limit = (int32_t)((double)BAND * border * m / G->n);
    int32_t room[2] = {size[0] - m / 5, size[1] - m / 5};
    for (int s = 0; s < 2; s++)
        if (room[s] > limit) room[s] = limit;
    for (int32_t i = 0; i < border; i++) set_free(G, G->queue[i], room, &count);
    for (int32_t i = 0; i < count; i++)
        for (int32_t a = G->start[G->order[i]]; a < G->start[G->order[i] + 1]; a++)
            set_free(G, G->arc[a], room, &count);
    memcpy(G->side, G->best, (size_t)G->n);
    memset(G->flow, 0, (size_t)G->arcs * sizeof *G->flow);
    G->value = 0;
    qc__graph_flow(G);
    for (int32_t k = 0; k < G->n; k++) G->best[k] = G->distance[k] >= 0 ? QC__SINK : QC__SOURCE;
}

static void bisect(qc__graph *G, int32_t m, qc__heap heap) {
    qc__graph H;
    int32_t *of = G->path; /* free until the coarser graph is cut */
    if (G->n > COARSEST && qc__graph_coarsen(G, &heap, of, &H)) {
        bisect(&H, m, heap);
        for (int32_t k = 0; k < G->n; k++) G->best[k] = H.best[of[k]];
        cut_near(G, m);
    } else {
        cut_coarsest(G, m);
    }
}

bool qc__bisect_clusters(const qc__cover *C, const int16_t *center, qc__cut_work *w) {
    qc__heap heap = {w->heap, 2 * ((int64_t)C->element[C->m - 1].end + C->m)};
    qc__graph G;
    if (!qc__graph_of_clusters(C, center, &heap, w->label, &G)) return false;
    bisect(&G, C->m, heap);
    for (int32_t e = 0; e < C->m; e++) w->side[e] = G.best[w->label[e]];
    return true;
}
