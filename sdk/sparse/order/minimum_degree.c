/* Exact minimum degree (Rose 1972; with a halo: Pellegrini, Roman, Amestoy 2000) on pieces so small
 * that a row of the elimination graph is a few machine words. */
#include "sdk/sparse/order/internal.h"
#include <string.h>

enum { WORDS = QC__SMALL_PIECE / 32, HALO = 64 * WORDS - QC__SMALL_PIECE, SLOTS = 4 * HALO };

typedef struct graph {
    int32_t n, words;
    uint64_t row[QC__SMALL_PIECE][WORDS];
    int16_t degree[QC__SMALL_PIECE];
    int16_t next[QC__SMALL_PIECE], previous[QC__SMALL_PIECE], head[64 * WORDS + 1];
} graph;

static void set_bit(uint64_t *set, int32_t i) {
    set[i >> 6] |= (uint64_t)1 << (i & 63);
}

/* Number of the separator row among the first HALO ones met, or -1. */
static int32_t halo_index(int32_t *slot, int32_t *index, int32_t row, int32_t *count) {
    uint32_t at = (uint32_t)row * 2654435769u >> 16;
    for (;; at++) {
        at %= SLOTS;
        if (slot[at] == row) return index[at];
        if (slot[at] == -1) break;
    }
    if (*count == HALO) return -1;
    slot[at] = row;
    return index[at] = (*count)++;
}

static void build(const qc__cover *C, graph *G) {
    int32_t slot[SLOTS], index[SLOTS], halo = 0;
    memset(slot, 255, sizeof slot);
    G->n = C->n;
    memset(G->row, 0, (size_t)C->n * sizeof G->row[0]);
    for (int32_t e = 0; e < C->m; e++) {
        const qc__element E = C->element[e];
        uint64_t clique[WORDS] = {0};
        for (int32_t p = E.begin; p < E.active; p++) set_bit(clique, C->entry[p]);
        for (int32_t p = E.active; p < E.end; p++) {
            const int32_t i = halo_index(slot, index, ~C->entry[p], &halo);
            if (i >= 0) set_bit(clique, C->n + i);
        }
        for (int32_t p = E.begin; p < E.active; p++)
            for (int k = 0; k < WORDS; k++) G->row[C->entry[p]][k] |= clique[k];
    }
    G->words = (C->n + halo + 63) / 64;
    for (int32_t i = 0; i < C->n; i++) set_bit(G->row[i], i);
}

static void unlink_row(graph *G, int32_t i) {
    if (G->previous[i] >= 0)
        G->next[G->previous[i]] = G->next[i];
    else
        G->head[G->degree[i]] = G->next[i];
    if (G->next[i] >= 0) G->previous[G->next[i]] = G->previous[i];
}

static int32_t bit_count(uint64_t x) {
    x -= x >> 1 & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (int32_t)(x * 0x0101010101010101u >> 56);
}

static void link_row(graph *G, int32_t i) {
    int32_t degree = 0;
    for (int k = 0; k < G->words; k++) degree += bit_count(G->row[i][k]);
    G->degree[i] = (int16_t)degree;
    G->previous[i] = -1;
    G->next[i] = G->head[degree];
    if (G->head[degree] >= 0) G->previous[G->head[degree]] = (int16_t)i;
    G->head[degree] = (int16_t)i;
}

/* The neighbours of the pivot become a clique. Returns the least degree among them. */
static int32_t eliminate(graph *G, int32_t pivot) {
    const uint64_t *row = G->row[pivot];
    int32_t least = 64 * WORDS;
    unlink_row(G, pivot);
    for (int32_t word = 0; word * 64 < G->n; word++)
        for (uint64_t left = row[word]; left; left &= left - 1) {
            const int32_t i = 64 * word + bit_count((left & (~left + 1)) - 1);
            if (i >= G->n) break;
            if (i == pivot) continue;
            unlink_row(G, i);
            for (int k = 0; k < G->words; k++) G->row[i][k] |= row[k];
            G->row[i][pivot >> 6] &= ~((uint64_t)1 << (pivot & 63));
            link_row(G, i);
            if (G->degree[i] < least) least = G->degree[i];
        }
    return least;
}

void qc__minimum_degree(const qc__cover *C, int32_t *order) {
    graph G;
    build(C, &G);
    memset(G.head, 255, sizeof G.head);
    for (int32_t i = C->n; i-- > 0;) link_row(&G, i);
    for (int32_t k = 0, least = 0; k < C->n; k++) {
        while (G.head[least] < 0) least++;
        const int32_t pivot = G.head[least], changed = eliminate(&G, pivot);
        order[k] = C->net[pivot].name;
        if (changed < least) least = changed;
    }
}
