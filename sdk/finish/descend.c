/* Descent of the vertices of a patch of quads, turned over or not, in a shape energy which is
 * finite for both (Garanzha et al., Foldover-free maps in 50 lines of code, 2021), and then in the
 * quality of the worst quad. With the edges a, b at a corner of a quad with unit normal n on the
 * side of the surface, s the size of the quads there,
 *     E = sum over corners of (a^2 + b^2) / 2 chi,      d = n . (a x b),
 *     chi = (d + sqrt(e^2 s^4 + d^2)) / 2.
 * e falls from round to round. Where there is room for long quads only, |a| |b| + s^2 / 200 takes
 * the place of (a^2 + b^2) / 2. As surface and features have kinks the search is one without
 * derivatives, vertex by vertex (compass search: Kolda, Lewis and Torczon, 2003). */
#include "sdk/finish/internal.h"

enum { ROUNDS = 20, WORST_ROUNDS = 10, DIRECTIONS = 8 };
static const double first_e = 1, fall = 0.8, least_e = 0.01;
/* Keeps edges from vanishing, in squares of the edge length. */
#define LEAST_SQUARE 0.01
/* Steps, in edge lengths. */
static const double first_step = 0.4, least_step = 1e-3;

typedef struct descent {
    qc__relaxation *r;
    double e;    /* 0: the worst quads count */
    bool angles; /* edges may differ */
} descent;

/* Of quad f with its corner k at x. */
static double quad_energy(const descent *o, int32_t f, int k, const double x[3]) {
    const qc__relaxation *r = o->r;
    const int32_t *v = r->quads->face_vertex + 4 * (int64_t)f;
    const double *p[4], size2 = r->size[f] * r->size[f], floor2 = o->e * size2;
    double d[2][3], n[3], edge[4][3], length2[4], sum = 0;
    for (int i = 0; i < 4; i++) p[i] = i == k ? x : r->position + 3 * (int64_t)v[i];
    for (int j = 0; j < 3; j++) {
        d[0][j] = p[2][j] - p[0][j];
        d[1][j] = p[3][j] - p[1][j];
        for (int i = 0; i < 4; i++) edge[i][j] = p[(i + 1) & 3][j] - p[i][j];
    }
    for (int i = 0; i < 4; i++) length2[i] = qc__dot3(edge[i], edge[i]);
    qc__cross3(d[0], d[1], n);
    const double l = qc__quad_turned(r, f, k, x) ? -qc__norm3(n) : qc__norm3(n);
    for (int i = 0; i < 4; i++) {
        const int before = (i + 3) & 3;
        double c[3];
        qc__cross3(edge[before], edge[i], c);
        const double det = l != 0 ? qc__dot3(c, n) / l : 0;
        const double scale = o->angles
                                 ? 2 * sqrt(length2[before] * length2[i]) + LEAST_SQUARE * size2
                                 : length2[before] + length2[i];
        sum += scale / (det + sqrt(floor2 * floor2 + det * det));
    }
    return sum;
}

/* What is made less at v, were it at x. */
static double bad(const descent *o, int32_t v, const double x[3]) {
    const qc__neighbours *a = &o->r->around;
    double sum = 0;
    if (o->e <= 0) return -qc__ring_quality(o->r, v, x);
    for (int32_t i = a->face_start[v]; i < a->face_start[v + 1]; i++)
        sum += quad_energy(o, a->face[i] / 4, a->face[i] & 3, x);
    return sum;
}

/* To the best of the places a step away; steps grow when there is one, else become smaller. */
static void search(const descent *o, int32_t v, double *step) {
    qc__relaxation *r = o->r;
    double best = bad(o, v, r->position + 3 * (int64_t)v), d[3];
    bool found = false;
    qc__spot place;
    if (*step < least_step * qc__size_at(r, v)) return;
    for (int i = 0; i < DIRECTIONS && qc__direction(r, v, i, DIRECTIONS, d); i++) {
        qc__spot spot;
        for (int k = 0; k < 3; k++) d[k] *= *step;
        if (!qc__step(r, v, d, &spot)) continue;
        const double b = bad(o, v, spot.x);
        if (!(b < best) || qc__ring_turns(r, v, spot.x)) continue;
        best = b;
        place = spot;
        found = true;
    }
    if (found) qc__place(r, v, &place);
    *step *= found ? 1.5 : 0.5;
}

void qc__quads_descend(qc__relaxation *r, bool angles, int32_t n, const int32_t *vertex,
                       double *step) {
    descent o = {r, first_e, angles};
    for (int i = 0; i < ROUNDS + WORST_ROUNDS; i++) {
        if (i >= ROUNDS) o.e = 0;
        for (int32_t j = 0; j < n; j++) {
            if (i == 0 || i == ROUNDS) step[j] = first_step * qc__size_at(r, vertex[j]);
            search(&o, vertex[j], &step[j]);
        }
        o.e = fmax(fall * o.e, least_e);
    }
}
