/* Refines a mesh until fields and maps have room. Hard features: an edge between two vertices on
 * features whose images lie on one isoline would have to be mapped to it too, and a face with two
 * feature edges cannot follow both. Spikes: the index of a vertex is its curvature and the turning
 * of the field over its edges, each by at most an eighth of a turn with the nearest matching
 * (thesis 3.1), so that few edges force an index on it which no vertex of a quad mesh has. */
#include "refine.h"

#include <string.h>

/* Part of an eighth of a turn which a smooth field may turn by at every edge of a vertex. */
static const double most_turning = 0.35;

/* Edges opposite interior vertices whose index could not become one from -2/4 to 1/4: bisected they
 * double the valence. Vertices on hard features have sectors instead. */
static void mark_spikes(const qc_features *f, const double *gauss, const int32_t *valence,
                        uint8_t *split) {
    const qc_mesh *mesh = f->mesh;
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) {
        const int32_t v = mesh->face_vertex[c];
        if (qc_vertex_on_boundary(mesh, v) || (f->hard && f->vertex[v])) continue;
        const double quarters = gauss[v] * 2 / QC__PI;
        const double excess = quarters > 0 ? quarters - 1 : -2 - quarters;
        if (excess > 0.5 * most_turning * valence[v]) split[mesh->halfedge_edge[c]] = 1;
    }
}

static qc_status find_spikes(qc_ctx *ctx, const qc_features *f, uint8_t *split) {
    const qc_mesh *mesh = f->mesh;
    double *gauss = QC__NEW(ctx, double, mesh->n_vertices);
    int32_t *valence = QC__ZERO(ctx, int32_t, mesh->n_vertices);
    qc_status status = gauss && valence
                           ? qc_mesh_geometry(ctx, mesh, NULL, NULL, NULL, NULL, NULL, gauss)
                           : QC_ERR_NOMEM;
    if (!status) {
        for (int32_t c = 0; c < 3 * mesh->n_faces; c++) valence[mesh->face_vertex[c]]++;
        mark_spikes(f, gauss, valence, split);
    }
    qc__free(gauss);
    qc__free(valence);
    return status;
}

/* Edges between features, and those of faces with three feature edges. */
static void mark_features(const qc_features *f, uint8_t *split) {
    const qc_mesh *mesh = f->mesh;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        if (!f->edge[e] && f->vertex[mesh->edge_vertex[2 * e]] &&
            f->vertex[mesh->edge_vertex[2 * e + 1]])
            split[e] = 1;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const int32_t *e = mesh->halfedge_edge + 3 * t;
        if (!f->edge[e[0]] || !f->edge[e[1]] || !f->edge[e[2]]) continue;
        for (int k = 0; k < 3; k++) split[e[k]] = 1;
    }
}

static qc_status split_once(qc_ctx *ctx, const qc_features *f, const qc_sizing *sizing,
                            const uint8_t *split, qc_features **features_out,
                            qc_sizing **sizing_out) {
    qc__refinement b = {NULL, NULL, NULL, NULL};
    qc_features *features = NULL;
    qc_status status = qc__bisect_edges(ctx, f->mesh, split, &b);
    if (status) return status;
    uint8_t *edge = QC__NEW(ctx, uint8_t, b.mesh->n_edges);
    status = edge ? QC_OK : QC_ERR_NOMEM;
    if (!status) {
        qc__refinement_flags(&b, f->mesh, f->edge, edge);
        status = qc_features_create(ctx, b.mesh, edge, f->hard, &features);
        if (!status) features->bend = f->bend;
    }
    if (!status && sizing) status = qc__refinement_sizing(ctx, &b, sizing, sizing_out);
    if (status)
        qc_object_release(features);
    else
        *features_out = features;
    qc__free(edge);
    qc__refinement_free(&b);
    return status;
}

/* Replaces both by those on the refined mesh. *done: nothing was left to split. */
static qc_status refine(qc_ctx *ctx, qc_features **features, qc_sizing **sizing, bool *done) {
    const int32_t n_edges = (*features)->mesh->n_edges;
    uint8_t *split = QC__ZERO(ctx, uint8_t, n_edges);
    if (!split) return QC_ERR_NOMEM;
    qc_features *new_features = NULL;
    qc_sizing *new_sizing = NULL;
    if ((*features)->hard) mark_features(*features, split);
    qc_status status = find_spikes(ctx, *features, split);
    *done = n_edges == 0 || !memchr(split, 1, (size_t)n_edges);
    if (!status && !*done)
        status = split_once(ctx, *features, *sizing, split, &new_features, &new_sizing);
    qc__free(split);
    if (status || *done) return status;
    qc_object_release(*features);
    qc_object_release(*sizing);
    *features = new_features;
    *sizing = new_sizing;
    return QC_OK;
}

qc_status qc_features_split(qc_ctx *ctx, const qc_features *features, const qc_sizing *sizing,
                            qc_mesh **mesh, qc_features **features_out, qc_sizing **sizing_out) {
    if (sizing && sizing->mesh != features->mesh)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "the sizing and the features are of different meshes");
    qc_features *f = qc_object_retain(features);
    qc_sizing *s = sizing ? qc_object_retain(sizing) : NULL;
    bool done = false;
    qc_status status = QC_OK;
    while (!status && !done) {
        status = refine(ctx, &f, &s, &done);
        if (!status && !qc__progress(ctx, 0.5)) status = QC_ERR_CANCELLED;
    }
    if (status) {
        qc_object_release(f);
        qc_object_release(s);
        return status;
    }
    *mesh = qc_object_retain(f->mesh);
    *features_out = f;
    if (sizing) *sizing_out = s;
    return QC_OK;
}
