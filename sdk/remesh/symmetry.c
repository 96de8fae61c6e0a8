/* The plane of symmetry of a surface, and its results made from those of one half. */
#include "sdk/remesh/symmetry.h"

#include <complex.h>
#include <qc/closest_point.h>
#include <string.h>

#include "sdk/mesh/plane.h"

/* In diagonals: a mirrored point farther from the surface shows that it is not symmetric. */
static const double tolerance = 5e-3;

/* --- what is asked for ------------------------------------------------------------------------ */

static bool parse_plane(const char *text, qc_plane *out) {
    double x[4];
    for (int i = 0; i < 4; i++) {
        char *end;
        x[i] = qc__parse_double(text, &end);
        if (end == text || !isfinite(x[i]) || *end != (i < 3 ? ',' : '\0')) return false;
        text = end + (i < 3);
    }
    const double size = qc__norm3(x);
    if (!(size > 0)) return false;
    for (int k = 0; k < 3; k++) out->normal[k] = x[k] / size;
    out->offset = x[3] / size;
    return true;
}

qc_status qc__symmetry_parse(qc_ctx *ctx, const char *text, qc__symmetry *out) {
    static const char *const axes[] = {"x", "y", "z"};
    qc__symmetry s = {.wanted = text && strcmp(text, "off") != 0, .axis = -1};
    for (int k = 0; s.wanted && k < 3; k++)
        if (strcmp(text, axes[k]) == 0) s.axis = k;
    if (s.wanted && s.axis < 0 && strcmp(text, "auto") != 0) {
        s.given = parse_plane(text, &s.plane);
        if (!s.given)
            return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                            "the symmetry is '%s'; give auto, x, y, z, off or a plane "
                            "\"nx,ny,nz,d\"",
                            text);
    }
    *out = s;
    return QC_OK;
}

/* --- the half --------------------------------------------------------------------------------- */

static qc_status find_plane(qc_ctx *ctx, const qc__symmetry *s, const qc_mesh *mesh,
                            qc_remesh_result *result, qc_plane *plane, bool *found) {
    double off = 0;
    *plane = s->plane;
    *found = true;
    if (s->given) return QC_OK;
    const bool any = s->axis < 0;
    const qc_status status =
        qc_mesh_find_symmetry(ctx, mesh, s->axis, any ? tolerance : INFINITY, NULL, plane, &off);
    if (status != QC_OK) return status;
    *found = isfinite(off);
    if (!*found)
        return qc__warn(ctx, result,
                        "no plane of symmetry: mirrored points are farther than %g %% of the "
                        "diagonal from the surface; it is remeshed as a whole",
                        100 * tolerance);
    if (off <= tolerance) return QC_OK;
    return qc__warn(ctx, result,
                    "mirrored points are up to %.3g %% of the diagonal from the surface; the half "
                    "with larger %c is mirrored all the same",
                    100 * off, "xyz"[s->axis]);
}

qc_status qc__symmetry_cut(qc_ctx *ctx, const qc__symmetry *symmetry, const qc_mesh *mesh,
                           qc_remesh_result *result, qc_plane *plane, qc_mesh **half) {
    bool found = false;
    qc_status status = find_plane(ctx, symmetry, mesh, result, plane, &found);
    if (status != QC_OK || !found) return status;
    status = qc_mesh_half(ctx, mesh, plane, half);
    if (status == QC_ERR_FAILED || status == QC_ERR_NON_MANIFOLD) {
        status = qc__warn(ctx, result, "%s; the surface is remeshed as a whole",
                          qc_ctx_error(ctx)->text);
        qc__clear_error(ctx);
        return status;
    }
    if (status == QC_OK)
        qc__log(ctx, QC_LOG_INFO, "mirrored at the plane %g x + %g y + %g z = %g", plane->normal[0],
                plane->normal[1], plane->normal[2], plane->offset);
    return status;
}

