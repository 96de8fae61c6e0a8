/* Where the vertices of quads lie on the input, and what its field is, when the map was made on a
 * refinement of it. */
#include <complex.h>
#include <math.h>

#include "sdk/mesh/internal.h"
#include "sdk/remesh/internal.h"

/* Faces of a mesh by the face of the input they come from, as linked lists. */
typedef struct by_source {
    int32_t n;
    int32_t *first, *next; /* n; n_faces; -1 = end */
} by_source;

static qc_status sort_by_source(qc_ctx *ctx, const qc_mesh *mesh, by_source *out) {
    by_source s = {0, NULL, NULL};
    const int32_t *source = mesh->source_face;
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const int32_t f = source ? source[t] : t;
        if (f >= s.n) s.n = f + 1;
    }
    s.first = QC__NEW(ctx, int32_t, s.n);
    s.next = QC__NEW(ctx, int32_t, mesh->n_faces);
    if (!s.first || !s.next) {
        qc__free(s.first);
        qc__free(s.next);
        return QC_ERR_NOMEM;
    }
    for (int32_t f = 0; f < s.n; f++) s.first[f] = -1;
    for (int32_t t = mesh->n_faces; t-- > 0;) {
        const int32_t f = source ? source[t] : t;
        s.next[t] = f < 0 ? -1 : s.first[f];
        if (f >= 0) s.first[f] = t;
    }
    *out = s;
    return QC_OK;
}

static const double *corner(const qc_mesh *mesh, int32_t t, int k) {
    return mesh->position + 3 * (int64_t)mesh->face_vertex[3 * (int64_t)t + k];
}

/* Of the triangles of a polygon the one which holds p best, and the coordinates of p there; -1 =
 * none.
 */
static int32_t place(const qc_mesh *mesh, const by_source *s, int32_t source, const double p[3],
                     double weight[3]) {
    double best = -INFINITY, w[3];
    int32_t found = -1;
    if (source < 0 || source >= s->n) return -1;
    for (int32_t t = s->first[source]; t >= 0; t = s->next[t]) {
        if (!qc__face_coordinates(mesh, t, p, w)) continue;
        const double least = fmin(w[0], fmin(w[1], w[2]));
        if (least <= best) continue;
        best = least;
        found = t;
        for (int k = 0; k < 3; k++) weight[k] = w[k];
    }
    return found;
}

static void place_part(const qc_mesh *mesh, const by_source *s, const qc_mesh *refined,
                       const qc_polygon_mesh *quads, double *barycentric) {
    for (int32_t v = 0; v < quads->n_vertices; v++) {
        const int32_t t = quads->source_face[v];
        const double *w = quads->source_barycentric + 3 * (int64_t)v;
        double p[3] = {0, 0, 0};
        if (t < 0 || t >= refined->n_faces) continue;
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++) p[i] += w[k] * corner(refined, t, k)[i];
        place(mesh, s, refined->source_face ? refined->source_face[t] : t, p,
              barycentric + 3 * (int64_t)v);
    }
}

static bool is_refined(const qc__collection *all, const qc__parts *parts, int32_t c) {
    return all->quads[c] && all->quads[c]->source_barycentric &&
           all->mesh[c]->n_faces != parts->face_start[c + 1] - parts->face_start[c];
}

qc_status qc__source_coordinates(qc_ctx *ctx, const qc__collection *all, const qc__parts *parts,
                                 qc_polygon_mesh *quads) {
    by_source s = {0, NULL, NULL};
    int64_t first = 0;
    for (int32_t c = 0; c < parts->n; c++) {
        if (is_refined(all, parts, c)) {
            const qc_status status = s.first ? QC_OK : sort_by_source(ctx, parts->mesh, &s);
            if (status != QC_OK) return status;
            place_part(parts->mesh, &s, all->mesh[c], all->quads[c],
                       quads->source_barycentric + 3 * first);
        }
        if (all->quads[c]) first += all->quads[c]->n_vertices;
    }
    qc__free(s.first);
    qc__free(s.next);
    return QC_OK;
}

/* --- the field ------------------------------------------------------------------------------- */

/* Adds the fourth power of the cross of face t, weighted by area, to that of the face below it. */
static void add_cross(const qc_mesh *mesh, const by_source *s, const qc_face_field *field,
                      int32_t t, const double *fine, const double *coarse, double _Complex *sum) {
    const qc_mesh *refined = field->mesh;
    const double *re = fine + 6 * (int64_t)t;
    double middle[3], e[2][3], n[3], w[3];
    for (int i = 0; i < 3; i++) {
        middle[i] = 0;
        for (int k = 0; k < 3; k++) middle[i] += corner(refined, t, k)[i] / 3;
        for (int k = 0; k < 2; k++)
            e[k][i] = corner(refined, t, k + 1)[i] - corner(refined, t, 0)[i];
    }
    qc__cross3(e[0], e[1], n);
    const int32_t f = place(mesh, s, refined->source_face ? refined->source_face[t] : t, middle, w);
    if (f < 0) return;
    const double *axes = coarse + 6 * (int64_t)f;
    double x = 0, y = 0;
    for (int i = 0; i < 3; i++) {
        const double d = field->x[t].re * re[i] + field->x[t].im * re[3 + i];
        x += d * axes[i];
        y += d * axes[3 + i];
    }
    const double _Complex z = x + y * I;
    sum[f] += sqrt(qc__dot3(n, n)) * z * z * z * z;
}

/* Real and imaginary axis of each face, 6 numbers. */
static qc_status frames(qc_ctx *ctx, const qc_mesh *mesh, double *out) {
    const size_t n = 3 * (size_t)mesh->n_faces;
    double *axes = QC__NEW(ctx, double, 2 * n);
    qc_status status = axes ? qc_tangent_frames(ctx, mesh, axes, axes + n) : QC_ERR_NOMEM;
    for (size_t i = 0; status == QC_OK && i < n; i++) {
        out[6 * (i / 3) + i % 3] = axes[i];
        out[6 * (i / 3) + 3 + i % 3] = axes[n + i];
    }
    qc__free(axes);
    return status;
}

qc_status qc__source_field(qc_ctx *ctx, const qc_mesh *mesh, const qc_face_field *field,
                           qc_face_field **out) {
    const qc_mesh *refined = field->mesh;
    by_source s = {0, NULL, NULL};
    double _Complex *sum = QC__ZERO(ctx, double _Complex, mesh->n_faces);
    qc_complex *x = QC__NEW(ctx, qc_complex, mesh->n_faces);
    double *fine = QC__NEW(ctx, double, 6 * (int64_t)refined->n_faces);
    double *coarse = QC__NEW(ctx, double, 6 * (int64_t)mesh->n_faces);
    qc_status status = sum && x && fine && coarse ? sort_by_source(ctx, mesh, &s) : QC_ERR_NOMEM;
    if (status == QC_OK) status = frames(ctx, refined, fine);
    if (status == QC_OK) status = frames(ctx, mesh, coarse);
    if (status == QC_OK) {
        for (int32_t t = 0; t < refined->n_faces; t++)
            add_cross(mesh, &s, field, t, fine, coarse, sum);
        for (int32_t t = 0; t < mesh->n_faces; t++) {
            const double angle = atan2(cimag(sum[t]), creal(sum[t])) / 4;
            x[t] = (qc_complex){cos(angle), sin(angle)};
        }
        status = qc_face_field_create(ctx, mesh, x, NULL, NULL, out);
    }
    qc__free(s.first);
    qc__free(s.next);
    qc__free(sum);
    qc__free(x);
    qc__free(fine);
    qc__free(coarse);
    return status;
}
