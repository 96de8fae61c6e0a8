/* The surfaces of the benchmarks: a file or a generated shape, its cross field as the default
 * pipeline makes it (thesis 5.1, 5.2), and finer versions by midpoint subdivision. */
#include "tests/bench/common/common.h"

#include <math.h>
#include <qc/remesh.h>
#include <qc/shape.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static qc_polygon_mesh *generate(qc_ctx *ctx) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    qc_mesh *mesh = NULL;
    qc_polygon_mesh *soup = NULL;
    options.resolution = 1000;
    options.retriangulate = 1;
    options.noise = 0.1;
    bench_check(ctx, qc_shape_create(ctx, "genus", &options, &mesh));
    bench_check(ctx, qc_polygon_mesh_create(ctx, mesh->n_vertices, mesh->n_faces, 3 * mesh->n_faces,
                                            0, 0, 0, &soup));
    memcpy(soup->position, mesh->position, 3 * (size_t)mesh->n_vertices * sizeof(double));
    memcpy(soup->face_vertex, mesh->face_vertex, 3 * (size_t)mesh->n_faces * sizeof(int32_t));
    for (int32_t t = 0; t <= mesh->n_faces; t++) soup->face_offset[t] = 3 * t;
    qc_object_release(mesh);
    return soup;
}

qc_polygon_mesh *bench_read(qc_ctx *ctx, const char *path) {
    qc_polygon_mesh *soup = NULL;
    if (!path) return generate(ctx);
    bench_check(ctx, qc_polygon_mesh_read(ctx, path, &soup));
    return soup;
}

void bench_stem(const char *path, size_t size, char *out) {
    const char *slash = path ? strrchr(path, '/') : NULL;
    const char *name = slash ? slash + 1 : path ? path : "generated";
    snprintf(out, size, "%.*s", (int)strcspn(name, ".:"), name);
}

/* field: file to use instead of a computed field, or NULL. */
static qc_matching *coarse_matching(qc_ctx *ctx, const bench_source *source, const char *field) {
    qc_default_pipeline_options options = QC_DEFAULT_PIPELINE_OPTIONS_INIT;
    qc_registry *registry = NULL;
    qc_pipeline *pipeline = NULL;
    qc_bag *bag = NULL;
    qc_polygon_mesh *input = bench_read(ctx, source->path);
    options.quads = source->quads;
    options.field_path = field;
    bench_check(ctx, qc_registry_create(ctx, &registry));
    bench_check(ctx, qc_default_pipeline(ctx, registry, &options, &pipeline));
    bench_check(ctx, qc_bag_create(ctx, &bag));
    bench_check(ctx, qc_bag_put(bag, "input", input));
    uint32_t end = 0;
    while (strcmp(qc_pipeline_step_name(pipeline, end), "matching") != 0) end++;
    bench_check(ctx, qc_pipeline_run_range(pipeline, 0, end + 1, bag));
    const qc_matching *matching = qc_bag_latest(bag, QC_TYPE_MATCHING);
    qc_matching *result = qc_object_retain(matching);
    qc_object_release(input);
    qc_bag_free(bag);
    qc_pipeline_free(pipeline);
    qc_registry_free(registry);
    return result;
}

static qc_matching *cached_matching(qc_ctx *ctx, const bench_source *source) {
    if (!source->cache || !source->path) return coarse_matching(ctx, source, NULL);
    char stem[64], file[1024];
    bench_stem(source->path, sizeof stem, stem);
    snprintf(file, sizeof file, "%s/%s-%.0f.rosy", source->cache, stem, source->quads);
    if (access(file, R_OK) == 0) return coarse_matching(ctx, source, file);
    qc_matching *matching = coarse_matching(ctx, source, NULL);
    bench_check(ctx, qc_face_field_write(ctx, matching->field, file));
    return matching;
}

static qc_mesh *subdivided_mesh(qc_ctx *ctx, const qc_mesh *m) {
    double *position = NEW(double, 3 * (m->n_vertices + m->n_edges));
    int32_t(*face)[3] = bench_alloc(4 * (size_t)m->n_faces, sizeof *face);
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
    }
    qc_mesh *fine = NULL;
    bench_check(ctx, qc_mesh_create(ctx, m->n_vertices + m->n_edges, position, 4 * m->n_faces,
                                    face[0], &fine));
    free(position);
    free(face);
    return fine;
}

/* Halfedge 0 of the parts at the corners is parallel to that of the face, of the middle part
 * opposite to it. */
static qc_matching *subdivide(qc_ctx *ctx, const qc_face_field *coarse) {
    const int32_t F = coarse->mesh->n_faces;
    qc_mesh *mesh = subdivided_mesh(ctx, coarse->mesh);
    qc_complex *x = NEW(qc_complex, 4 * F);
    double *weight = NEW(double, 4 * F);
    uint8_t *trusted = NEW(uint8_t, 4 * F);
    for (int32_t i = 0; i < 4 * F; i++) {
        x[i] = qc_quarter_turn(coarse->x[i / 4], i % 4 == 3 ? 2 : 0);
        if (coarse->weight) weight[i] = coarse->weight[i / 4];
        if (coarse->trusted) trusted[i] = coarse->trusted[i / 4];
    }
    qc_face_field *field = NULL;
    qc_matching *matching = NULL;
    bench_check(ctx, qc_face_field_create(ctx, mesh, x, coarse->weight ? weight : NULL,
                                          coarse->trusted ? trusted : NULL, &field));
    bench_check(ctx, qc_matching_create(ctx, field, NULL, &matching));
    qc_object_release(field);
    qc_object_release(mesh);
    free(x);
    free(weight);
    free(trusted);
    return matching;
}

qc_matching *bench_surface(qc_ctx *ctx, const bench_source *source) {
    qc_matching *matching = cached_matching(ctx, source);
    for (int32_t i = 0; i < source->levels; i++) {
        qc_matching *fine = subdivide(ctx, matching->field);
        qc_object_release(matching);
        matching = fine;
    }
    return matching;
}

qc_sizing *bench_sizing(qc_ctx *ctx, const qc_mesh *mesh, double quads) {
    qc_sizing *sizing = NULL;
    bench_check(ctx, qc_sizing_create(ctx, mesh, sqrt(mesh->area / quads), quads, NULL, &sizing));
    return sizing;
}
