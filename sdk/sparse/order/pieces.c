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

/* Copies the elements of one side, in the order given, to the place of *to; *after: the place
 * behind it. Rows of the separator go to the order from *separator on. */
static void copy_side(const qc__dissection *D, const qc__cover *C, const qc__cut_work *w, int side,
                      const int32_t *order, int32_t *separator, qc__piece *to, qc__piece *after) {
    const qc__cover B = qc__piece_view(D, to);
    const int32_t *row_side = w->flow;
    int32_t *number = w->flow + C->n; /* of the rows in the copy, or -1 */
    int32_t m = 0, n = 0, entry = 0, member = 0;
    for (int32_t k = 0; k < C->m; k++) {
        const int32_t e = order ? order[k] : k;
        if (w->side[e] != side) continue;
        const qc__element E = C->element[e];
        const int32_t begin = entry, end = begin + E.end - E.begin;
        int32_t halo = end;
        for (int32_t p = E.begin; p < E.active; p++) {
            const int32_t r = C->entry[p];
            const qc__net net = C->net[r];
            if (row_side[r] == QC__FREE) {
                if (number[r] == -1) D->perm[(*separator)++] = net.name;
                number[r] = 0;
                B.entry[--halo] = ~net.name;
                continue;
            }
            if (number[r] == -1) {
                B.net[n] = (qc__net){member, member, net.name};
                member += net.end - net.begin;
                number[r] = n++;
            }
            B.entry[entry++] = number[r];
            B.element_of[B.net[number[r]].end++] = m;
        }
        if (entry == begin) continue; /* no row is left */
        B.element[m++] = (qc__element){begin, entry, end, E.cluster};
        for (int32_t p = E.active, q = entry; p < E.end; p++) B.entry[q++] = C->entry[p];
        entry = end;
    }
    to->m = m;
    to->n = n;
    *after = *to;
    after->element += m;
    after->row += n;
    after->entry += entry;
    after->member += member;
}

void qc__piece_split(const qc__dissection *D, const qc__piece *P, const int32_t *order,
                     const int32_t size[3], qc__piece child[2]) {
    const qc__cover C = qc__piece_view(D, P);
    const qc__cut_work w = qc__piece_work(D, P);
    int32_t separator = P->row + P->n - size[QC__FREE];
    qc__piece after;
    memset(w.flow + P->n, 255, (size_t)P->n * sizeof *w.flow);
    child[0] = *P;
    child[0].buffer = !P->buffer;
    copy_side(D, &C, &w, 0, order, &separator, &child[0], &child[1]);
    copy_side(D, &C, &w, 1, order, &separator, &child[1], &after);
}
