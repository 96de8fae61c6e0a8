/* The integer-grid map at the vertices of the mesh: from the marker of each face straight to its
 * corners (docs/theory/quantization.md). */
#include "sdk/map/quantize/values.h"

/* Corner k of the face from its marker, in the chart of the face. */
static qc__point corner_from_marker(const qc__exact_map *map, int32_t face, int k) {
    const int64_t *p = map->uv + 6 * (int64_t)face;
    const qc__point a = {p[0], p[1]}, b = {p[2], p[3]}, c = {p[4], p[5]};
    const qc__point marker = qc__plus(qc__plus(b, b), qc__plus(a, c)); /* times 4 */
    const qc__point at = k == 0 ? a : k == 1 ? b : c;
    return qc__minus((qc__point){4 * at.u, 4 * at.v}, marker);
}

qc__face_walk qc__face_walk_begin(const qc__exact_map *map, const qc__coarse_map *coarse,
                                  const qc__point *x, int32_t face) {
    qc__face_walk w = {.cursor = {.coarse = &coarse->coarse, .x = x, .turn = 0},
                       .turn = coarse->turn[face],
                       .marker = coarse->place[face]};
    w.cursor.triangle = coarse->triangle[face];
    for (int k = 0; k < 3; k++)
        w.corner[k] = qc__plus(w.marker, qc__turn_point(corner_from_marker(map, face, k), w.turn));
    return w;
}

qc__cursor qc__face_walk_to(const qc__face_walk *w, int k) {
    qc__cursor cursor = w->cursor;
    qc__cursor_face(&cursor, w->marker, qc__minus(w->corner[k], w->marker));
    for (;;) {
        const int32_t h = qc__cursor_exit(&cursor, w->marker, w->corner[k]);
        if (h < 0 || cursor.coarse->twin[h] < 0) return cursor;
        qc__cursor_cross(&cursor, h);
    }
}

void qc__quantized_values(const qc__exact_map *map, const qc__coarse_map *coarse,
                          const qc__point *x, double *uv) {
    for (int32_t t = 0; t < map->mesh->n_faces; t++) {
        const qc__face_walk w = qc__face_walk_begin(map, coarse, x, t);
        for (int k = 0; k < 3; k++) {
            const qc__cursor end = qc__face_walk_to(&w, k);
            double value[2];
            qc__cursor_value(&end, w.corner[k], value);
            const qc_complex z = qc_quarter_turn((qc_complex){value[0], value[1]}, -w.turn);
            uv[6 * (int64_t)t + 2 * k] = z.re;
            uv[6 * (int64_t)t + 2 * k + 1] = z.im;
        }
    }
}