qc_status qc__border_features(qc_ctx *ctx, const qc_mesh *half, const qc_plane *plane,
                              qc_features **out) {
    uint8_t *edge = QC__NEW(ctx, uint8_t, half->n_edges);
    if (!edge) return QC_ERR_NOMEM;
    for (int32_t e = 0; e < half->n_edges; e++)
        edge[e] = qc__on_border(half, plane, e) ? QC_FEATURE_BOUNDARY : 0;
    const qc_status status = qc_features_create(ctx, half, edge, true, out);
    qc__free(edge);
    return status;
}

/* --- the whole -------------------------------------------------------------------------------- */

/* A surface and the tree of its faces. */
typedef struct located {
    const qc_mesh *mesh;
    const qc_closest_point *closest;
    qc_closest_tree *tree;
} located;

static qc_status locate_on(qc_ctx *ctx, const qc_mesh *mesh, located *out) {
    out->mesh = mesh;
    out->closest = &qc_closest_point_builtin;
    return out->closest->build(out->closest, ctx, mesh->n_faces, mesh->position, mesh->face_vertex,
                               &out->tree);
}

static void locate_end(located *l) {
    if (l->tree) l->closest->destroy(l->tree);
}

/* Where the vertices of the quads lie on the surface. */
static qc_status set_sources(qc_ctx *ctx, const qc_mesh *mesh, qc_polygon_mesh *quads) {
    located on = {NULL, NULL, NULL};
    if (!quads->source_face) return QC_OK;
    qc_status status = locate_on(ctx, mesh, &on);
    int32_t face = 0;
    for (int32_t v = 0; status == QC_OK && v < quads->n_vertices; v++) {
        if (v % 65536 == 0 && !qc__progress(ctx, 1)) status = QC_ERR_CANCELLED;
        on.closest->query(on.tree, quads->position + 3 * (int64_t)v, &face,
                          quads->source_barycentric + 3 * (int64_t)v);
        quads->source_face[v] = mesh->source_face ? mesh->source_face[face] : face;
    }
    locate_end(&on);
    return status;
}

/* The axes of the frames of a mesh: n_faces rows of real, then imaginary axis. */
static qc_status frames(qc_ctx *ctx, const qc_mesh *mesh, double **real, double **imag) {
    *real = QC__NEW(ctx, double, 3 * (int64_t)mesh->n_faces);
    *imag = QC__NEW(ctx, double, 3 * (int64_t)mesh->n_faces);
    return *real && *imag ? qc_tangent_frames(ctx, mesh, *real, *imag) : QC_ERR_NOMEM;
}

/* The cross in a face of the surface: that of the closest face of the half, mirrored where the face
 * is on the other side; of its two directions that which is more in the plane of the face. */
typedef struct carry {
    located half;
    const qc_face_field *field;
    const qc_mesh *mesh;
    const qc_plane *plane;
    double *real, *imag, *half_real, *half_imag;
} carry;

