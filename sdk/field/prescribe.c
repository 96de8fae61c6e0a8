/* Indices to be prescribed where singularities are crowded (see crowd.h). */
#include "crowd.h"

typedef struct prescription {
    qc__crowd *crowd;
    double *theta;   /* n_edges */
    int32_t *index4; /* n_vertices: what crowd->index4 points to */
} prescription;

/* Moves a quarter of index over edge e, from its end p to the other, which is returned: theta turns
 * by pi/2. */
static int32_t move_quarter(const prescription *s, int32_t e, int32_t p) {
    int32_t h = s->crowd->mesh->edge_halfedge[2 * e];
    bool ends = qc_halfedge_end(s->crowd->mesh, h) == p;
    int32_t q = ends ? qc_halfedge_start(s->crowd->mesh, h) : qc_halfedge_end(s->crowd->mesh, h);
    s->theta[e] += ends ? -QC__PI / 2 : QC__PI / 2;
    s->index4[p]--;
    s->index4[q]++;
    return q;
}

/* Shares the excess of p among regular neighbours. */
static void spread_index(const prescription *s, int32_t p) {
    const qc_mesh *mesh = s->crowd->mesh;
    int32_t first = mesh->vertex_corner[p], c = first;
    do {
        int32_t excess = qc__index_excess(s->index4[p]), q = mesh->face_vertex[qc_next(c)];
        int32_t e = mesh->halfedge_edge[qc_prev(c)];
        if (excess && s->index4[q] == 0 && !qc_vertex_on_boundary(mesh, q) &&
            !(s->crowd->barred && s->crowd->barred[q]))
            move_quarter(s, e, s->index4[p] > 0 ? p : q);
        c = qc_corner_ccw(mesh, c);
    } while (c >= 0 && c != first);
}

void qc__crowd_prescribe(qc__crowd *crowd, double distance, double *theta, int32_t *index4) {
    const prescription s = {crowd, theta, index4};
    const int32_t n_vertices = crowd->mesh->n_vertices;
    for (int32_t p = 0; p < n_vertices; p++) {
        int32_t q, b = p, n = index4[p] > 0 ? qc__crowd_path(crowd, p, distance, &q) : 0;
        for (int32_t i = n - 1; i >= 0; i--) b = move_quarter(&s, crowd->ball[i], b);
    }
    for (int32_t p = 0; p < n_vertices; p++)
        if (qc__index_excess(index4[p])) spread_index(&s, p);
}
