/* Cross fields with hard features on simple surfaces, for the tests of aligned maps. */
#ifndef QC_TESTS_HARD_FEATURES_H
#define QC_TESTS_HARD_FEATURES_H

#include "tests/unit/map/seamless.h"

typedef struct aligned_case {
    const char *name, *shape; /* shape NULL: a square plate, with a square hole when `hole` */
    int32_t resolution;
    bool hole, circles;     /* crosses along the circles about the z axis, else along the axes */
    int32_t points, levels; /* corners and cones; chains, up to those which points join */
    int32_t n_free;
    double scale; /* of the positions */
} aligned_case;

/* A plate of n x n squares, each cut in two, without a middle third where `hole`. */
static inline qc_mesh *plate(qc_ctx *ctx, int32_t n, bool hole) {
    double *p = ARRAY(double, 3 * (n + 1) * (n + 1));
    int32_t *face = ARRAY(int32_t, 6 * n * n), *name = ARRAY(int32_t, (n + 1) * (n + 1));
    int32_t n_faces = 0, n_vertices = 0;
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < n; j++) {
            const bool inside = 3 * i >= n && 3 * i < 2 * n && 3 * j >= n && 3 * j < 2 * n;
            const int32_t a = i * (n + 1) + j, b = a + n + 1;
            const int32_t corner[6] = {a, b, b + 1, a, b + 1, a + 1};
            for (int k = 0; k < 6 && !(hole && inside); k++) face[3 * n_faces + k] = corner[k];
            n_faces += hole && inside ? 0 : 2;
        }
    for (int32_t c = 0; c < 3 * n_faces; c++) {
        const int32_t v = face[c];
        if (name[v] == 0) {
            p[3 * n_vertices] = v / (n + 1);
            p[3 * n_vertices + 1] = v % (n + 1);
            name[v] = ++n_vertices;
        }
        face[c] = name[v] - 1;
    }
    qc_mesh *mesh = NULL;
    must(ctx, qc_mesh_create(ctx, n_vertices, p, n_faces, face, &mesh));
    free(p);
    free(face);
    free(name);
    return mesh;
}

/* The same mesh, larger. */
static inline qc_mesh *scaled(qc_ctx *ctx, qc_mesh *mesh, double scale) {
    double *p = ARRAY(double, 3 * (int64_t)mesh->n_vertices);
    qc_mesh *larger = NULL;
    for (int64_t i = 0; i < 3 * (int64_t)mesh->n_vertices; i++) p[i] = scale * mesh->position[i];
    must(ctx, qc_mesh_create(ctx, mesh->n_vertices, p, mesh->n_faces, mesh->face_vertex, &larger));
    free(p);
    qc_object_release(mesh);
    return larger;
}

/* The boundary, edges between faces at right angles, and on the torus the outer circle. */
static inline uint8_t *feature_edges(qc_ctx *ctx, const aligned_case *c, const qc_mesh *mesh) {
    uint8_t *edge = ARRAY(uint8_t, mesh->n_edges);
    double *normal = ARRAY(double, 3 * (int64_t)mesh->n_faces);
    must(ctx, qc_mesh_geometry(ctx, mesh, NULL, NULL, NULL, NULL, normal, NULL));
    const bool torus = c->shape && strcmp(c->shape, "torus") == 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t s = mesh->edge_halfedge[2 * e], t = mesh->edge_halfedge[2 * e + 1];
        const double *a = normal + 3 * (s / 3), *b = normal + 3 * (t / 3);
        edge[e] = t < 0 || (!torus && a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < 0.5);
        double radius = 0;
        for (int k = 0; k < 2 && torus; k++) {
            const double *p = mesh->position + 3 * mesh->edge_vertex[2 * e + k];
            radius += 0.5 * hypot(p[0], p[1]) - fabs(p[2]);
        }
        if (torus) edge[e] = radius > 1.4 - 1e-9;
    }
    free(normal);
    return edge;
}

/* Crosses along the x or y axis, whichever is nearer to the face. */
static inline void along_axes(qc_ctx *ctx, const qc_mesh *mesh, qc_complex *x) {
    double *re = ARRAY(double, 3 * (int64_t)mesh->n_faces);
    double *im = ARRAY(double, 3 * (int64_t)mesh->n_faces);
    must(ctx, qc_tangent_frames(ctx, mesh, re, im));
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const int k = hypot(re[3 * t], im[3 * t]) < 0.5;
        x[t] = (qc_complex){re[3 * t + k], im[3 * t + k]};
    }
    free(re);
    free(im);
}

static inline setting *aligned_setting(qc_ctx *ctx, const aligned_case *c, double quads) {
    const surface_case surface = {c->shape, c->resolution, 0, 0, SMOOTH};
    qc_mesh *mesh = c->shape ? case_mesh(ctx, &surface) : plate(ctx, c->resolution, c->hole);
    if (c->scale != 1) mesh = scaled(ctx, mesh, c->scale);
    uint8_t *edge = feature_edges(ctx, c, mesh);
    qc_complex *x = ARRAY(qc_complex, mesh->n_faces);
    double *weight = ARRAY(double, mesh->n_faces);
    uint8_t *trusted = ARRAY(uint8_t, mesh->n_faces);
    qc_face_field *field = NULL;
    qc_matching *matching = NULL;
    if (c->circles)
        meridians(ctx, mesh, x);
    else
        along_axes(ctx, mesh, x);
    must(ctx, qc_field_align(ctx, mesh, edge, INFINITY, x, weight, trusted));
    must(ctx, qc_face_field_create(ctx, mesh, x, NULL, NULL, &field));
    must(ctx, qc_face_field_set_aligned(ctx, field, edge, 0));
    must(ctx, qc_matching_create(ctx, field, NULL, &matching));
    qc_object_release(field);
    free(edge);
    free(x);
    free(weight);
    free(trusted);
    return setting_of(ctx, mesh, matching, quads);
}

#endif
