/* What must be kept apart, and the forms which measure it (see separation.h). */
#include "sdk/map/round/separation_finder.h"
#include <math.h>
#include <string.h>

typedef qc__finder finder;
typedef qc__bridge bridge;

/* Of a path to a feature: on coarse meshes the vertices of one beside a point lie askew. */
static const double least_slope = 0.7;

void qc__separation_free(qc__separation *s) {
    if (!s) return;
    qc__free(s->vertex);
    qc__free(s->start);
    qc__free(s->variable);
    qc__free(s->value);
    qc__free(s);
}

/* Edges from a site to a site through the bridge: reversed to the first one, then on to the other.
 * Returns their number; *v is the first site. */
static int32_t find_path(const finder *f, const bridge *link, int32_t *v, int32_t *path) {
    const qc_mesh *mesh = f->seams->mesh;
    const int32_t *ends = mesh->edge_vertex + 2 * (int64_t)link->edge;
    const bool forward = f->cell[ends[0]] == link->a;
    int32_t n = 0;
    for (*v = ends[forward ? 0 : 1]; f->site[*v] < 0; n++) {
        path[n] = f->predecessor[*v];
        *v = qc__other_end(mesh, path[n], *v);
    }
    for (int32_t i = 0, j = n - 1; i < j; i++, j--) {
        const int32_t swap = path[i];
        path[i] = path[j];
        path[j] = swap;
    }
    path[n++] = link->edge;
    for (int32_t w = ends[forward ? 1 : 0]; f->site[w] < 0; n++) {
        path[n] = f->predecessor[w];
        w = qc__other_end(mesh, path[n], w);
    }
    return n;
}

/* The path from site a to site b through a bridge; it must not lead along a feature unless both are
 * points. */
static qc_status develop_bridge(finder *f, const bridge *link, qc__walk *walk, int32_t *path,
                                int32_t ends[2], int32_t *parts) {
    double _Complex way = 0;
    const int32_t n = find_path(f, link, &ends[0], path);
    ends[1] = ends[0];
    const qc_status status = qc__separation_develop(f, path, n, walk, &ends[1], parts, &way);
    if ((*parts == 1 && fabs(creal(way)) < least_slope * fabs(cimag(way))) ||
        (*parts == 2 && fabs(cimag(way)) < least_slope * fabs(creal(way))))
        *parts = 0;
    return status;
}

static qc_status make_forms(finder *f, qc__separation *s) {
    qc_status status = qc__separation_reserve(f, s, s->n + f->n_bridges + f->seams->n_poles);
    if (status != QC_OK) return status;
    int32_t *path = QC__NEW(f->ctx, int32_t, f->seams->mesh->n_vertices + 1);
    qc__walk walk = {0};
    status = path ? QC_OK : QC_ERR_NOMEM;
    for (int64_t i = 0; i < f->n_bridges && status == QC_OK; i++) {
        int32_t ends[2], parts = 0;
        status = develop_bridge(f, &f->bridges[i], &walk, path, ends, &parts);
        if (status == QC_OK) status = qc__separation_store(f, s, ends, parts);
    }
    qc__walk_free(&walk);
    qc__free(path);
    return status;
}

/* d = (1 - i) p, in units which make the shifts by less than four lines shorter than half. */
static qc_status make_pole_forms(finder *f, const int32_t *pole_index4, qc__separation *s) {
    static const double unit = 0.2;
    const qc__seams *seams = f->seams;
    qc_status status = QC_OK;
    for (int32_t i = 0; i < seams->n_poles && pole_index4 && status == QC_OK; i++) {
        if (pole_index4[seams->cone_pole[i]] != 4) continue;
        const int32_t p = qc__position_symbol(seams, seams->n_cones + i, 0);
        const int32_t none[2] = {-1, -1};
        qc__separation_add_symbol(f, p, unit * (1.0 - I));
        qc__separation_add_symbol(f, p + 1, unit * (1.0 + I));
        status = qc__separation_store(f, s, none, 3);
    }
    return status;
}

/* Pairs of points; then, with features, pairs of sites which are not both points. */
static qc_status find_pairs(finder *f, double reach, qc__separation *s) {
    const int32_t n_vertices = f->seams->mesh->n_vertices;
    f->sum = QC__ZERO(f->ctx, double _Complex, f->seams->n_free);
    f->site = QC__NEW(f->ctx, int32_t, n_vertices);
    f->distance = QC__NEW(f->ctx, double, n_vertices);
    f->predecessor = QC__NEW(f->ctx, int32_t, n_vertices);
    f->cell = QC__NEW(f->ctx, int32_t, n_vertices);
    if (!f->sum || !f->site || !f->distance || !f->predecessor || !f->cell) return QC_ERR_NOMEM;
    memcpy(f->site, f->seams->vertex_cone, sizeof *f->site * (size_t)n_vertices);
    qc_status status = QC_OK;
    for (int32_t pass = 0; pass < (f->axis ? 2 : 1) && status == QC_OK; pass++) {
        if (pass == 1) status = qc__separation_find_pieces(f);
        if (status == QC_OK) status = qc__separation_grow_cells(f);
        if (status == QC_OK)
            status = qc__separation_find_bridges(f, reach, pass == 1 ? f->seams->n_cones : 0);
        if (status == QC_OK) status = make_forms(f, s);
    }
    if (f->axis && status == QC_OK) status = qc__separation_along(f, s, reach);
    if (status == QC_OK) status = qc__separation_reserve(f, s, s->n + f->seams->n_poles);
    return status;
}

qc_status qc__separation_create(qc_ctx *ctx, const qc__seams *seams, const int8_t *axis,
                                const int32_t *pole_index4, const qc_complex *map, double reach,
                                qc__separation **out) {
    finder f = {.ctx = ctx, .seams = seams, .axis = axis, .map = map};
    qc__separation *s = QC__ZERO(ctx, qc__separation, 1);
    qc_status status = s ? find_pairs(&f, reach, s) : QC_ERR_NOMEM;
    if (status == QC_OK) status = make_pole_forms(&f, pole_index4, s);
    void *const blocks[] = {f.site, f.distance, f.predecessor, f.cell, f.bridges, f.sum};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) qc__free(blocks[i]);
    if (status != QC_OK) {
        qc__separation_free(s);
        return status;
    }
    *out = s;
    return QC_OK;
}
