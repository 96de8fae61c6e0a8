/* Gaps of creases closed by hysteresis, as in Canny's edge detector, and zigzags cut short
 * (docs/theory/features.md, K.0). */
#include "sdk/mesh/feature_chains.h"

/* Angle between two sides of a face below which a crease has no corner there. */
#define CORNER_MIN (75 * 3.14159265358979323846 / 180)

typedef qc__feature_network network;

/* The sharpest weak edge at v which leads on from edge e within 60 degrees, -1 = none. */
static int32_t weak_edge(const network *w, double weak, int32_t v, int32_t e) {
    double in[3], out[3], best = weak;
    int32_t found = -1;
    qc__edge_direction(w->mesh, e, v, in);
    for (int32_t k = -1, f; (f = qc__next_edge(w->mesh, v, &k)) >= 0;) {
        if (f == e || w->edge[f] || w->of[f] >= 0 || !(w->crease[f] > best)) continue;
        qc__edge_direction(w->mesh, f, v, out);
        const double product = in[0] * out[0] + in[1] * out[1] + in[2] * out[2];
        if (!(-product > 0.5 * qc__norm3(in) * qc__norm3(out))) continue;
        best = w->crease[f];
        found = f;
    }
    return found;
}

/* Follows weak edges from the free end v of edge e; they become a crease when another feature is
 * met. path: n_edges scratch. */
static void close_gap(network *w, double weak, int32_t v, int32_t e, int32_t *path) {
    int32_t n = 0;
    bool met = false;
    while (!met && (e = weak_edge(w, weak, v, e)) >= 0) {
        path[n++] = e;
        w->of[e] = 0; /* not twice */
        v = qc__other_end(w->mesh, e, v);
        met = w->degree[v] > 0;
    }
    for (int32_t i = 0; i < n; i++) {
        w->of[path[i]] = -1;
        if (met) w->edge[path[i]] = QC_FEATURE_CREASE;
    }
}

static qc_status close_gaps(qc_ctx *ctx, network *w, double weak) {
    const qc_mesh *mesh = w->mesh;
    int32_t *path = QC__NEW(ctx, int32_t, mesh->n_edges);
    if (!path) return QC_ERR_NOMEM;
    qc__count_feature_degrees(w);
    for (int32_t e = 0; e < mesh->n_edges; e++) w->of[e] = -1;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (w->degree[v] != 1) continue;
        int32_t end = -1;
        for (int32_t k = -1, f; (f = qc__next_edge(mesh, v, &k)) >= 0;)
            if (w->edge[f]) end = f;
        if (end >= 0 && w->edge[end] == QC_FEATURE_CREASE) close_gap(w, weak, v, end, path);
    }
    qc__free(path);
    return QC_OK;
}

/* A crease which takes two sides of a face, turning by more than 105 degrees, zigzags: it takes the
 * third one. */
static void cut_corners(network *w) {
    const qc_mesh *mesh = w->mesh;
    qc__count_feature_degrees(w);
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) {
        const int32_t a = mesh->halfedge_edge[qc_prev(c)], b = mesh->halfedge_edge[qc_next(c)];
        const int32_t across = mesh->halfedge_edge[c], v = mesh->face_vertex[c];
        if (w->edge[a] != QC_FEATURE_CREASE || w->edge[b] != QC_FEATURE_CREASE || w->edge[across] ||
            w->degree[v] != 2 || !(w->angle[c] < CORNER_MIN))
            continue;
        w->edge[a] = w->edge[b] = 0;
        w->edge[across] = QC_FEATURE_CREASE;
        w->degree[v] = 0;
    }
}

qc_status qc__close_feature_gaps(qc_ctx *ctx, network *w, double weak) {
    const qc_status status = close_gaps(ctx, w, weak);
    if (status == QC_OK) cut_corners(w);
    return status;
}
