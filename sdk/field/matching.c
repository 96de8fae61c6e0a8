/* Matching and indices of a cross field (thesis (5.1), signs of docs/conventions.md). */
#include "sector.h"

typedef struct matching_object {
    qc_matching matching;
    int8_t *m;
    double *theta;
    int32_t *index4;
    int8_t *axis;
} matching_object;

static void matching_destroy(qc_object *object) {
    matching_object *o = (matching_object *)object;
    qc__free(o->m);
    qc__free(o->theta);
    qc__free(o->index4);
    qc__free(o->axis);
    qc__free((void *)(uintptr_t)o->matching.pole_index4);
    qc_object_release(o->matching.field);
    qc__free(o);
}

typedef struct match_job {
    const qc_mesh *mesh;
    const qc_complex *rho, *x;
    int8_t *m;
    double *theta;
} match_job;

static double turning(const match_job *j, int32_t e) {
    int32_t s = j->mesh->edge_halfedge[2 * e] / 3, t = j->mesh->edge_halfedge[2 * e + 1] / 3;
    return qc__arg(qc__c(j->x[t]) * conj(qc__c(j->rho[e]) * qc__c(j->x[s])));
}

/* Quarter turns of vector fields. */
static void match_vectors(const match_job *j) {
    for (int32_t e = 0; e < j->mesh->n_edges; e++) {
        const bool inside = j->mesh->edge_halfedge[2 * e + 1] >= 0;
        j->m[e] = 0;
        j->theta[e] = inside ? turning(j, e) : 0;
    }
}

static void match_edges(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const match_job *j = arg;
    (void)worker;
    for (int32_t e = (int32_t)begin; e < (int32_t)end; e++) {
        bool inside = j->mesh->edge_halfedge[2 * e + 1] >= 0;
        double a = inside ? turning(j, e) : 0;
        if (a >= QC__PI) a = -QC__PI;
        double m = round(2 * a / QC__PI);
        if (j->m) j->m[e] = (int8_t)m;
        if (j->theta) j->theta[e] = a - m * QC__PI / 2;
    }
}

void qc__field_match(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *rho, const qc_complex *x,
                     int8_t *m, double *theta) {
    match_job job = {mesh, rho, x, m, theta};
    qc__parallel_for(ctx, mesh->n_edges, 8192, match_edges, &job);
}

/* A given matching keeps its turns; theta is then any angle. */
static void measure_given(const qc_mesh *mesh, const qc_complex *rho, const qc_complex *x,
                          const int8_t *m, double *theta) {
    match_job job = {mesh, rho, x, NULL, NULL};
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        bool inside = mesh->edge_halfedge[2 * e + 1] >= 0;
        theta[e] = inside ? turning(&job, e) - m[e] * QC__PI / 2 : 0;
    }
}

/* (K(p) + sum of +-theta) / (2 pi) in quarters; +theta where s -> t is counter-clockwise about p.
 */
double qc__vertex_index4(const qc_mesh *mesh, const qc_complex *edge, const double *theta,
                         int32_t p) {
    int32_t first = mesh->vertex_corner[p], c = first;
    double sum = 2 * QC__PI;
    do {
        int32_t h = qc_next(c), e = mesh->halfedge_edge[h];
        sum -= qc__corner_angle(edge, c);
        sum += mesh->edge_halfedge[2 * e] == h ? theta[e] : -theta[e];
        c = qc_corner_ccw(mesh, c);
    } while (c != first);
    return 2 * sum / QC__PI;
}

static qc_status measure_indices(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *edge,
                                 matching_object *o) {
    int64_t sum = 0;
    for (int32_t p = 0; p < mesh->n_vertices; p++) {
        o->index4[p] = 0;
        if (qc_vertex_on_boundary(mesh, p)) continue;
        double index = qc__vertex_index4(mesh, edge, o->theta, p), rounded = round(index);
        if (!(fabs(index - rounded) < 0.1))
            return qc__fail(ctx, QC_ERR_FAILED, p,
                            "the index %g/4 of vertex %d is no multiple of 1/4: repair the mesh "
                            "(degenerate faces around it)",
                            index, (int)p);
        o->index4[p] = (int32_t)rounded;
        o->matching.n_singular += rounded != 0;
        sum += o->index4[p];
    }
    o->matching.index4_sum = (int32_t)sum;
    if (mesh->n_boundary_edges == 0 && sum != 4 * (int64_t)mesh->euler)
        return qc__fail(ctx, QC_ERR_FAILED, -1,
                        "the indices sum to %d/4 instead of the Euler characteristic %d", (int)sum,
                        (int)mesh->euler);
    return QC_OK;
}

/* Which direction of the cross the hard features follow. */
static void measure_axes(const qc_face_field *field, const qc_complex *edge, int8_t *axis) {
    const qc_mesh *mesh = field->mesh;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[2 * e];
        axis[e] = field->aligned[e] ? (int8_t)qc__axis(edge[h], field->x[h / 3]) : -1;
    }
}

static qc_status fill(qc_ctx *ctx, const qc_face_field *field, const int8_t *m,
                      matching_object *o) {
    const qc_mesh *mesh = field->mesh;
    qc_complex *edge = QC__NEW(ctx, qc_complex, 3 * (size_t)mesh->n_faces);
    qc_complex *rho = QC__NEW(ctx, qc_complex, mesh->n_edges);
    qc_status status = edge && rho ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_tangent_edges(ctx, mesh, edge);
    if (!status) status = qc_tangent_transport(ctx, mesh, edge, rho);
    if (!status) {
        if (m) {
            for (int32_t e = 0; e < mesh->n_edges; e++)
                o->m[e] = mesh->edge_halfedge[2 * e + 1] >= 0 ? m[e] : 0;
            measure_given(mesh, rho, field->x, o->m, o->theta);
        } else if (field->is_vector) {
            const match_job job = {mesh, rho, field->x, o->m, o->theta};
            match_vectors(&job);
        } else {
            qc__field_match(ctx, mesh, rho, field->x, o->m, o->theta);
            if (o->axis)
                status = qc__sectors_open(ctx, mesh, field->aligned, field->bend, edge, o->theta,
                                          o->m, NULL);
        }
        if (o->axis) measure_axes(field, edge, o->axis);
        if (!status) status = measure_indices(ctx, mesh, edge, o);
    }
    qc__free(edge);
    qc__free(rho);
    return status;
}

qc_status qc_matching_create(qc_ctx *ctx, const qc_face_field *field, const int8_t *m,
                             qc_matching **out) {
    const qc_mesh *mesh = field->mesh;
    matching_object *o = QC__ZERO(ctx, matching_object, 1);
    if (!o) return QC_ERR_NOMEM;
    qc_object_init(&o->matching.object, QC_TYPE_MATCHING, matching_destroy);
    o->matching.field = qc_object_retain(field);
    o->m = QC__NEW(ctx, int8_t, mesh->n_edges);
    o->theta = QC__NEW(ctx, double, mesh->n_edges);
    o->index4 = QC__NEW(ctx, int32_t, mesh->n_vertices);
    if (field->aligned) o->axis = QC__NEW(ctx, int8_t, mesh->n_edges);
    qc_status status =
        o->m && o->theta && o->index4 && (o->axis || !field->aligned) ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = fill(ctx, field, m, o);
    if (status) {
        qc_object_release(&o->matching);
        return status;
    }
    o->matching.m = o->m;
    o->matching.theta = o->theta;
    o->matching.index4 = o->index4;
    o->matching.axis = o->axis;
    *out = &o->matching;
    return QC_OK;
}
