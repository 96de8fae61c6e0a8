/* Frees crowded singularities of the alignment which holds them together: a few faces around them,
 * more in each round, are solved for again by smoothness alone (Knoeppel et al. 2013; flow of
 * Viertel and Osting 2019), which cancels opposite neighbours and spreads the index of a vertex
 * over several. Pairs which the curvature of a spike of the mesh keeps alive are cancelled by
 * prescribing their indices. Faces beside hard features stay, and so do the sectors at their
 * vertices. */
#include "crowd.h"
#include "region.h"
#include "sdk/mesh/names.h"

#include <stdio.h>
#include <string.h>

enum { LEVELS = 5, NAMED = 8 };
enum { HARMONIC, TRANSPORTED, PRESCRIBED, WAYS };

typedef struct separator {
    const qc_mesh *mesh;
    qc__connection c;
    qc__crowd crowd;
    qc__region region;
    double distance;
    double *theta;           /* n_edges                                                    */
    int32_t *index4;         /* n_vertices                                                 */
    uint8_t *inside;         /* n_faces                                                    */
    uint8_t *seen;           /* n_vertices                                                 */
    uint8_t *kept, *hard;    /* n_faces, n_vertices: on hard features                      */
    qc_complex *x;           /* n_faces, the result                                        */
    qc__cplx *z;             /* n_faces, of the region                                     */
    int32_t *before, *after; /* n_faces: crowding of each patch                     */
} separator;

static void separator_free(separator *s) {
    void *arrays[] = {s->theta, s->index4, s->inside, s->seen,   s->kept,
                      s->hard,  s->x,      s->z,      s->before, s->after};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) qc__free(arrays[i]);
    qc__connection_free(&s->c);
    qc__crowd_free(&s->crowd);
    qc__region_free(&s->region);
}

static void measure_index(separator *s, int32_t p) {
    bool inner = !qc_vertex_on_boundary(s->mesh, p) && !s->hard[p];
    s->index4[p] = inner ? (int32_t)round(qc__vertex_index4(s->mesh, s->c.edge, s->theta, p)) : 0;
}

static void mark_features(separator *s, const uint8_t *aligned) {
    for (int32_t h = 0; h < 3 * s->mesh->n_faces; h++) {
        if (!aligned[s->mesh->halfedge_edge[h]]) continue;
        s->kept[h / 3] = 1;
        s->hard[qc_halfedge_start(s->mesh, h)] = s->hard[qc_halfedge_end(s->mesh, h)] = 1;
    }
}

static qc_status prepare(qc_ctx *ctx, separator *s, const uint8_t *aligned, const qc_complex *x) {
    size_t F = (size_t)s->mesh->n_faces, V = (size_t)s->mesh->n_vertices;
    s->theta = QC__NEW(ctx, double, s->mesh->n_edges);
    s->index4 = QC__ZERO(ctx, int32_t, V);
    s->inside = QC__ZERO(ctx, uint8_t, F);
    s->seen = QC__ZERO(ctx, uint8_t, V);
    s->kept = QC__ZERO(ctx, uint8_t, F);
    s->hard = QC__ZERO(ctx, uint8_t, V);
    s->x = QC__NEW(ctx, qc_complex, F);
    s->z = QC__NEW(ctx, qc__cplx, F);
    s->before = QC__NEW(ctx, int32_t, F);
    s->after = QC__NEW(ctx, int32_t, F);
    if (!s->theta || !s->index4 || !s->inside || !s->seen || !s->kept || !s->hard || !s->x ||
        !s->z || !s->before || !s->after)
        return QC_ERR_NOMEM;
    if (aligned) mark_features(s, aligned);
    qc_status status = qc__connection_create(ctx, s->mesh, &s->c);
    if (!status) status = qc__crowd_create(ctx, s->mesh, s->index4, s->hard, &s->crowd);
    if (!status) status = qc__region_create(ctx, s->mesh, &s->c, &s->region);
    if (status) return status;
    memcpy(s->x, x, F * sizeof *x);
    qc__field_match(ctx, s->mesh, s->c.rho, x, NULL, s->theta);
    for (int32_t p = 0; p < s->mesh->n_vertices; p++) measure_index(s, p);
    return QC_OK;
}

