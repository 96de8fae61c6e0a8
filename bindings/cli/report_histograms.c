/* Histograms beside the models of Figure 7.1 of the thesis: edge lengths in units of their mean,
 * and corner angles in degrees. */
#include "bindings/cli/report.h"
#include <math.h>

enum { BINS = 72 };

typedef struct histogram {
    double low, high;
    int64_t count[BINS];
} histogram;

static void put(histogram *h, double x) {
    const double bin = floor((x - h->low) / (h->high - h->low) * BINS);
    h->count[(int)fmax(0, fmin(BINS - 1, bin))]++;
}

static json_t *print(const histogram *h) {
    json_t *count = json_array();
    for (int i = 0; i < BINS; i++)
        json_array_append_new(count, json_integer((json_int_t)h->count[i]));
    return json_pack("{s:f,s:f,s:o}", "lo", h->low, "hi", h->high, "count", count);
}

typedef struct corner {
    double length; /* of the edge to the next corner */
    double angle;  /* degrees */
} corner;

static corner measure(const qc_polygon_mesh *m, int32_t face, int32_t k) {
    const int32_t *v = m->face_vertex + m->face_offset[face];
    const int32_t n = m->face_offset[face + 1] - m->face_offset[face];
    const double *o = m->position + 3 * (size_t)v[k], *p = m->position + 3 * (size_t)v[(k + 1) % n];
    const double *q = m->position + 3 * (size_t)v[(k + n - 1) % n];
    double aa = 0, bb = 0, ab = 0;
    for (int c = 0; c < 3; c++) {
        const double a = p[c] - o[c], b = q[c] - o[c];
        aa += a * a;
        bb += b * b;
        ab += a * b;
    }
    const double cosine = ab / sqrt(fmax(aa * bb, 1e-300));
    return (corner){sqrt(aa), acos(fmax(-1, fmin(1, cosine))) * 57.295779513082320877};
}

json_t *cli_histograms(const qc_polygon_mesh *m) {
    histogram edge = {0, 2, {0}}, angle = {0, 180, {0}};
    double sum = 0;
    for (int32_t f = 0; f < m->n_faces; f++)
        for (int32_t k = 0; k < m->face_offset[f + 1] - m->face_offset[f]; k++)
            sum += measure(m, f, k).length;
    const double mean = sum > 0 ? sum / m->n_corners : 1;
    for (int32_t f = 0; f < m->n_faces; f++)
        for (int32_t k = 0; k < m->face_offset[f + 1] - m->face_offset[f]; k++) {
            const corner c = measure(m, f, k);
            put(&edge, c.length / mean);
            put(&angle, c.angle);
        }
    return json_pack("{s:o,s:o}", "edge", print(&edge), "angle", print(&angle));
}
