/* The pieces of a dissection in two buffers, between which they are copied when they are split:
 * memory is linear, nothing is allocated on the way down, and neighbours stay close. */
#include "sdk/sparse/order/internal.h"
#include <string.h>

qc__cover qc__piece_view(const qc__dissection *D, const qc__piece *P) {
    const qc__cover *B = &D->buffer[P->buffer];
    return (qc__cover){P->m,
                       P->n,
                       B->element + P->element,
                       B->net + P->row,
                       B->entry + P->entry,
                       B->element_of + P->member};
}

qc__cut_work qc__piece_work(const qc__dissection *D, const qc__piece *P) {
    const qc__cut_work *w = &D->work;
    const int64_t e = P->element;
    return (qc__cut_work){.distance = w->distance + e,
                          .border = w->border + e,
                          .next = w->next + e,
                          .path = w->path + e,
                          .label = w->label + e,
                          .queue = w->queue + 2 * e,
                          .list = w->list + 2 * e,
                          .heap = w->heap + 2 * (e + P->entry),
                          .flow = w->flow + 2 * (int64_t)P->row,
                          .side = w->side + e};
}

void qc__row_sides(const qc__cover *C, qc__cut_work *w, int32_t size[3]) {
    size[0] = size[1] = size[2] = 0;
    for (int32_t r = 0; r < C->n; r++) {
        const qc__net net = C->net[r];
        int32_t side = w->side[C->element_of[net.begin]];
        for (int32_t q = net.begin + 1; q < net.end; q++)
            if (w->side[C->element_of[q]] != side) side = QC__FREE;
        w->flow[r] = side;
        size[side]++;
    }
}

typedef struct copying {
    const qc__dissection *D;
    qc__cover from, to;
    int32_t *row_side, *number; /* rows of `from`: side, number in `to` or -1 */
    int32_t entry, member;      /* written so far */
    int32_t separator;          /* next place in the order */
} copying;

/* The number of row r in the copy, given at the first time. */
static int32_t number_row(copying *c, int32_t r) {
    if (c->number[r] == -1) {
        const qc__net net = c->from.net[r];
        c->to.net[c->to.n] = (qc__net){c->member, c->member, net.name};
        c->member += net.end - net.begin;
        c->number[r] = c->to.n++;
    }
    return c->number[r];
}

static void copy_element(copying *c, int32_t e) {
    const qc__element E = c->from.element[e];
    int32_t active = c->entry, last = c->entry + E.end - E.begin;
    for (int32_t p = E.begin; p < E.active; p++) {
        const int32_t r = c->from.entry[p];
        if (c->row_side[r] == QC__FREE) {
            c->to.entry[--last] = ~c->from.net[r].name;
            if (c->number[r] == -1) c->D->perm[c->separator++] = c->from.net[r].name;
            c->number[r] = 0;
        } else {
            const int32_t k = number_row(c, r);
            c->to.entry[active++] = k;
            c->to.element_of[c->to.net[k].end++] = c->to.m;
        }
    }
    if (active == c->entry) return; /* no row is left */
    memcpy(c->to.entry + active, c->from.entry + E.active,
           (size_t)(E.end - E.active) * sizeof *c->to.entry);
    c->to.element[c->to.m++] =
        (qc__element){c->entry, active, c->entry + E.end - E.begin, E.cluster};
    c->entry += E.end - E.begin;
}

void qc__piece_split(const qc__dissection *D, const qc__piece *P, const int32_t *order,
                     const int32_t size[3], qc__piece child[2]) {
    const qc__cut_work w = qc__piece_work(D, P);
    copying c = {.D = D,
                 .from = qc__piece_view(D, P),
                 .row_side = w.flow,
                 .number = w.flow + P->n,
                 .separator = P->row + P->n - size[QC__FREE]};
    qc__piece at = *P;
    at.buffer = !P->buffer;
    memset(c.number, 255, (size_t)P->n * sizeof *c.number);
    for (int s = 0; s < 2; s++) {
        at.m = at.n = 0;
        c.to = qc__piece_view(D, &at);
        c.entry = c.member = 0;
        for (int32_t k = 0; k < P->m; k++) {
            const int32_t e = order ? order[k] : k;
            if (w.side[e] == s) copy_element(&c, e);
        }
        at.m = c.to.m;
        at.n = c.to.n;
        child[s] = at;
        at.element += at.m;
        at.row += at.n;
        at.entry += c.entry;
        at.member += c.member;
    }
}
