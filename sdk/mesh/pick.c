/* What rays meet on a mesh, with the nearest corner and the nearest feature edge. */
#include <math.h>
#include <qc/ray.h>
#include <string.h>

#include "sdk/mesh/internal.h"

static double distance(const double *a, const double *b) {
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* Feature edges as degenerate triangles, so that the closest-point search finds the nearest one. */
typedef struct edge_tree {
    const qc_closest_point *closest;
    qc_closest_tree *tree;
    int32_t *edge; /* number in the mesh */
} edge_tree;

static qc_status edge_tree_create(qc_ctx *ctx, const qc_mesh *mesh, const qc_features *features,
                                  edge_tree *out) {
    if (!features || features->n_feature_edges == 0) return QC_OK;
    int32_t n = 0;
    out->edge = QC__NEW(ctx, int32_t, mesh->n_edges);
    int32_t *corner = QC__NEW(ctx, int32_t, 3 * (int64_t)mesh->n_edges);
    qc_status status = out->edge && corner ? QC_OK : QC_ERR_NOMEM;
    for (int32_t e = 0; status == QC_OK && e < mesh->n_edges; e++) {
        if (!features->edge[e]) continue;
        corner[3 * (size_t)n] = mesh->edge_vertex[2 * (size_t)e];
        corner[3 * (size_t)n + 1] = corner[3 * (size_t)n + 2] =
            mesh->edge_vertex[2 * (size_t)e + 1];
        out->edge[n++] = e;
    }
    if (status == QC_OK && n > 0)
        status = out->closest->build(out->closest, ctx, n, mesh->position, corner, &out->tree);
    qc__free(corner);
    return status;
}

static void fill(const qc_mesh *mesh, const edge_tree *edges, const double *ray, qc_pick *p) {
    p->vertex_distance = INFINITY;
    for (int k = 0; k < 3; k++) p->point[k] = ray[k] + p->t * ray[3 + k];
    for (int k = 0; k < 3; k++) {
        const int32_t v = mesh->face_vertex[3 * (size_t)p->face + (size_t)k];
        const double d = distance(p->point, mesh->position + 3 * (size_t)v);
        if (!(d < p->vertex_distance)) continue;
        p->vertex_distance = d;
        p->vertex = v;
    }
    if (!edges->tree) return;
    int32_t nearest = 0;
    double weight[3];
    p->feature_distance = edges->closest->query(edges->tree, p->point, &nearest, weight);
    p->feature_edge = edges->edge[nearest];
}

qc_status qc_mesh_pick(qc_ctx *ctx, const qc_mesh *mesh, const qc_features *features,
                       const qc_ray_caster *casts, const qc_closest_point *closest, int32_t n,
                       const double *ray, qc_pick *pick) {
    if (features && features->mesh != mesh)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "pick: the features are those of another mesh");
    if (!casts) casts = &qc_ray_caster_builtin;
    edge_tree edges = {closest ? closest : &qc_closest_point_builtin, NULL, NULL};
    qc_ray_scene *scene = NULL;
    qc_status status =
        casts->build(casts, ctx, mesh->n_faces, mesh->position, mesh->face_vertex, &scene);
    if (status == QC_OK) status = edge_tree_create(ctx, mesh, features, &edges);
    for (int32_t i = 0; status == QC_OK && i < n; i++) {
        const double *r = ray + 6 * (size_t)i;
        qc_pick p = {.face = -1, .vertex = -1, .feature_edge = -1};
        p.t = casts->query(scene, r, r + 3, &p.face, p.weight);
        if (p.face >= 0) fill(mesh, &edges, r, &p);
        pick[i] = p;
    }
    casts->destroy(scene);
    edges.closest->destroy(edges.tree);
    qc__free(edges.edge);
    return status;
}
