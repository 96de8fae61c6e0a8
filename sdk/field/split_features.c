/* Refines a mesh until hard features leave a piecewise linear map room: an edge between two
 * vertices on features whose images lie on one isoline would have to be mapped to it too, and a
 * face with two feature edges cannot follow both. */
#include "refine.h"

/* Edges between features, and those of faces with three feature edges. False when there is none. */
static bool mark_edges(const qc_features *f, uint8_t *split) {
    const qc_mesh *mesh = f->mesh;
    bool any = false;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        split[e] = !f->edge[e] && f->vertex[mesh->edge_vertex[2 * e]] &&
                   f->vertex[mesh->edge_vertex[2 * e + 1]];
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const int32_t *e = mesh->halfedge_edge + 3 * t;
        if (!f->edge[e[0]] || !f->edge[e[1]] || !f->edge[e[2]]) continue;
        for (int k = 0; k < 3; k++) split[e[k]] = 1;
    }
    for (int32_t e = 0; e < mesh->n_edges && !any; e++) any = split[e];
    return any;
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
    uint8_t *split = QC__NEW(ctx, uint8_t, (*features)->mesh->n_edges);
    if (!split) return QC_ERR_NOMEM;
    qc_features *new_features = NULL;
    qc_sizing *new_sizing = NULL;
    qc_status status = QC_OK;
    *done = !mark_edges(*features, split);
    if (!*done) status = split_once(ctx, *features, *sizing, split, &new_features, &new_sizing);
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
    bool done = !features->hard;
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
