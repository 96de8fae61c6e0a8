/* Creases at the length scale of a quad: how much the surface bends at an edge beyond what it bends
 * anyway. Near an edge the normals of a side are those of the faces within a reach R of its middle:
 * n1 within R / 2, n2 beyond. With angles about the edge, those of a smooth surface grow linearly
 * with the distance, those of noise vanish on average, and that of a crease stays:
 *     J = |angle(n1 left, n1 right)| - (angle(n2, n1) left + angle(n1, n2) right) / 2,
 * the angle extrapolated to distance zero. */
#include "sdk/mesh/internal.h"

#include "sdk/mesh/crease_scale.h"

/* The reach in edges about the middle, where that is more than half a quad. */
#define REACH_EDGES 3.0

struct qc__crease_scale {
    const qc_mesh *mesh;
    double half; /* half a quad */
    double *normal, *area, *length;
    int32_t *seen; /* n_faces: last side which visited the face */
    int32_t *queue, stamp;
};

void qc__crease_scale_free(qc__crease_scale *s) {
    if (!s) return;
    void *arrays[] = {s->normal, s->area, s->length, s->seen, s->queue};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) qc__free(arrays[i]);
    qc__free(s);
}

qc_status qc__crease_scale_create(qc_ctx *ctx, const qc_mesh *mesh, double half,
                                  qc__crease_scale **out) {
    qc__crease_scale *s = QC__ZERO(ctx, qc__crease_scale, 1);
    if (!s) return QC_ERR_NOMEM;
    s->mesh = mesh;
    s->half = half;
    s->normal = QC__NEW(ctx, double, 3 * (size_t)mesh->n_faces);
    s->area = QC__NEW(ctx, double, mesh->n_faces);
    s->length = QC__NEW(ctx, double, mesh->n_edges);
    s->seen = QC__ZERO(ctx, int32_t, mesh->n_faces);
    s->queue = QC__NEW(ctx, int32_t, mesh->n_faces);
    qc_status status =
        s->normal && s->area && s->length && s->seen && s->queue ? QC_OK : QC_ERR_NOMEM;
    if (!status)
        status = qc_mesh_geometry(ctx, mesh, s->length, s->area, NULL, NULL, s->normal, NULL);
    if (status)
        qc__crease_scale_free(s);
    else
        *out = s;
    return status;
}

static double distance_to(const qc_mesh *mesh, const int32_t *vertex, int n, const double c[3]) {
    double d[3] = {-c[0], -c[1], -c[2]};
    for (int k = 0; k < n; k++)
        for (int i = 0; i < 3; i++) d[i] += mesh->position[3 * (size_t)vertex[k] + (size_t)i] / n;
    return qc__norm3(d);
}

/* Mean lengths of the edges of the faces at edge e. */
static double local_length(const qc__crease_scale *s, int32_t e) {
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        const int32_t t = s->mesh->edge_halfedge[2 * e + i] / 3;
        for (int k = 0; k < 3; k++) sum += s->length[s->mesh->halfedge_edge[3 * t + k]];
    }
    return sum / 6;
}

typedef struct side {
    double near[3], far[3]; /* sums of normals */
} side;

/* Faces on the side of halfedge h within the reach; its own chain is never crossed, other creases
 * within half a quad only. */
static side look(qc__crease_scale *s, const int32_t *chain, int32_t h, const double middle[3],
                 double reach) {
    const qc_mesh *mesh = s->mesh;
    const int32_t own = chain[mesh->halfedge_edge[h]];
    side out = {{0, 0, 0}, {0, 0, 0}};
    int32_t n = 0;
    s->stamp++;
    s->queue[n++] = h / 3;
    s->seen[h / 3] = s->stamp;
    for (int32_t i = 0; i < n; i++) {
        const int32_t t = s->queue[i];
        const double d = distance_to(mesh, mesh->face_vertex + 3 * (size_t)t, 3, middle);
        double *sum = i == 0 || d < reach / 2 ? out.near : out.far;
        for (int k = 0; k < 3; k++) sum[k] += s->area[t] * s->normal[3 * (size_t)t + (size_t)k];
        for (int32_t g = 3 * t; g < 3 * t + 3; g++) {
            const int32_t e = mesh->halfedge_edge[g], next = mesh->twin[g] / 3;
            if (mesh->twin[g] < 0 || s->seen[next] == s->stamp) continue;
            if (chain[e] >= 0 &&
                (chain[e] == own ||
                 distance_to(mesh, mesh->edge_vertex + 2 * (size_t)e, 2, middle) > s->half))
                continue;
            if (distance_to(mesh, mesh->face_vertex + 3 * (size_t)next, 3, middle) > reach)
                continue;
            s->seen[next] = s->stamp;
            s->queue[n++] = next;
        }
    }
    return out;
}

/* Angle from a to b about the axis; 0 where one of them is zero. */
static double angle_about(const double axis[3], const double a[3], const double b[3]) {
    double c[3];
    qc__cross3(a, b, c);
    const double along = qc__dot3(a, axis) * qc__dot3(b, axis);
    const double sine = qc__dot3(c, axis), cosine = qc__dot3(a, b) - along;
    return sine == 0 && cosine == 0 ? 0 : atan2(sine, cosine);
}

double qc__crease_scale_at(qc__crease_scale *s, const int32_t *chain, int32_t e) {
    const qc_mesh *mesh = s->mesh;
    const int32_t *h = mesh->edge_halfedge + 2 * (size_t)e;
    const double reach = fmax(s->half, REACH_EDGES * local_length(s, e));
    double axis[3], middle[3];
    qc__halfedge_vector(mesh, h[0], axis);
    const double length = qc__norm3(axis);
    if (!(length > 0)) return 0;
    for (int i = 0; i < 3; i++) {
        middle[i] = 0.5 * (mesh->position[3 * (size_t)mesh->edge_vertex[2 * e] + (size_t)i] +
                           mesh->position[3 * (size_t)mesh->edge_vertex[2 * e + 1] + (size_t)i]);
        axis[i] /= length;
    }
    const side a = look(s, chain, h[0], middle, reach), b = look(s, chain, h[1], middle, reach);
    const double bend = angle_about(axis, a.near, b.near), sign = bend < 0 ? -1 : 1;
    const double around =
        sign * (angle_about(axis, a.far, a.near) + angle_about(axis, b.near, b.far)) / 2;
    return fmax(0, fabs(bend) - fmax(0, around));
}
