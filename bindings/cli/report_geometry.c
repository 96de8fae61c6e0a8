/* Surfaces, field, parameters and cones of a run as integers: positions in steps of the longest
 * side of the bounding box / 65535, crosses in steps of a quarter turn / 256, parameters in steps
 * which part an average face a thousand times. */
#include "bindings/cli/report.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define HALF_PI 1.57079632679489661923

typedef struct box {
    double low[3], high[3], step;
} box;

static void enclose(box *b, const double *position, size_t n) {
    for (size_t i = 0; i < 3 * n; i++) {
        b->low[i % 3] = fmin(b->low[i % 3], position[i]);
        b->high[i % 3] = fmax(b->high[i % 3], position[i]);
    }
}

static box bounds(const qc_remesh_result *r) {
    box b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 1};
    if (r->mesh) enclose(&b, r->mesh->position, (size_t)r->mesh->n_vertices);
    if (r->quads) enclose(&b, r->quads->position, (size_t)r->quads->n_vertices);
    double longest = 0;
    for (int c = 0; c < 3; c++) longest = fmax(longest, b.high[c] - b.low[c]);
    if (longest > 0) b.step = longest / 65535;
    return b;
}

static int32_t quantise(const box *b, double x, size_t c) {
    return (int32_t)lround((x - b->low[c]) / b->step);
}

static void add_positions(cli_arrays *a, const char *name, const box *b, const double *position,
                          size_t n) {
    int32_t *q = cli_integers(3 * n);
    for (size_t i = 0; q && i < 3 * n; i++) q[i] = quantise(b, position[i], i % 3);
    cli_arrays_add(a, name, q, 3 * n, 3);
}

static void add_copy(cli_arrays *a, const char *name, const int32_t *values, size_t n, int stride) {
    int32_t *copy = cli_integers(n);
    if (copy && n > 0) memcpy(copy, values, n * sizeof *copy);
    cli_arrays_add(a, name, copy, n, stride);
}

/* Angle of the cross from the edge opposite corner 0, modulo a quarter turn. */
static bool add_field(qc_ctx *ctx, cli_arrays *a, const qc_mesh *mesh, const qc_face_field *field) {
    const size_t n = (size_t)mesh->n_faces;
    qc_complex *edge = malloc(3 * n * sizeof *edge);
    int32_t *q = cli_integers(n);
    const bool good = edge && q && qc_tangent_edges(ctx, mesh, edge) == QC_OK;
    for (size_t t = 0; good && t < n; t++) {
        const qc_complex x = field->x[t], e = edge[3 * t];
        const double angle = atan2(x.im * e.re - x.re * e.im, x.re * e.re + x.im * e.im);
        q[t] = (int32_t)lround(angle / HALF_PI * 256) & 255;
    }
    free(edge);
    if (good)
        cli_arrays_add(a, "field", q, n, 1);
    else
        free(q);
    return good;
}

/* Steps to one parameter unit. */
static double uv_scale(const cli_grid *g) {
    double sum = 0;
    for (size_t i = 0; i < g->n_corners; i++) {
        const double *p = g->uv + 2 * i, *q = g->uv + 2 * (i % 3 == 2 ? i - 2 : i + 1);
        sum += hypot(q[0] - p[0], q[1] - p[1]);
    }
    const double mean = sum / (g->n_corners ? (double)g->n_corners : 1);
    return ldexp(1, (int)fmax(6, fmin(20, ceil(log2(1000 / fmax(mean, 1e-6))))));
}

/* Integer shifts do not move the integer isolines: each face keeps its parameters small. */
static void add_uv(cli_arrays *a, const cli_grid *g, double scale) {
    int32_t *q = cli_integers(2 * g->n_corners);
    for (size_t i = 0; q && i < 2 * g->n_corners; i++) {
        const double whole = floor(g->uv[i - i % 6 + i % 2]);
        q[i] = (int32_t)lround(fmax(-2e9, fmin(2e9, (g->uv[i] - whole) * scale)));
    }
    cli_arrays_add(a, "grid_uv", q, 2 * g->n_corners, 2);
}

static bool add_grid(cli_arrays *a, const box *b, const qc_polygon_mesh *uv, double *scale) {
    cli_grid g;
    const bool good = cli_grid_create(uv, &g);
    if (good) {
        *scale = uv_scale(&g);
        add_positions(a, "grid_positions", b, g.position, g.n_points);
        add_copy(a, "grid_faces", g.corner, g.n_corners, 1);
        add_uv(a, &g, *scale);
    }
    cli_grid_free(&g);
    return good;
}

static bool add_cones(qc_ctx *ctx, cli_arrays *a, const box *b, const qc_remesh_result *r) {
    cli_cones cones;
    const bool good = cli_cones_create(ctx, r, &cones);
    int32_t *q = good ? cli_integers(4 * cones.n) : NULL;
    for (size_t i = 0; q && i < cones.n; i++) {
        for (size_t c = 0; c < 3; c++) q[4 * i + c] = quantise(b, cones.cone[i].position[c], c);
        q[4 * i + 3] = cones.cone[i].index4;
    }
    if (good) cli_arrays_add(a, "cones", q, 4 * cones.n, 4);
    free(cones.cone);
    return good;
}

static void add_quads(cli_arrays *a, const box *b, const qc_polygon_mesh *quads) {
    add_positions(a, "quads_positions", b, quads->position, (size_t)quads->n_vertices);
    add_copy(a, "quads_faces", quads->face_vertex, (size_t)quads->n_corners, 1);
    add_copy(a, "quads_lines", quads->line, 2 * (size_t)quads->n_lines, 2);
}

/* Radius of a cone: a third of a quad, but large enough to be seen. */
static double ball(const qc_remesh_result *r, const box *b) {
    const double diagonal = r->mesh->diagonal;
    const double edge = r->report && r->report->quads.edges > 0
                            ? r->report->quads.edge_sum / r->report->quads.edges
                            : r->mesh->mean_edge_length;
    return fmin(fmax(0.33 * edge, 0.004 * diagonal), 0.012 * diagonal) / b->step;
}

json_t *cli_report_geometry(qc_ctx *ctx, const qc_remesh_result *r, cli_arrays *a) {
    const box b = bounds(r);
    const qc_polygon_mesh *uv = r->uv, *quads = r->quads;
    double scale = 1;
    add_positions(a, "input_positions", &b, r->mesh->position, (size_t)r->mesh->n_vertices);
    add_copy(a, "input_faces", r->mesh->face_vertex, 3 * (size_t)r->mesh->n_faces, 1);
    bool good = !r->field || add_field(ctx, a, r->mesh, r->field);
    if (uv) good = add_grid(a, &b, uv, &scale) && good;
    if (quads && quads->n_corners == 4 * quads->n_faces) add_quads(a, &b, quads);
    good = add_cones(ctx, a, &b, r) && good;
    if (!good || a->failed) return NULL;
    return json_pack("{s:[f,f,f],s:f,s:f,s:O}", "extent", (b.high[0] - b.low[0]) / b.step,
                     (b.high[1] - b.low[1]) / b.step, (b.high[2] - b.low[2]) / b.step, "uv_scale",
                     scale, "ball", ball(r, &b), "arrays", a->list);
}