static void mark_fan(separator *s, int32_t p) {
    int32_t first = s->mesh->vertex_corner[p], c = first;
    do {
        s->inside[c / 3] = 1;
        c = qc_corner_ccw(s->mesh, c);
    } while (c >= 0 && c != first);
}

/* Adds all faces which meet the faces inside. */
static void widen(separator *s) {
    memset(s->seen, 0, (size_t)s->mesh->n_vertices);
    for (int32_t c = 0; c < 3 * s->mesh->n_faces; c++)
        if (s->inside[c / 3]) s->seen[s->mesh->face_vertex[c]] = 1;
    for (int32_t p = 0; p < s->mesh->n_vertices; p++)
        if (s->seen[p]) mark_fan(s, p);
}

/* The faces about all crowded vertices; false when there are none. */
static bool mark_crowds(separator *s, int level) {
    bool any = false;
    memset(s->inside, 0, (size_t)s->mesh->n_faces);
    for (int32_t p = 0; p < s->mesh->n_vertices; p++) {
        if (s->index4[p] == 0 || !qc__crowd_measure(&s->crowd, p, s->distance)) continue;
        int32_t n = qc__crowd_ball(&s->crowd, p, s->distance * (1 + level) / 2);
        for (int32_t i = 0; i < n; i++) mark_fan(s, s->crowd.ball[i]);
        any = true;
    }
    for (int i = 0; any && i < level; i++) widen(s);
    for (int32_t t = 0; t < s->mesh->n_faces; t++) s->inside[t] &= (uint8_t)!s->kept[t];
    return any;
}

/* Turning angle of an edge, as qc__field_match. */
static double edge_theta(const separator *s, int32_t e) {
    int32_t h = s->mesh->edge_halfedge[2 * e], g = s->mesh->edge_halfedge[2 * e + 1];
    if (g < 0) return 0;
    double a = qc__arg(qc__c(s->x[g / 3]) * conj(qc__c(s->c.rho[e]) * qc__c(s->x[h / 3])));
    if (a >= QC__PI) a = -QC__PI;
    return a - round(2 * a / QC__PI) * QC__PI / 2;
}

/* Angles and indices in the region after a change of x. */
static void update(separator *s) {
    const qc__region *r = &s->region;
    for (int32_t i = 0; i < r->n; i++)
        for (int32_t h = 3 * r->face[i]; h < 3 * r->face[i] + 3; h++)
            s->theta[s->mesh->halfedge_edge[h]] = edge_theta(s, s->mesh->halfedge_edge[h]);
    for (int32_t i = 0; i < r->n; i++)
        for (int32_t c = 3 * r->face[i]; c < 3 * r->face[i] + 3; c++)
            measure_index(s, s->mesh->face_vertex[c]);
}

/* Crowding of each patch. */
static void measure_patches(separator *s, int32_t *out) {
    const qc__region *r = &s->region;
    memset(out, 0, (size_t)r->n_patches * sizeof *out);
    memset(s->seen, 0, (size_t)s->mesh->n_vertices);
    for (int32_t i = 0; i < r->n; i++) {
        for (int32_t c = 3 * r->face[i]; c < 3 * r->face[i] + 3; c++) {
            int32_t p = s->mesh->face_vertex[c];
            if (s->seen[p]) continue;
            s->seen[p] = 1;
            out[r->patch[i]] += qc__crowd_measure(&s->crowd, p, s->distance);
        }
    }
}

/* Exchanges the crosses of the region with z, of the patches which did not improve only if `back`.
 */
static void swap_crosses(separator *s, bool back) {
    const qc__region *r = &s->region;
    for (int32_t i = 0; i < r->n; i++) {
        if (back && s->after[r->patch[i]] < s->before[r->patch[i]]) continue;
        qc_complex *x = s->x + r->face[i];
        qc__cplx old = qc__c(*x);
        double angle = back ? 0 : qc__arg(s->z[i]) / 4;
        *x = back ? qc__z(s->z[i]) : (qc_complex){cos(angle), sin(angle)};
        s->z[i] = old;
    }
}

