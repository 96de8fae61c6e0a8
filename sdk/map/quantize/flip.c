/* Flips and merges of an intrinsic triangulation (see triangulation.h). All triangles concerned are
 * brought to one chart first; markers are taken out relative to one corner and put back. */
#include "sdk/map/quantize/triangulation.h"

/* --- charts and markers ----------------------------------------------------------------------- */

/* Multiplies the chart of triangle t by i^q. */
static void turn_triangle(qc__triangulation *T, int32_t t, int q) {
    if ((q & 3) == 0) return;
    for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
        const int32_t g = T->twin[h];
        T->vector[h] = qc__turn_point(T->vector[h], q);
        if (T->image) T->image[h] = qc__turn_point(T->image[h], q);
        if (T->axis[h] >= 0) T->axis[h] = (int8_t)((T->axis[h] + q) & 3);
        if (g < 0 || g / 3 == t) continue;
        T->rotation[h] = (int8_t)((T->rotation[h] - q) & 3);
        T->rotation[g] = (int8_t)((T->rotation[g] + q) & 3);
    }
    for (int32_t f = T->first_marker[t]; f >= 0; f = T->next_marker[f]) {
        T->place[f] = qc__turn_point(T->place[f], q);
        T->turn[f] = (int8_t)((T->turn[f] + q) & 3);
    }
}

/* Gives the triangle beyond h the chart of that of h. */
static void share_chart(qc__triangulation *T, int32_t h) {
    turn_triangle(T, T->twin[h] / 3, 4 - T->rotation[h]);
}

/* Moves the markers of triangle t to a list, their places taken from the origin of halfedge h plus
 * `shift`. */
static void take_markers(qc__triangulation *T, int32_t h, qc__point shift, int32_t *list) {
    const qc__point base = qc__minus(shift, qc__corner_place(T->vector, h));
    for (int32_t f = T->first_marker[h / 3], next; f >= 0; f = next) {
        next = T->next_marker[f];
        T->place[f] = qc__plus(T->place[f], base);
        T->next_marker[f] = *list;
        *list = f;
    }
    T->first_marker[h / 3] = -1;
}

/* Puts a marker, its place taken from the origin of h, into the triangle of h. */
static void put_marker(qc__triangulation *T, int32_t f, int32_t h) {
    T->place[f] = qc__plus(T->place[f], qc__corner_place(T->vector, h));
    T->next_marker[f] = T->first_marker[h / 3];
    T->first_marker[h / 3] = f;
}

typedef struct half {
    qc__point vector, image;
    int32_t twin, origin;
    int8_t rotation, axis;
} half;

/* Moves n <= 2 halfedges to other slots; twins follow. */
static void move_halfedges(qc__triangulation *T, int n, const int32_t *from, const int32_t *to) {
    half saved[2];
    for (int i = 0; i < n; i++)
        saved[i] = (half){T->vector[from[i]],   T->image ? T->image[from[i]] : (qc__point){0, 0},
                          T->twin[from[i]],     T->origin[from[i]],
                          T->rotation[from[i]], T->axis[from[i]]};
    for (int i = 0; i < n; i++) {
        int32_t twin = saved[i].twin;
        for (int j = 0; j < n; j++)
            if (saved[i].twin == from[j]) twin = to[j];
        T->vector[to[i]] = saved[i].vector;
        if (T->image) T->image[to[i]] = saved[i].image;
        T->twin[to[i]] = twin;
        T->origin[to[i]] = saved[i].origin;
        T->rotation[to[i]] = saved[i].rotation;
        T->axis[to[i]] = saved[i].axis;
        if (twin >= 0) T->twin[twin] = to[i];
    }
}

static void renew_spokes(qc__triangulation *T, int32_t t) {
    for (int32_t h = 3 * t; h < 3 * t + 3; h++) T->spoke[T->origin[h]] = h;
}

/* --- flips ------------------------------------------------------------------------------------ */

qc__flap qc__flap_at(const qc__triangulation *T, const qc__point *vector, int32_t h) {
    const int32_t g = T->twin[h];
    return (qc__flap){vector[h], qc__turn_point(vector[qc_prev(h)], 2),
                      qc__turn_point(vector[qc_next(g)], 4 - T->rotation[h])};
}

bool qc__can_flip(const qc__triangulation *T, int32_t h, bool flat) {
    const int32_t g = T->twin[h];
    if (g < 0 || T->axis[h] >= 0 || g / 3 == h / 3) return false;
    const qc__flap f = qc__flap_at(T, T->vector, h);
    return qc__area_sign(qc__minus(f.q, f.w), qc__minus(f.r, f.q)) > 0 &&
           qc__area_sign(f.w, f.r) >= (flat ? 0 : 1);
}

