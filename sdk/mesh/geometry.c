/* Lengths, areas, cotangents, angles, normals and angle defects of a triangle mesh. Everything is
 * computed from edges divided by the longest one of the face, so that the unit of length is free.
 */
#include "sdk/mesh/internal.h"

static const double PI = 3.14159265358979323846;
static const double AREA_FLOOR = 1e-14; /* of the squared longest edge */

typedef struct triangle {
    double longest;    /* edge length; 0 = the three corners coincide                            */
    double area;       /* in units of longest^2, floored                                         */
    double dot[3];     /* of the two edges leaving corner k, same units                          */
    double cross[3];   /* of two edges; length = 2 area when not floored                         */
    double twice_area; /* |cross|                                                                */
    double edge[3][3]; /* ccw, edge k opposite corner k                                          */
} triangle;

static void triangle_of(const qc_mesh *m, int32_t f, triangle *t) {
    t->longest = 0;
    for (int k = 0; k < 3; k++) {
        qc__halfedge_vector(m, 3 * f + k, t->edge[k]);
        t->longest = fmax(t->longest, qc__norm3(t->edge[k]));
    }
    for (int k = 0; k < 3 && t->longest > 0; k++)
        for (int i = 0; i < 3; i++) t->edge[k][i] /= t->longest;
    for (int k = 0; k < 3; k++) t->dot[k] = -qc__dot3(t->edge[(k + 1) % 3], t->edge[(k + 2) % 3]);
    qc__cross3(t->edge[0], t->edge[1], t->cross);
    t->twice_area = sqrt(qc__dot3(t->cross, t->cross));
    t->area = fmax(0.5 * t->twice_area, AREA_FLOOR);
}

/* Unit normal; for a face without area some normal of its longest edge. */
static void unit_normal(const triangle *t, double out[3]) {
    if (0.5 * t->twice_area >= AREA_FLOOR) {
        for (int i = 0; i < 3; i++) out[i] = t->cross[i] / t->twice_area;
        return;
    }
    int longest = 0, axis = 0;
    for (int k = 1; k < 3; k++)
        if (qc__dot3(t->edge[k], t->edge[k]) > qc__dot3(t->edge[longest], t->edge[longest]))
            longest = k;
    const double *e = t->edge[longest];
    for (int i = 1; i < 3; i++)
        if (fabs(e[i]) < fabs(e[axis])) axis = i;
    double unit[3] = {axis == 0, axis == 1, axis == 2};
    qc__cross3(e, unit, out);
    double length = qc__norm3(out);
    for (int i = 0; i < 3; i++) out[i] = length > 0 ? out[i] / length : i == 2;
}

static double corner_angle(const triangle *t, int k) {
    return t->longest > 0 ? atan2(t->twice_area, t->dot[k]) : PI / 3;
}

static void angle_defects(const qc_mesh *m, const double *angle, double *gauss) {
    for (int32_t v = 0; v < m->n_vertices; v++)
        gauss[v] = qc_vertex_on_boundary(m, v) ? PI : 2 * PI;
    for (int32_t c = 0; c < 3 * m->n_faces; c++) gauss[m->face_vertex[c]] -= angle[c];
}

qc_status qc_mesh_geometry(qc_ctx *ctx, const qc_mesh *m, double *length, double *area,
                           double *cotangent, double *angle, double *normal, double *gauss) {
    double *own_angle = NULL;
    if (gauss && !angle) {
        own_angle = QC__NEW(ctx, double, 3 * (size_t)m->n_faces);
        if (!own_angle) return QC_ERR_NOMEM;
        angle = own_angle;
    }
    for (int32_t e = 0; length && e < m->n_edges; e++) {
        double d[3];
        qc__halfedge_vector(m, m->edge_halfedge[2 * e], d);
        length[e] = qc__norm3(d);
    }
    for (int32_t f = 0; (area || cotangent || angle || normal) && f < m->n_faces; f++) {
        triangle t;
        triangle_of(m, f, &t);
        if (area) area[f] = t.area * t.longest * t.longest;
        if (normal) unit_normal(&t, normal + 3 * (size_t)f);
        for (int k = 0; k < 3; k++) {
            size_t c = 3 * (size_t)f + (size_t)k;
            if (cotangent) cotangent[c] = 0.5 * t.dot[k] / t.area;
            if (angle) angle[c] = corner_angle(&t, k);
        }
    }
    if (gauss) angle_defects(m, angle, gauss);
    qc__free(own_angle);
    return QC_OK;
}