static qc_status solve_region(qc_ctx *ctx, separator *s, int way) {
    const qc__region *r = &s->region;
    double length = fmax(s->distance, s->mesh->mean_edge_length);
    if (way != PRESCRIBED) return qc__region_solve(ctx, r, s->x, way == TRANSPORTED, length, s->z);
    qc__crowd_prescribe(&s->crowd, s->distance, s->theta, s->index4);
    qc_status status = qc__region_rotate(ctx, r, s->theta, s->z);
    for (int32_t i = 0; !status && i < r->n; i++) {
        double angle = 4 * creal(s->z[i]);
        s->z[i] = qc__fourth(qc__c(s->x[r->face[i]])) * (cos(angle) + sin(angle) * I);
    }
    return status;
}

static qc_status try_region(qc_ctx *ctx, separator *s, int way, uint8_t *trusted) {
    const qc__region *r = &s->region;
    qc__region_set(&s->region, s->inside);
    if (r->n == 0) return QC_OK;
    measure_patches(s, s->before);
    qc_status status = solve_region(ctx, s, way);
    if (status) return status;
    swap_crosses(s, false);
    update(s);
    measure_patches(s, s->after);
    swap_crosses(s, true);
    update(s);
    for (int32_t i = 0; trusted && i < r->n; i++)
        if (s->after[r->patch[i]] < s->before[r->patch[i]]) trusted[r->face[i]] = 0;
    return QC_OK;
}

static int32_t report(qc_ctx *ctx, const separator *s) {
    char names[NAMED * (QC__ELEMENT_NAME + 2)] = "", name[QC__ELEMENT_NAME];
    int32_t left = 0;
    for (int32_t p = 0; p < s->mesh->n_vertices; p++) {
        if (!qc__index_excess(s->index4[p])) continue;
        size_t used = strlen(names);
        if (left < NAMED)
            snprintf(names + used, sizeof names - used, "%s%s", left ? ", " : "",
                     qc__vertex_name(s->mesh, p, name));
        left++;
    }
    if (left > 0)
        qc__log(
            ctx, QC_LOG_WARNING,
            "%d vertices keep an index above 1/4 or below -2/4: %s%s; quads there may degenerate",
            (int)left, names, left > NAMED ? ", ..." : "");
    return left;
}

static qc_status thin_out(qc_ctx *ctx, separator *s, uint8_t *trusted) {
    qc_status status = QC_OK;
    for (int i = 0; !status && i < WAYS * LEVELS && mark_crowds(s, i / WAYS); i++) {
        status = try_region(ctx, s, i % WAYS, trusted);
        if (!status && !qc__progress(ctx, 0.8 * (i + 1) / (WAYS * LEVELS)))
            status = QC_ERR_CANCELLED;
    }
    return status;
}

qc_status qc_field_separate(qc_ctx *ctx, const qc_mesh *mesh, double distance,
                            const uint8_t *aligned, uint8_t *trusted, qc_complex *x,
                            int32_t *left) {
    if (!(distance >= 0) || !isfinite(distance))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the distance %g is negative or not finite",
                        distance);
    size_t F = (size_t)mesh->n_faces;
    separator s = {.mesh = mesh, .distance = distance};
    uint8_t *kept = trusted ? QC__NEW(ctx, uint8_t, F) : NULL;
    qc_status status = kept || !trusted ? prepare(ctx, &s, aligned, x) : QC_ERR_NOMEM;
    if (!status && kept) memcpy(kept, trusted, F);
    if (!status) status = thin_out(ctx, &s, kept);
    if (!status && !qc__progress(ctx, 0.8)) status = QC_ERR_CANCELLED;
    s.distance = 0; /* pairs do not count where they stand in the way of an index */
    if (!status) status = thin_out(ctx, &s, kept);
    s.distance = status ? 0 : 1.01 * qc__crowd_lone_pair(&s.crowd);
    if (!status && s.distance > 0) status = thin_out(ctx, &s, kept);
    if (!status) {
        int32_t n = report(ctx, &s);
        if (left) *left = n;
        if (kept) memcpy(trusted, kept, F);
        memcpy(x, s.x, F * sizeof *x);
    }
    separator_free(&s);
    qc__free(kept);
    return status;
}
