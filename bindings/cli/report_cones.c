/* Singularities of a run. Where there is a map, they are its own: the optimisation moves them away
 * from those which the field shows. The corners of the map around an interior vertex sum up to 4 -
 * index4 quarter turns. */
#include "bindings/cli/report.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI      3.14159265358979323846
#define HALF_PI 1.57079632679489661923

static const double *corner_uv(const qc_polygon_mesh *m, int32_t corner) {
    return m->uv + 2 * (size_t)m->corner_uv[corner];
}

static int32_t corner_of(const qc_polygon_mesh *m, int32_t face, int32_t k) {
    const int32_t first = m->face_offset[face], n = m->face_offset[face + 1] - first;
    return first + (k + n) % n;
}

static double corner_angle(const qc_polygon_mesh *m, int32_t face, int32_t k) {
    const double *o = corner_uv(m, corner_of(m, face, k));
    const double *p = corner_uv(m, corner_of(m, face, k + 1));
    const double *q = corner_uv(m, corner_of(m, face, k - 1));
    const double ax = p[0] - o[0], ay = p[1] - o[1], bx = q[0] - o[0], by = q[1] - o[1];
    return atan2(ax * by - ay * bx, ax * bx + ay * by);
}

/* open: next - previous vertex numbers, whose sum is zero where the ends of the fan meet. */
static void sum_corners(const qc_polygon_mesh *m, double *angle, int64_t *open) {
    for (int32_t f = 0; f < m->n_faces; f++)
        for (int32_t k = 0; k < m->face_offset[f + 1] - m->face_offset[f]; k++) {
            const int32_t v = m->face_vertex[corner_of(m, f, k)];
            angle[v] += corner_angle(m, f, k);
            open[v] += m->face_vertex[corner_of(m, f, k + 1)];
            open[v] -= m->face_vertex[corner_of(m, f, k - 1)];
        }
}

static void add(cli_cones *c, const double *position, int32_t vertex, int32_t index4) {
    if (index4 == 0) return;
    cli_cone *cone = &c->cone[c->n++];
    memcpy(cone->position, position + 3 * (size_t)vertex, sizeof cone->position);
    cone->index4 = index4;
}

static int32_t nearest(double angle) {
    return (int32_t)lround(angle / HALF_PI);
}

/* A pole is a loop of quads (a, b, q', q), q' and q in one place. The map turns by
 * sum (beta - pi) = 2 pi (1 - index) along the loop of the a, with beta the angles outside of the
 * quads. face: n_vertices, the quad which begins at q, or -1. */
static void add_poles(cli_cones *c, const qc_polygon_mesh *m, const double *angle, int32_t *face) {
    for (int32_t v = 0; v < m->n_vertices; v++) {
        double turn = 0;
        if (face[v] < 0) continue;
        for (int32_t q = v, f = face[v]; f >= 0; f = face[q]) {
            face[q] = -1;
            turn += angle[m->face_vertex[corner_of(m, f, 0)]] - corner_angle(m, f, 0) -
                    corner_angle(m, f, 1) - PI;
            q = m->face_vertex[corner_of(m, f, 2)];
        }
        add(c, m->position, v, 4 - nearest(turn));
    }
}

static bool map_cones(const qc_polygon_mesh *m, cli_cones *c) {
    const size_t n = (size_t)m->n_vertices + 1;
    double *angle = calloc(n, sizeof *angle);
    int64_t *open = calloc(n, sizeof *open);
    int32_t *face = malloc(n * sizeof *face);
    c->cone = malloc(n * sizeof *c->cone);
    const bool good = angle && open && face && c->cone;
    if (good) {
        sum_corners(m, angle, open);
        for (int32_t v = 0; v < m->n_vertices; v++) {
            face[v] = -1;
            if (open[v] == 0) add(c, m->position, v, 4 - nearest(angle[v]));
        }
        for (int32_t f = 0; f < m->n_faces; f++)
            if (m->face_offset[f + 1] - m->face_offset[f] == 4)
                face[m->face_vertex[corner_of(m, f, 3)]] = f;
        add_poles(c, m, angle, face);
    }
    free(angle);
    free(open);
    free(face);
    return good;
}

static bool field_cones(qc_ctx *ctx, const qc_face_field *field, cli_cones *c) {
    const qc_mesh *mesh = field->mesh;
    qc_matching *matching = NULL;
    if (qc_matching_create(ctx, field, NULL, &matching) != QC_OK) return false;
    c->cone = malloc(((size_t)mesh->n_vertices + 1) * sizeof *c->cone);
    for (int32_t v = 0; c->cone && v < mesh->n_vertices; v++)
        add(c, mesh->position, v, matching->index4[v]);
    qc_object_release(matching);
    return c->cone;
}

bool cli_cones_create(qc_ctx *ctx, const qc_remesh_result *result, cli_cones *out) {
    out->n = 0;
    out->cone = NULL;
    if (result->uv) return map_cones(result->uv, out);
    return !result->field || field_cones(ctx, result->field, out);
}
