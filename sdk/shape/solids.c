/* Cube, cylinder and truncated cone, closed. The caps are squares mapped to disks concentrically
 * (Shirley and Chiu 1997), so their boundary points are those of the lateral surface. */
#include "sdk/shape/internal.h"

typedef struct side {
    int axis, up;
} side;

static void cube_side(const void *data, double u, double v, double out[3]) {
    const side *s = data;
    out[s->axis] = s->up ? 1 : -1;
    out[(s->axis + 1) % 3] = 2 * u - 1;
    out[(s->axis + 2) % 3] = 2 * v - 1;
}

void qc__shape_cube(qc__soup *soup, const qc_shape_options *options) {
    int32_t n = qc__segments(options->resolution, 6, 1);
    for (int i = 0; i < 6; i++) {
        side s = {i / 2, i % 2};
        qc__soup_patch(soup, n, n, !s.up, cube_side, &s);
    }
}

typedef struct cone {
    double bottom, top, height; /* radii and height */
    int quarter; /* of the lateral surface                                           */
    bool upper;  /* cap                                                              */
} cone;

static void cone_cap(const void *data, double u, double v, double out[3]) {
    const cone *c = data;
    double x = 2 * u - 1, y = 2 * v - 1, radius = c->upper ? c->top : c->bottom;
    double r = fmax(fabs(x), fabs(y)), angle = 0;
    if (r > 0) angle = fabs(x) >= fabs(y) ? 0.25 * QC__PI * y / x : 0.25 * QC__PI * (2 - x / y);
    if (r > 0 && (fabs(x) >= fabs(y) ? x < 0 : y < 0)) r = -r;
    out[0] = radius * r * cos(angle);
    out[1] = radius * r * sin(angle);
    out[2] = c->upper ? 0.5 * c->height : -0.5 * c->height;
}

static void cone_side(const void *data, double u, double v, double out[3]) {
    const cone *c = data;
    double angle = 0.25 * QC__PI * (2 * u - 1) + 0.5 * QC__PI * c->quarter;
    double radius = (1 - v) * c->bottom + v * c->top;
    out[0] = radius * cos(angle);
    out[1] = radius * sin(angle);
    out[2] = c->height * (v - 0.5);
}

static void frustum(qc__soup *soup, const qc_shape_options *options, cone c) {
    double slant = hypot(c.height, c.bottom - c.top), edge = 0.25 * QC__PI * (c.bottom + c.top);
    double rows = slant / edge; /* per segment of a quarter */
    int32_t n = qc__segments(options->resolution, 2 + 4 * rows, 2);
    int32_t m = (int32_t)fmax(1, floor(rows * n + 0.5));
    for (int i = 0; i < 4; i++) {
        c.quarter = i;
        qc__soup_patch(soup, n, m, false, cone_side, &c);
    }
    for (int i = 0; i < 2; i++) {
        c.upper = i == 1;
        qc__soup_patch(soup, n, n, !c.upper, cone_cap, &c);
    }
}

void qc__shape_cylinder(qc__soup *soup, const qc_shape_options *options) {
    frustum(soup, options, (cone){.bottom = 1, .top = 1, .height = 3});
}

void qc__shape_truncated_cone(qc__soup *soup, const qc_shape_options *options) {
    frustum(soup, options, (cone){.bottom = 1, .top = 0.4, .height = 1.6});
}
