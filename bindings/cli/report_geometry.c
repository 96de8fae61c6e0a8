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
                          int32_t n) {
    int32_t *q = cli_integers(3 * (size_t)n);
    for (size_t i = 0; q && i < 3 * (size_t)n; i++) q[i] = quantise(b, position[i], i % 3);
    cli_arrays_add(a, name, q, 3 * (size_t)n, 3);
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

static const double *corner_uv(const qc_polygon_mesh *m, int32_t corner) {
    return m->uv + 2 * (size_t)m->corner_uv[corner];
}

/* Steps to one parameter unit. */
static double uv_scale(const qc_polygon_mesh *m) {
    double sum = 0;
    for (int32_t i = 0; i < m->n_corners; i++) {
        const double *p = corner_uv(m, i), *q = corner_uv(m, i % 3 == 2 ? i - 2 : i + 1);
        sum += hypot(q[0] - p[0], q[1] - p[1]);
    }
    const double mean = sum / (m->n_corners ? m->n_corners : 1);
    return ldexp(1, (int)fmax(6, fmin(20, ceil(log2(1000 / fmax(mean, 1e-6))))));
}

/* Integer shifts do not move the integer isolines: each face keeps its parameters small. */
static void add_uv(cli_arrays *a, const qc_polygon_mesh *m, double scale) {
    int32_t *q = cli_integers(2 * (size_t)m->n_corners);
    for (int32_t i = 0; q && i < m->n_corners; i++) {
        const double *first = corner_uv(m, i - i % 3), *p = corner_uv(m, i);
        for (size_t c = 0; c < 2; c++)
            q[2 * (size_t)i + c] =
                (int32_t)lround(fmax(-2e9, fmin(2e9, (p[c] - floor(first[c])) * scale)));
    }
    cli_arrays_add(a, "grid_uv", q, 2 * (size_t)m->n_corners, 2);
}

/* What the corners of the map around each vertex sum up to: 4 - index4 quarter turns inside. Around
 * an interior vertex the ends of its fan meet: next - previous vertices sum to zero. */
static void sum_corners(const qc_polygon_mesh *m, double *angle, int64_t *open) {
    for (int32_t i = 0; i < m->n_corners; i++) {
        const int32_t face = i - i % 3, j = face + (i + 1) % 3, k = face + (i + 2) % 3;
        const double *o = corner_uv(m, i), *p = corner_uv(m, j), *q = corner_uv(m, k);
        const double ax = p[0] - o[0], ay = p[1] - o[1], bx = q[0] - o[0], by = q[1] - o[1];
        angle[m->face_vertex[i]] += atan2(ax * by - ay * bx, ax * bx + ay * by);
        open[m->face_vertex[i]] += m->face_vertex[j] - m->face_vertex[k];
    }
}

static bool map_cones(const qc_polygon_mesh *m, int32_t *index4) {
    double *angle = calloc((size_t)m->n_vertices + 1, sizeof *angle);
    int64_t *open = calloc((size_t)m->n_vertices + 1, sizeof *open);
    const bool good = angle && open;
    if (good) sum_corners(m, angle, open);
    for (int32_t v = 0; good && v < m->n_vertices; v++)
        index4[v] = open[v] == 0 ? 4 - (int32_t)lround(angle[v] / HALF_PI) : 0;
    free(angle);
    free(open);
    return good;
}

static bool field_cones(qc_ctx *ctx, const qc_face_field *field, int32_t *index4) {
    qc_matching *matching = NULL;
    if (qc_matching_create(ctx, field, NULL, &matching) != QC_OK) return false;
    memcpy(index4, matching->index4, (size_t)field->mesh->n_vertices * sizeof *index4);
    qc_object_release(matching);
    return true;
}

/* x, y, z, index4 of each. */
static void add_cones(cli_arrays *a, const box *b, const double *position, const int32_t *index4,
                      int32_t n) {
    size_t count = 0;
    for (int32_t v = 0; v < n; v++) count += index4[v] != 0;
    int32_t *q = cli_integers(4 * count), *out = q;
    for (int32_t v = 0; q && v < n; v++) {
        if (index4[v] == 0) continue;
        for (size_t c = 0; c < 3; c++) *out++ = quantise(b, position[3 * (size_t)v + c], c);
        *out++ = index4[v];
    }
    cli_arrays_add(a, "cones", q, 4 * count, 4);
}

/* Those of the map where there is one: the optimisation moves them away from those of the field. */
static bool cones(qc_ctx *ctx, cli_arrays *a, const box *b, const qc_remesh_result *r) {
    if (!r->uv && !r->field) return true;
    const int32_t n = r->uv ? r->uv->n_vertices : r->mesh->n_vertices;
    int32_t *index4 = calloc((size_t)n + 1, sizeof *index4);
    const bool good =
        index4 && (r->uv ? map_cones(r->uv, index4) : field_cones(ctx, r->field, index4));
    if (good) add_cones(a, b, r->uv ? r->uv->position : r->mesh->position, index4, n);
    free(index4);
    return good;
}

static void add_quads(cli_arrays *a, const box *b, const qc_polygon_mesh *quads) {
    add_positions(a, "quads_positions", b, quads->position, quads->n_vertices);
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
    add_positions(a, "input_positions", &b, r->mesh->position, r->mesh->n_vertices);
    add_copy(a, "input_faces", r->mesh->face_vertex, 3 * (size_t)r->mesh->n_faces, 1);
    bool good = !r->field || add_field(ctx, a, r->mesh, r->field);
    if (uv) {
        scale = uv_scale(uv);
        add_positions(a, "grid_positions", &b, uv->position, uv->n_vertices);
        add_copy(a, "grid_faces", uv->face_vertex, (size_t)uv->n_corners, 1);
        add_uv(a, uv, scale);
    }
    if (quads && quads->n_corners == 4 * quads->n_faces) add_quads(a, &b, quads);
    good = cones(ctx, a, &b, r) && good;
    if (!good || a->failed) return NULL;
    return json_pack("{s:[f,f,f],s:f,s:f,s:O}", "extent", (b.high[0] - b.low[0]) / b.step,
                     (b.high[1] - b.low[1]) / b.step, (b.high[2] - b.low[2]) / b.step, "uv_scale",
                     scale, "ball", ball(r, &b), "arrays", a->list);
}
