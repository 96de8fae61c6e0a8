/* Removing a vertex of an intrinsic triangulation (docs/theory/quantization.md, Q.6). */
#include "sdk/map/quantize/decimate.h"

/* Spokes of v; *loops = those which end at v as well, *features = how many are features. */
static int32_t count_spokes(const qc__triangulation *T, int32_t v, int32_t *loops,
                            int32_t *features) {
    const int32_t start = qc__first_spoke(T, v);
    int32_t n = 0, h = start;
    *loops = *features = 0;
    do {
        const int32_t last = qc_prev(h); /* comes in, the end of the fan on a boundary */
        *loops += T->origin[qc_next(h)] == v;
        *features += T->axis[h] >= 0;
        n++;
        h = qc__spoke_ccw(T, h);
        if (h < 0) {
            *loops += T->origin[last] == v;
            *features += T->axis[last] >= 0;
            n++;
        }
    } while (h >= 0 && h != start);
    return n;
}

/* Ends at v which a flip of spoke h takes away. */
static int32_t gain(const qc__triangulation *T, int32_t v, int32_t h) {
    const int32_t across = T->origin[qc_prev(T->twin[h])];
    return 1 + (T->origin[qc_next(h)] == v) - (T->origin[qc_prev(h)] == v) - (across == v);
}

/* Flips away one of the n spokes which start with h, of which `loops` end at v, too; halfedge *kept
 * may get another number. It leaves a flat triangle only where no loop is left. false: none can be.
 */
static bool flip_spoke(qc__triangulation *T, int32_t v, int32_t h, int32_t n, int32_t loops,
                       bool flat, int32_t *kept) {
    for (int32_t i = 0; i < n && h >= 0; i++, h = qc__spoke_ccw(T, h)) {
        const bool may_be_flat = flat && (loops == 0 || (loops == 2 && T->origin[qc_next(h)] == v));
        if (!qc__can_flip(T, h, may_be_flat) || gain(T, v, h) <= 0) continue;
        const int32_t g = T->twin[h], before = *kept;
        if (before == qc_next(g)) *kept = h;
        if (before == qc_next(h)) *kept = g;
        qc__flip(T, h);
        return true;
    }
    return false;
}

/* (Q.6): a star with more than three triangles has an ear which v is not inside of. The triangle
 * which an ear leaves at v may be flat, as the merge takes it away. */
static bool remove_inner(qc__triangulation *T, int32_t v) {
    for (;;) {
        int32_t loops, features;
        const int32_t n = count_spokes(T, v, &loops, &features);
        if (n == 3 && loops == 0) break;
        int32_t none = -1;
        if (n < 3 || !flip_spoke(T, v, T->spoke[v], n, loops, true, &none)) return false;
    }
    const int32_t a = T->spoke[v], b = qc__spoke_ccw(T, a), c = qc__spoke_ccw(T, b);
    if (a / 3 == b / 3 || b / 3 == c / 3 || c / 3 == a / 3) return false;
    qc__merge_star(T, a);
    return true;
}

/* Inner spokes of v between feature halfedge `out`, which starts there, and the next one. */
static int32_t count_side(const qc__triangulation *T, int32_t out) {
    int32_t n = 0;
    for (int32_t h = qc__spoke_ccw(T, out); h >= 0 && T->axis[h] < 0; h = qc__spoke_ccw(T, h)) n++;
    return n;
}

/* (Q.6) on the side on the left of *out. */
static bool clear_side(qc__triangulation *T, int32_t v, int32_t *out) {
    for (int32_t n = count_side(T, *out); n != 1; n = count_side(T, *out))
        if (n < 1 || !flip_spoke(T, v, qc__spoke_ccw(T, *out), n, 0, false, out)) return false;
    return true;
}

/* The second feature halfedge which starts at v, counter-clockwise from the first; -1 = it comes in
 * along the boundary. */
static int32_t next_feature(const qc__triangulation *T, int32_t out) {
    int32_t h = qc__spoke_ccw(T, out);
    while (h >= 0 && T->axis[h] < 0) h = qc__spoke_ccw(T, h);
    return h;
}

static bool remove_from_line(qc__triangulation *T, int32_t v) {
    int32_t out = qc__first_spoke(T, v);
    while (T->axis[out] < 0) out = qc__spoke_ccw(T, out);
    const bool boundary = T->twin[out] < 0;
    if (!clear_side(T, v, &out)) return false;
    int32_t second = boundary ? -1 : next_feature(T, out);
    if (!boundary && (second == out || !clear_side(T, v, &second))) return false;
    /* in -> v -> out on the left of out: from the triangle of the inner spoke to that of out */
    const int32_t spoke = qc__spoke_ccw(T, out), in = qc_prev(spoke);
    if (spoke / 3 == out / 3 || in == out || T->axis[in] < 0) return false;
    if (!boundary) {
        const int32_t far = qc__spoke_ccw(T, second);
        const int32_t t[4] = {out / 3, spoke / 3, second / 3, far / 3};
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < i; j++)
                if (t[i] == t[j]) return false;
    }
    qc__merge_line(T, in);
    return true;
}

bool qc__remove_vertex(qc__triangulation *T, int32_t v) {
    int32_t loops, features;
    count_spokes(T, v, &loops, &features);
    if (features == 0) return remove_inner(T, v);
    return features == 2 && remove_from_line(T, v);
}