static void cross_flap(qc__point *vector, int32_t a, int32_t b, const qc__flap *f) {
    vector[a] = qc__minus(f->r, f->w);
    vector[b] = qc__minus(f->w, f->r);
}

/* h runs from p to q, with r on the left and w on the right: the triangles p q r and q p w become
 * p w r and q r w. */
void qc__flip(qc__triangulation *T, int32_t h) {
    const int32_t g = T->twin[h];
    share_chart(T, h);
    const int32_t from[2] = {qc_next(h), qc_next(g)}, to[2] = {g, h};
    const qc__flap f = qc__flap_at(T, T->vector, h);
    const qc__flap image = T->image ? qc__flap_at(T, T->image, h) : f;
    const int32_t at_w = T->origin[qc_prev(g)], at_r = T->origin[qc_prev(h)];
    int32_t list = -1;
    take_markers(T, h, (qc__point){0, 0}, &list);
    take_markers(T, qc_next(g), (qc__point){0, 0}, &list);
    move_halfedges(T, 2, from, to);
    const int32_t a = qc_next(h), b = qc_next(g); /* w to r, and back */
    cross_flap(T->vector, a, b, &f);
    if (T->image) cross_flap(T->image, a, b, &image);
    T->twin[a] = b;
    T->twin[b] = a;
    T->origin[a] = at_w;
    T->origin[b] = at_r;
    T->rotation[a] = T->rotation[b] = 0;
    T->axis[a] = T->axis[b] = -1;
    renew_spokes(T, h / 3);
    renew_spokes(T, g / 3);
    for (int32_t m = list, next; m >= 0; m = next) {
        next = T->next_marker[m];
        T->place[m] = qc__minus(T->place[m], f.w);
        const bool left = qc__area_sign(T->vector[a], T->place[m]) >= 0;
        put_marker(T, m, left ? a : qc_prev(g));
    }
}

/* --- merges ----------------------------------------------------------------------------------- */

static void bury(qc__triangulation *T, int32_t t) {
    T->dead[t] = 1;
}

void qc__merge_star(qc__triangulation *T, int32_t h) {
    const int32_t v = T->origin[h], h1 = qc__spoke_ccw(T, h);
    share_chart(T, qc_prev(h));
    const int32_t h2 = qc__spoke_ccw(T, h1);
    share_chart(T, qc_prev(h1));
    const qc__point back = qc__turn_point(T->vector[h], 2); /* v from the end of h */
    int32_t list = -1;
    take_markers(T, h, back, &list);
    take_markers(T, h1, back, &list);
    take_markers(T, h2, back, &list);
    const int32_t from[2] = {qc_next(h1), qc_next(h2)}, to[2] = {qc_prev(h), h};
    move_halfedges(T, 2, from, to);
    bury(T, h1 / 3);
    bury(T, h2 / 3);
    T->spoke[v] = -1;
    renew_spokes(T, h / 3);
    for (int32_t f = list, next; f >= 0; f = next) {
        next = T->next_marker[f];
        put_marker(T, f, qc_next(h));
    }
}

/* One side: the triangles p v x and v q x become p q x. */
static void merge_side(qc__triangulation *T, int32_t h) {
    share_chart(T, qc_next(h));
    const int32_t out = qc_next(T->twin[qc_next(h)]); /* v to q */
    const int32_t from = qc_next(out), to = qc_next(h);
    int32_t list = -1;
    take_markers(T, h, (qc__point){0, 0}, &list);
    take_markers(T, out, T->vector[h], &list);
    T->vector[h] = qc__plus(T->vector[h], T->vector[out]);
    move_halfedges(T, 1, &from, &to);
    bury(T, out / 3);
    renew_spokes(T, h / 3);
    for (int32_t f = list, next; f >= 0; f = next) {
        next = T->next_marker[f];
        put_marker(T, f, h);
    }
}

/* Both charts at one side become those of its first triangle, so the rotation across the merged
 * edge is what it is between these. */
void qc__merge_line(qc__triangulation *T, int32_t h) {
    const int32_t v = T->origin[qc_next(h)];
    const int32_t out = qc_next(T->twin[qc_next(h)]), other = T->twin[out];
    merge_side(T, h);
    if (other >= 0) {
        merge_side(T, other);
        T->twin[h] = other;
        T->twin[other] = h;
    }
    T->spoke[v] = -1;
}
