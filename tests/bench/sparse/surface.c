/* The surfaces of the benchmark: a file, its cross field as the default pipeline makes it (thesis
 * 5.1, 5.2), and finer versions by midpoint subdivision. */
#include "bench.h"

#include <math.h>
#include <qc/shape.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Without a file: about 1000 faces. */
static qc_mesh *read_surface(qc_ctx *ctx, const char *path) {
    qc_mesh *mesh = NULL;
    if (!path) {
        qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
        options.resolution = 1000;
        options.retriangulate = 1;
        options.noise = 0.1;
        bench_check(ctx, qc_shape_create(ctx, "genus", &options, &mesh));
        return mesh;
    }
    qc_polygon_mesh *soup = NULL;
    qc_repair_report *report = NULL;
    bench_check(ctx, qc_polygon_mesh_read(ctx, path, &soup));
    bench_check(ctx, qc_mesh_repair(ctx, soup, &mesh, &report));
    qc_object_release(soup);
    qc_object_release(report);
    return mesh;
}

/* Stages qc.field.curvature and qc.field.smooth with their defaults for 10000 quads. */
static qc_face_field *smooth_field(qc_ctx *ctx, const qc_mesh *mesh) {
    const double quad = sqrt(mesh->area / 10000);
    const int32_t F = mesh->n_faces;
    qc_complex *x = NEW(qc_complex, F), *guide = NEW(qc_complex, F);
    double *kappa = NEW(double, 2 * F), *weight = NEW(double, F);
    uint8_t *trusted = NEW(uint8_t, F);
    qc_features *features = NULL;
    qc_face_field *field = NULL;
    bench_check(ctx, qc_features_detect(ctx, mesh, 35 * acos(-1) / 180, 0, NULL, &features));
    bench_check(ctx, qc_field_curvature(ctx, mesh, QC_CURVATURE_COHEN_STEINER_MORVAN,
                                        fmax(2 * mesh->mean_edge_length, 1.5 * quad), x, kappa));
    bench_check(ctx, qc_field_stability(ctx, mesh, x, kappa, weight));
    bench_check(ctx, qc_field_align(ctx, mesh, features->edge, 2, x, weight, trusted));
    bench_check(ctx, qc_field_extend(ctx, mesh, weight, 0.3, x, trusted));
    memcpy(guide, x, (size_t)F * sizeof *x);
    bench_check(ctx, qc_field_smoothest(ctx, mesh, weight, trusted, 1, 0.5 * quad, x));
    bench_check(ctx, qc_field_smooth(ctx, mesh, guide, weight, trusted, 0.5, 20, x));
    bench_check(ctx, qc_field_separate(ctx, mesh, 0.7 * quad, trusted, x, NULL));
    bench_check(ctx, qc_face_field_create(ctx, mesh, x, NULL, NULL, &field));
    free(x);
    free(guide);
    free(kappa);
    free(weight);
    free(trusted);
    qc_object_release(features);
    return field;
}

static qc_face_field *cached_field(qc_ctx *ctx, const qc_mesh *mesh, const char *path,
                                   const char *cache) {
    if (!cache || !path) return smooth_field(ctx, mesh);
    const char *slash = strrchr(path, '/');
    char file[1024];
    snprintf(file, sizeof file, "%s/%s.rosy", cache, slash ? slash + 1 : path);
    qc_face_field *field = NULL;
    if (access(file, R_OK) == 0) {
        bench_check(ctx, qc_face_field_read(ctx, mesh, file, &field));
        return field;
    }
    field = smooth_field(ctx, mesh);
    bench_check(ctx, qc_face_field_write(ctx, field, file));
    return field;
}

/* Halfedge 0 of the parts at the corners is parallel to that of the face, of the middle part
 * opposite to it. */
static qc_face_field *subdivide(qc_ctx *ctx, const qc_face_field *coarse) {
    const qc_mesh *m = coarse->mesh;
    double *position = NEW(double, 3 * (m->n_vertices + m->n_edges));
    int32_t(*face)[3] = bench_alloc(4 * (size_t)m->n_faces, sizeof *face);
    qc_complex *x = NEW(qc_complex, 4 * m->n_faces);
    memcpy(position, m->position, 3 * (size_t)m->n_vertices * sizeof *position);
    for (int32_t e = 0; e < m->n_edges; e++)
        for (int c = 0; c < 3; c++)
            position[3 * (m->n_vertices + e) + c] =
                0.5 * (m->position[3 * m->edge_vertex[2 * e] + c] +
                       m->position[3 * m->edge_vertex[2 * e + 1] + c]);
    for (int32_t t = 0; t < m->n_faces; t++) {
        const int32_t *v = m->face_vertex + 3 * t, *e = m->halfedge_edge + 3 * t;
        const int32_t a = m->n_vertices + e[0], b = m->n_vertices + e[1], c = m->n_vertices + e[2];
        const int32_t part[4][3] = {{v[0], c, b}, {c, v[1], a}, {b, a, v[2]}, {a, b, c}};
        memcpy(face[4 * t], part, sizeof part);
        for (int k = 0; k < 4; k++) x[4 * t + k] = qc_quarter_turn(coarse->x[t], k == 3 ? 2 : 0);
    }
    qc_mesh *fine = NULL;
    qc_face_field *field = NULL;
    bench_check(ctx, qc_mesh_create(ctx, m->n_vertices + m->n_edges, position, 4 * m->n_faces,
                                    face[0], &fine));
    bench_check(ctx, qc_face_field_create(ctx, fine, x, NULL, NULL, &field));
    qc_object_release(fine);
    free(position);
    free(face);
    free(x);
    return field;
}

qc_matching *bench_surface(qc_ctx *ctx, const char *path, int32_t levels, const char *cache) {
    qc_mesh *mesh = read_surface(ctx, path);
    qc_face_field *field = cached_field(ctx, mesh, path, cache);
    qc_object_release(mesh);
    for (int32_t i = 0; i < levels; i++) {
        qc_face_field *fine = subdivide(ctx, field);
        qc_object_release(field);
        field = fine;
    }
    qc_matching *matching = NULL;
    bench_check(ctx, qc_matching_create(ctx, field, NULL, &matching));
    qc_object_release(field);
    return matching;
}
