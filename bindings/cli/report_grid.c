/* The map as triangles to be drawn. Faces of a parameterization are triangles, in which it is
 * linear, and quads at poles, in which it is bilinear (second paper, Figure 6): these become CELLS
 * x CELLS cells of two triangles. */
#include "bindings/cli/report.h"
#include <stdlib.h>
#include <string.h>

enum { CELLS = 6 };

static int32_t sides(const qc_polygon_mesh *m, int32_t face) {
    return m->face_offset[face + 1] - m->face_offset[face];
}

static bool allocate(const qc_polygon_mesh *m, cli_grid *g) {
    size_t quads = 0, fans = 0;
    for (int32_t f = 0; f < m->n_faces; f++) {
        quads += sides(m, f) == 4;
        fans += sides(m, f) == 4 ? 0 : (size_t)sides(m, f) - 2;
    }
    const size_t points = (size_t)m->n_vertices + quads * (CELLS + 1) * (CELLS + 1);
    const size_t triangles = fans + quads * 2 * CELLS * CELLS;
    g->position = malloc((3 * points + 1) * sizeof *g->position);
    g->corner = malloc((3 * triangles + 1) * sizeof *g->corner);
    g->uv = malloc((6 * triangles + 1) * sizeof *g->uv);
    return g->position && g->corner && g->uv;
}

static void add_corner(cli_grid *g, size_t point, const double *uv) {
    const size_t c = g->n_corners++;
    g->corner[c] = (int32_t)point;
    memcpy(g->uv + 2 * c, uv, 2 * sizeof *uv);
}

static void add_fan(cli_grid *g, const qc_polygon_mesh *m, int32_t face) {
    const int32_t first = m->face_offset[face];
    for (int32_t k = 1; k + 1 < sides(m, face); k++) {
        const int32_t corner[3] = {first, first + k, first + k + 1};
        for (int i = 0; i < 3; i++)
            add_corner(g, (size_t)m->face_vertex[corner[i]],
                       m->uv + 2 * (size_t)m->corner_uv[corner[i]]);
    }
}

/* out = bilinear in the values at corners 0, 1, 2, 3 at (0,0), (1,0), (1,1), (0,1). */
static void interpolate(const double *const value[4], int n, int i, int j, double *out) {
    const double s = (double)i / CELLS, t = (double)j / CELLS;
    for (int c = 0; c < n; c++)
        out[c] = (1 - t) * ((1 - s) * value[0][c] + s * value[1][c]) +
                 t * ((1 - s) * value[3][c] + s * value[2][c]);
}

static void add_cells(cli_grid *g, const qc_polygon_mesh *m, int32_t face) {
    static const int cell[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    const double *position[4], *uv[4];
    const size_t base = g->n_points;
    for (int k = 0; k < 4; k++) {
        const int32_t corner = m->face_offset[face] + k;
        position[k] = m->position + 3 * (size_t)m->face_vertex[corner];
        uv[k] = m->uv + 2 * (size_t)m->corner_uv[corner];
    }
    for (int j = 0; j <= CELLS; j++)
        for (int i = 0; i <= CELLS; i++)
            interpolate(position, 3, i, j, g->position + 3 * g->n_points++);
    for (int j = 0; j < CELLS; j++)
        for (int i = 0; i < CELLS; i++)
            for (int k = 0; k < 6; k++) {
                const int x = i + cell[k][0], y = j + cell[k][1];
                double value[2];
                interpolate(uv, 2, x, y, value);
                add_corner(g, base + (size_t)(y * (CELLS + 1) + x), value);
            }
}

bool cli_grid_create(const qc_polygon_mesh *m, cli_grid *g) {
    memset(g, 0, sizeof *g);
    if (!allocate(m, g)) return false;
    g->n_points = (size_t)m->n_vertices;
    memcpy(g->position, m->position, 3 * g->n_points * sizeof *g->position);
    for (int32_t f = 0; f < m->n_faces; f++) {
        if (sides(m, f) == 4)
            add_cells(g, m, f);
        else
            add_fan(g, m, f);
    }
    return true;
}

void cli_grid_free(cli_grid *g) {
    free(g->position);
    free(g->corner);
    free(g->uv);
}