static qc_complex carry_cross(const carry *c, int32_t t, int32_t *near) {
    double middle[3] = {0, 0, 0}, weight[3], best = -1;
    qc_complex out = {1, 0};
    const double third[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    qc__face_point(c->mesh, t, third, middle);
    const bool image = qc__plane_distance(c->plane, middle) < 0;
    double p[3] = {middle[0], middle[1], middle[2]};
    if (image) qc__mirror(c->plane, middle, p);
    c->half.closest->query(c->half.tree, p, near, weight);
    for (int k = 0; k < 2; k++) {
        const qc_complex x = c->field->x[*near];
        const qc_complex along = k ? (qc_complex){-x.im, x.re} : x;
        double d[3];
        for (int i = 0; i < 3; i++)
            d[i] = along.re * c->half_real[3 * (int64_t)*near + i] +
                   along.im * c->half_imag[3 * (int64_t)*near + i];
        const double across = image ? 2 * qc__dot3(c->plane->normal, d) : 0;
        for (int i = 0; i < 3; i++) d[i] -= across * c->plane->normal[i];
        const double re = qc__dot3(d, c->real + 3 * (int64_t)t);
        const double im = qc__dot3(d, c->imag + 3 * (int64_t)t), size = hypot(re, im);
        if (size <= best) continue;
        best = size;
        out = (qc_complex){re / size, im / size};
    }
    return out;
}

static qc_status mirror_field(qc_ctx *ctx, const qc_plane *plane, const qc_mesh *mesh,
                              const qc_face_field *field, qc_face_field **out) {
    carry c = {.field = field, .mesh = mesh, .plane = plane};
    qc_complex *x = QC__NEW(ctx, qc_complex, mesh->n_faces);
    qc_status status = x ? locate_on(ctx, field->mesh, &c.half) : QC_ERR_NOMEM;
    if (status == QC_OK) status = frames(ctx, mesh, &c.real, &c.imag);
    if (status == QC_OK) status = frames(ctx, field->mesh, &c.half_real, &c.half_imag);
    int32_t near = 0;
    for (int32_t t = 0; status == QC_OK && t < mesh->n_faces; t++) {
        if (t % 65536 == 0 && !qc__progress(ctx, 1)) status = QC_ERR_CANCELLED;
        x[t] = carry_cross(&c, t, &near);
    }
    if (status == QC_OK) status = qc_face_field_create(ctx, mesh, x, NULL, NULL, out);
    locate_end(&c.half);
    double *const blocks[] = {c.real, c.imag, c.half_real, c.half_imag};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    qc__free(x);
    return status;
}

/* Sums count both halves; what depends on the joint is measured again. */
static qc_status mirror_report(qc_ctx *ctx, const qc_mesh *mesh, const qc_polygon_mesh *quads,
                               const qc_plane *plane, const qc_report *half, qc_report **out) {
    qc_report *both = NULL, *again = NULL;
    qc_status status = qc_report_create(ctx, &both);
    if (status == QC_OK) status = qc_report_create(ctx, &again);
    if (status == QC_OK)
        status = qc_report_measure(ctx, mesh, NULL, NULL, NULL,
                                   half->quads.faces > 0 ? quads : NULL, NULL, again);
    if (status == QC_OK) {
        qc_report_add(both, half);
        qc_report_add(both, half);
        both->input = again->input;
        both->energy.iterations = half->energy.iterations;
        both->energy.evaluations = half->energy.evaluations;
        again->quads.feature_edges = quads && half->quads.faces > 0 ? quads->n_lines : 0;
        again->quads.feature_distance = half->quads.feature_distance;
        again->quads.diagonal = half->quads.diagonal > 0 ? mesh->diagonal : 0;
        both->quads = again->quads;
        memcpy(both->mirror, plane->normal, sizeof plane->normal);
        both->mirror[3] = plane->offset;
        *out = both;
    } else {
        qc_object_release(both);
    }
    qc_object_release(again);
    return status;
}

qc_status qc__mirror_results(qc_ctx *ctx, const qc_mesh *half, const qc_plane *plane,
                             qc_remesh_result *result) {
    const qc_mesh *mesh = result->mesh;
    const qc__border border = qc__border_of(half, plane);
    qc_polygon_mesh *quads = NULL, *uv = NULL;
    qc_face_field *field = NULL;
    qc_report *report = NULL;
    qc_status status = QC_OK;
    if (result->quads) status = qc__mirror_polygons(ctx, result->quads, plane, &border, &quads);
    if (status == QC_OK && quads) status = set_sources(ctx, mesh, quads);
    if (status == QC_OK && result->uv)
        status = qc__mirror_polygons(ctx, result->uv, plane, &border, &uv);
    if (status == QC_OK && result->field)
        status = mirror_field(ctx, plane, mesh, result->field, &field);
    if (status == QC_OK) status = mirror_report(ctx, mesh, quads, plane, result->report, &report);
    if (status != QC_OK) {
        qc_object_release(quads);
        qc_object_release(uv);
        qc_object_release(field);
        return status;
    }
    qc_object_release(result->quads);
    qc_object_release(result->uv);
    qc_object_release(result->field);
    qc_object_release(result->report);
    result->quads = quads;
    result->uv = uv;
    result->field = field;
    result->report = report;
    return QC_OK;
}
