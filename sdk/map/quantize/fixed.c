/* Which vertices of an exact map have to stay in its coarse complex. */
#include "sdk/map/quantize/decimate.h"

/* Axis directions in the sector of spoke h. */
static int directions(const qc__triangulation *T, int32_t h, bool closed) {
    int n = 0;
    for (int d = 0; d < 4; d++)
        n += qc__in_sector(T->vector[h], qc__turn_point(T->vector[qc_prev(h)], 2), closed, d);
    return n;
}

typedef struct surroundings {
    int features, directions; /* in all, the last sector of a boundary being closed */
    bool boundary, aligned;   /* a free boundary is not aligned */
    bool straight;            /* two quarter turns on each side of features */
} surroundings;

/* Starts with a feature where there is one: its sides are half-open and hold 2 directions each, of
 * which the last one of a boundary is closed and holds 3. */
static surroundings look_around(const qc__triangulation *T, int32_t v) {
    surroundings s = {.straight = true};
    int32_t start = qc__first_spoke(T, v);
    s.boundary = T->twin[start] < 0;
    s.aligned = T->axis[start] >= 0;
    for (int32_t h = start; !s.boundary && T->axis[start] < 0; start = h) {
        h = qc__spoke_ccw(T, start);
        if (h == qc__first_spoke(T, v)) break;
    }
    int side = 0;
    int32_t h = start;
    do {
        const int32_t last = qc_prev(h), next = qc__spoke_ccw(T, h);
        s.features += T->axis[h] >= 0;
        const int n = directions(T, h, next < 0);
        side += n;
        s.directions += n;
        if (next < 0) {
            s.features += T->axis[last] >= 0;
            s.aligned &= T->axis[last] >= 0;
            s.straight &= side == 3;
        } else if (T->axis[next] >= 0) {
            s.straight &= side == 2;
            side = 0;
        }
        h = next;
    } while (h >= 0 && h != start);
    return s;
}

qc_status qc__find_fixed(const qc__triangulation *T, const uint8_t *point, uint8_t *fixed) {
    for (int32_t v = 0; v < T->mesh->n_vertices; v++) {
        const surroundings s = look_around(T, v);
        fixed[v] = point[v] || (s.boundary && !s.aligned) ||
                   (s.features > 0 && !(s.features == 2 && s.straight));
        if (fixed[v] || s.boundary || s.directions == 4) continue;
        return qc__fail(T->ctx, QC_ERR_FAILED, v,
                        "the map makes %d quarter turns around vertex %d, which is no cone",
                        s.directions, (int)v);
    }
    return QC_OK;
}
