/* Rounding of a seamless map to multiples of a power of two (see snap.h; docs/theory/exact-grid.md
 * has the same for maps with integer translations). */
#include "sdk/map/periods/snap.h"
#include <math.h>
#include "sdk/map/quantize/exact_sign.h"

enum {
    WIDTH = 40, /* |value| < 2^WIDTH units: sums of some thousands of them are exact in doubles */
    RADIUS = 4, /* units a vertex moves */
    PASSES = 4
};

typedef struct snapper {
    const qc__seams *seams;
    qc_complex *f; /* 3 n_faces */
    int32_t bits;
    double unit; /* 2^-bits */
} snapper;

static double largest_value(const qc__seams *s, const qc_complex *f, const double *y,
                            const double *symbol) {
    double largest = 0;
    for (int64_t c = 0; c < 3 * (int64_t)s->mesh->n_faces; c++)
        largest = fmax(largest, fmax(fabs(f[c].re), fabs(f[c].im)));
    for (int32_t j = 0; j < s->n_free; j++) largest = fmax(largest, fabs(y[j]));
    for (int32_t j = 0; j < qc__seams_symbols(s); j++) largest = fmax(largest, fabs(symbol[j]));
    return largest;
}

static double rounded(double x, int32_t bits) {
    return ldexp(rint(ldexp(x, bits)), -bits);
}

static qc__point difference(const snapper *s, qc_complex a, qc_complex b) {
    return (qc__point){(int64_t)ldexp(a.re - b.re, s->bits), (int64_t)ldexp(a.im - b.im, s->bits)};
}

static bool is_positive(const snapper *s, int32_t t) {
    const qc_complex *p = s->f + 3 * (int64_t)t;
    return qc__area_sign(difference(s, p[1], p[0]), difference(s, p[2], p[0])) > 0;
}

/* --- slivers ---------------------------------------------------------------------------------- */

static int32_t folded_at(const snapper *s, int32_t v) {
    const qc_mesh *mesh = s->seams->mesh;
    const int32_t start = mesh->vertex_corner[v];
    int32_t n = 0, c = start;
    do {
        n += !is_positive(s, c / 3);
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
    return n;
}

/* Adds d to F_v. */
static void shift(const snapper *s, int32_t v, double _Complex d) {
    const qc_mesh *mesh = s->seams->mesh;
    const int32_t start = mesh->vertex_corner[v];
    int32_t c = start;
    do {
        const int32_t turn = s->seams->wedge_turn[s->seams->corner_wedge[c]];
        s->f[c] = qc__pair(qc__complex(s->f[c]) + qc__turn(d, turn));
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != start);
}

/* The first best of the offsets of max norm 1, 2, ... RADIUS along the coordinates which move. */
static bool move_vertex(const snapper *s, int32_t v) {
    const int32_t u_free = !qc__seams_is_given(s->seams, v, 0);
    const int32_t v_free = !qc__seams_is_given(s->seams, v, 1);
    const int32_t before = folded_at(s, v);
    int32_t best = before;
    double _Complex place = 0;
    for (int32_t r = 1; r <= RADIUS && best > 0; r++)
        for (int32_t i = -r * u_free; i <= r * u_free; i++)
            for (int32_t j = -r * v_free; j <= r * v_free && best > 0; j++) {
                if (i > -r && i < r && j > -r && j < r) continue;
                const double _Complex d = s->unit * ((double)i + (double)j * I);
                shift(s, v, d);
                const int32_t n = folded_at(s, v);
                shift(s, v, -d);
                if (n >= best) continue;
                best = n;
                place = d;
            }
    shift(s, v, place);
    return best < before;
}

static qc_status repair(qc_ctx *ctx, const snapper *s, int32_t *folded) {
    const qc_mesh *mesh = s->seams->mesh;
    bool changed = true;
    for (int32_t pass = 0; pass < PASSES && changed; pass++) {
        changed = false;
        for (int32_t t = 0; t < mesh->n_faces; t++) {
            if (t % 8192 == 0 && !qc__progress(ctx, (double)t / mesh->n_faces))
                return QC_ERR_CANCELLED;
            for (int32_t c = 3 * t; c < 3 * t + 3 && !is_positive(s, t); c++)
                changed |= move_vertex(s, mesh->face_vertex[c]);
        }
    }
    *folded = 0;
    for (int32_t t = 0; t < mesh->n_faces; t++) *folded += !is_positive(s, t);
    return QC_OK;
}

/* --- the whole -------------------------------------------------------------------------------- */

/* y to twice the unit, since points may lie on halves of it; then symbols are multiples of the unit
 * and F is rounded to it. */
static void snap(const snapper *s, double *y, double *symbol, double _Complex *wedge,
                 double _Complex *F) {
    qc__periods_split(s->seams, s->f, wedge, F);
    for (int32_t j = 0; j < s->seams->n_free; j++) y[j] = rounded(y[j], s->bits - 1);
    qc__seams_symbol_values(s->seams, y, symbol);
    qc__seams_wedge_values(s->seams, symbol, wedge);
    for (int32_t v = 0; v < s->seams->mesh->n_vertices; v++)
        F[v] = rounded(creal(F[v]), s->bits) + rounded(cimag(F[v]), s->bits) * I;
    qc__periods_corners(s->seams, wedge, F, s->f);
}

qc_status qc__snap(qc_ctx *ctx, const qc__seams *seams, qc_complex *f, double *y, int32_t *bits,
                   int32_t *folded) {
    double *symbol = QC__NEW(ctx, double, qc__seams_symbols(seams));
    double _Complex *wedge = QC__NEW(ctx, double _Complex, seams->n_wedges);
    double _Complex *F = QC__NEW(ctx, double _Complex, seams->mesh->n_vertices);
    snapper s = {.seams = seams, .f = f};
    qc_status status = symbol && wedge && F ? QC_OK : QC_ERR_NOMEM;
    if (status == QC_OK) {
        qc__seams_symbol_values(seams, y, symbol);
        const double largest = largest_value(seams, f, y, symbol);
        int exponent = 0;
        frexp(largest + 1, &exponent); /* largest + 1 < 2^exponent */
        s.bits = WIDTH - 1 - exponent;
        s.unit = ldexp(1, -s.bits);
        if (!(largest < 274877906944.0))
            status = qc__fail(ctx, QC_ERR_FAILED, -1,
                              "the map reaches %.3g units, too far to be made exact", largest);
    }
    if (status == QC_OK) {
        snap(&s, y, symbol, wedge, F);
        status = repair(ctx, &s, folded);
    }
    if (status == QC_OK) *bits = s.bits;
    qc__free(symbol);
    qc__free(wedge);
    qc__free(F);
    return status;
}
