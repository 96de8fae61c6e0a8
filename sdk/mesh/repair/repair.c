/* qc_mesh_repair: from a polygon soup to an oriented manifold triangle mesh, step by step. */
#include <math.h>
#include <string.h>

#include "sdk/mesh/repair/internal.h"

static const char *const NAMES[QC_REPAIR_KINDS] = {
    "polygons triangulated",          "vertices with equal coordinates merged",
    "degenerate faces dropped",       "duplicate faces dropped",
    "non-manifold edges cut open",    "faces turned round",
    "non-manifold vertices split",    "zero-area faces removed",
    "vertices without faces dropped", "components with fewer than 4 faces dropped"};

const char *qc_repair_kind_name(int32_t kind) {
    return kind >= 0 && kind < QC_REPAIR_KINDS ? NAMES[kind] : "unknown repair";
}

void qc__repair_note(qc__repair *r, int32_t kind, int32_t element) {
    int32_t n = r->report->count[kind]++;
    if (n < 4) r->report->first[kind][n] = element;
}

void qc__repair_keep(qc__repair *r, const uint8_t *keep) {
    int32_t n = 0;
    for (int32_t f = 0; f < r->n_faces; f++) {
        if (!keep[f]) continue;
        memmove(r->triangle + 3 * (size_t)n, r->triangle + 3 * (size_t)f, 3 * sizeof *r->triangle);
        r->source_face[n++] = r->source_face[f];
    }
    r->n_faces = n;
}

const char *qc__repair_face_name(const qc__repair *r, int32_t face, char buffer[QC__FACE_NAME]) {
    int32_t f = r->source_face[face];
    if (r->soup->face_line)
        snprintf(buffer, QC__FACE_NAME, "face %d (line or element %d of the file)", (int)f,
                 (int)r->soup->face_line[f]);
    else
        snprintf(buffer, QC__FACE_NAME, "face %d", (int)f);
    return buffer;
}

static qc_status check_soup(qc_ctx *ctx, const qc_polygon_mesh *s) {
    if (s->n_faces == 0)
        return qc__fail(ctx, QC_ERR_INPUT, 0, "the mesh has no faces; a surface is needed");
    for (int64_t i = 0; i < 3 * (int64_t)s->n_vertices; i++)
        if (!isfinite(s->position[i]))
            return qc__fail(ctx, QC_ERR_INPUT, i / 3,
                            "vertex %lld has a coordinate which is not finite; remove it",
                            (long long)(i / 3));
    for (int32_t f = 0; f < s->n_faces; f++) {
        if (s->face_offset[f + 1] < s->face_offset[f] || s->face_offset[f + 1] > s->n_corners)
            return qc__fail(ctx, QC_ERR_ARGUMENT, f, "face_offset is not increasing at face %d",
                            (int)f);
        for (int32_t c = s->face_offset[f]; c < s->face_offset[f + 1]; c++)
            if (s->face_vertex[c] < 0 || s->face_vertex[c] >= s->n_vertices)
                return qc__fail(ctx, QC_ERR_ARGUMENT, f,
                                "vertex index %d of face %d is out of range (%d vertices)",
                                (int)s->face_vertex[c], (int)f, (int)s->n_vertices);
    }
    if (s->n_corners - 2 * (int64_t)s->n_faces > INT32_MAX / 3)
        return qc__fail(ctx, QC_ERR_INPUT, 0, "the mesh has too many corners; simplify it");
    return QC_OK;
}

static void log_report(qc_ctx *ctx, const qc_repair_report *report) {
    for (int32_t k = 0; k < QC_REPAIR_KINDS; k++) {
        char first[64] = "";
        size_t n = 0;
        if (report->count[k] == 0) continue;
        for (int i = 0; i < 4 && report->first[k][i] >= 0; i++)
            n += (size_t)snprintf(first + n, sizeof first - n, "%s%d", i ? ", " : "",
                                  (int)report->first[k][i]);
        qc__log(ctx, QC_LOG_WARNING, "repair: %d %s (%s %s%s)", (int)report->count[k], NAMES[k],
                k == QC_REPAIR_WELDED || k == QC_REPAIR_NON_MANIFOLD_VERTEX ||
                        k == QC_REPAIR_UNREFERENCED
                    ? "vertex"
                    : "face",
                first, report->count[k] > 4 ? ", ..." : "");
    }
}

static void destroy_report(qc_object *object) {
    qc__free(object);
}

static qc_repair_report *create_report(qc_ctx *ctx) {
    qc_repair_report *report = QC__ZERO(ctx, qc_repair_report, 1);
    if (!report) return NULL;
    qc_object_init(&report->object, QC_TYPE_REPAIR_REPORT, destroy_report);
    memset(report->first, 0xff, sizeof report->first); /* -1 */
    return report;
}

static qc_status start(qc__repair *r) {
    r->n_vertices = r->soup->n_vertices;
    r->source_vertex = QC__NEW(r->ctx, int32_t, r->n_vertices);
    r->merged = QC__ZERO(r->ctx, uint8_t, r->n_vertices);
    r->report = create_report(r->ctx);
    if (!r->source_vertex || !r->merged || !r->report) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < r->n_vertices; v++) r->source_vertex[v] = v;
    return QC_OK;
}

static qc_status run(qc__repair *r, qc_mesh **mesh) {
    typedef qc_status step(qc__repair *);
    static step *const steps[] = {
        qc__repair_triangulate, qc__repair_weld,   qc__repair_degenerate, qc__repair_duplicate,
        qc__repair_pair,        qc__repair_orient, qc__repair_split,      qc__repair_zero_area};
    const size_t n = sizeof steps / sizeof *steps;
    for (size_t i = 0; i < n; i++) {
        qc_status status = steps[i](r);
        if (status != QC_OK) return status;
        if (!qc__progress(r->ctx, 0.1 * (double)(i + 1))) return QC_ERR_CANCELLED;
    }
    return qc__repair_finish(r, mesh);
}

qc_status qc_mesh_repair(qc_ctx *ctx, const qc_polygon_mesh *soup, qc_mesh **mesh,
                         qc_repair_report **report) {
    qc__repair r = {.ctx = ctx, .soup = soup};
    qc_status status = check_soup(ctx, soup);
    if (status == QC_OK) status = start(&r);
    if (status == QC_OK) status = run(&r, mesh);
    if (status == QC_OK) {
        log_report(ctx, r.report);
        if (report)
            *report = r.report;
        else
            qc_object_release(&r.report->object);
    } else
        qc__free(r.report);
    qc__free(r.triangle);
    qc__free(r.source_face);
    qc__free(r.source_vertex);
    qc__free(r.twin);
    qc__free(r.merged);
    qc__free(r.cut);
    return status;
}
