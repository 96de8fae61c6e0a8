/* Stage qc.check.opensubdiv: the quads as the cage of a Catmull-Clark surface. */
#include "parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CAGE = 0, REFINED, LIMIT };
static const char *const outputs[] = {"cage", "refined", "limit", NULL};
static const char *const closest_points[] = {QC_CLOSEST_POINT_ID, NULL};
static const char *const solvers[] = {QC_SOLVER_ID, NULL};

typedef struct params {
    int64_t levels, rounds;
    bool fit;
    int32_t output;
    const char *closest, *solver, *json;
} params;
static const qc_param table[] = {
    QC_PARAM_INT(params, levels, 2, 0, 6, "", "refinements before limit positions are measured"),
    QC_PARAM_BOOL(params, fit, false,
                  "move the control points so that the limit surface, not the cage, interpolates "
                  "the surface"),
    QC_PARAM_INT(params, rounds, 10, 1, 100, "",
                 "of the fit: closest points are found anew in each"),
    QC_PARAM_ENUM(params, output, CAGE, outputs,
                  "the control points; the refined mesh; the refined mesh at limit positions"),
    QC_PARAM_INTERFACE(params, closest, closest_points,
                       "finds closest points; builtin when not set"),
    QC_PARAM_INTERFACE(params, solver, solvers,
                       "of the normal equations of the fit, for real matrices; builtin when not "
                       "set"),
    QC_PARAM_TEXT(params, json, "file to which the report is appended as a line of JSON"),
};
static const qc_port in[] = {
    {"quads", QC_TYPE_POLYGON_MESH, 0, "a manifold; its lines are creases"},
    {"mesh", QC_TYPE_MESH, QC_PORT_OPTIONAL, "the surface to measure against and to fit"},
};
static const qc_port out[] = {
    {"quads", QC_TYPE_POLYGON_MESH, 0, "as `output` says"},
    {"report", "qc.subdivision_report/1", 0, "qc_subdivision_report of qc_opensubdiv.h"},
};

/* Whatever OpenSubdiv would refuse, or read out of range, is named here. */
static qc_status check(const qc_run *run, const qc_polygon_mesh *cage, int64_t levels) {
    qc_polygon_topology t;
    char text[160];
    if ((int64_t)cage->n_corners > INT32_MAX >> (2 * levels))
        return (run->fail)(run, QC_ERR_ARGUMENT, -1, "levels: too many samples; set fewer levels");
    const qc_status status = qc_polygon_mesh_topology(run->ctx, cage, &t);
    if (status != QC_OK) return status;
    const int32_t defects = t.non_manifold_edges + t.non_manifold_vertices + t.inconsistent_edges +
                            t.duplicate_faces + t.degenerate_faces;
    if (cage->n_faces > 0 && defects == 0) return QC_OK;
    snprintf(text, sizeof text,
             "not a manifold cage: %d non-manifold edges, %d such vertices, %d inconsistent edges, "
             "%d duplicate and %d degenerate faces, %d faces in all",
             (int)t.non_manifold_edges, (int)t.non_manifold_vertices, (int)t.inconsistent_edges,
             (int)t.duplicate_faces, (int)t.degenerate_faces, (int)cage->n_faces);
    return (run->fail)(run, QC_ERR_INPUT, t.first_bad_element, text);
}

static qc_status make_target(const qc_run *run, const char *name, qo_target *t) {
    t->mesh = run->input(run, "mesh");
    t->closest = (const qc_closest_point *)run->find(run, QC_CLOSEST_POINT_ID, name);
    if (!t->closest) return QC_ERR_NOT_FOUND;
    if (!t->mesh) return QC_OK;
    return t->closest->build(t->closest, run->ctx, t->mesh->n_faces, t->mesh->position,
                             t->mesh->face_vertex, &t->tree);
}

static qc_status fit(const qc_run *run, const params *p, const qc_polygon_mesh *cage,
                     const qo_surface *surface, const qo_target *target, double *control,
                     qc_subdivision_report *report) {
    if (!target->mesh)
        return (run->fail)(run, QC_ERR_ARGUMENT, -1,
                           "fit: wire a mesh to fit to, or set fit=false");
    const qc_interface *solver = run->find(run, QC_SOLVER_ID, p->solver);
    if (!solver) return QC_ERR_NOT_FOUND;
    qc_status status =
        qo_measure_limit(run, surface, target, cage->n_vertices, control, cage->position, report);
    report->distance_before = report->distance;
    report->mean_distance_before = report->mean_distance;
    report->vertex_distance_before = report->vertex_distance;
    report->rounds = (int32_t)p->rounds;
    if (status == QC_OK)
        status = qo_fit(run, cage, target, (const qc_solver *)solver, (int32_t)p->rounds, control);
    return status;
}

/* The cage with other positions. */
static qc_status copy_cage(qc_ctx *ctx, const qc_polygon_mesh *cage, const double *control,
                           qc_polygon_mesh **result) {
    qc_polygon_mesh *copy = NULL;
    const qc_status status = qc_polygon_mesh_merge(ctx, 1, &cage, NULL, &copy);
    if (status != QC_OK) return status;
    memcpy(copy->position, control, 3 * (size_t)cage->n_vertices * sizeof(double));
    *result = copy;
    return QC_OK;
}

static qc_status refined(const qc_run *run, const qo_surface *surface, const double *control,
                         bool limit, qc_polygon_mesh **result) {
    const int32_t n = qo_surface_samples(surface), n_faces = qo_surface_faces(surface);
    qc_polygon_mesh *m = NULL;
    qc_status status = qc_polygon_mesh_create(run->ctx, n, n_faces, 4 * n_faces, 0, 0, 0, &m);
    if (status != QC_OK) return status;
    for (int32_t f = 0; f <= n_faces; f++) m->face_offset[f] = 4 * f;
    qo_surface_quads(surface, m->face_vertex);
    status = limit ? qo_surface_limit(run->ctx, surface, control, m->position, NULL, NULL)
                   : qo_surface_refine(run->ctx, surface, control, m->position);
    if (status == QC_OK)
        *result = m;
    else
        qc_object_release(m);
    return status;
}

static void destroy_report(qc_object *object) {
    free(object);
}

static qc_status publish(const qc_run *run, const params *p, const qc_polygon_mesh *cage,
                         const qo_surface *surface, const double *control,
                         const qc_subdivision_report *figures) {
    qc_polygon_mesh *quads = NULL;
    qc_subdivision_report *report = malloc(sizeof *report);
    if (!report) return qo_nomem(run);
    *report = *figures;
    qc_object_init(&report->object, QC_TYPE_SUBDIVISION_REPORT, destroy_report);
    qc_status status = run->output(run, "report", report);
    if (status != QC_OK) return status;
    status = p->output == CAGE ? copy_cage(run->ctx, cage, control, &quads)
                               : refined(run, surface, control, p->output == LIMIT, &quads);
    if (status == QC_OK && p->json && *p->json) status = qo_append_json(run, figures, p->json);
    if (status == QC_OK) return run->output(run, "quads", quads);
    qc_object_release(quads);
    return status;
}

static void log_figures(const qc_run *run, const qc_subdivision_report *r) {
    char text[256];
    snprintf(
        text, sizeof text,
        "%d extraordinary vertices, spacing %d (mean %.1f); limit surface: distance %.3g, mean "
        "%.3g, smallest scaled Jacobian %.3f, %lld samples reversed",
        (int)r->n_extraordinary, (int)r->spacing, r->mean_spacing, r->distance, r->mean_distance,
        r->jacobian, (long long)r->n_reversed);
    run->log(run, QC_LOG_INFO, text);
}

static qc_status work(const qc_run *run, const params *p, const qc_polygon_mesh *cage,
                      const qo_surface *surface, const qo_target *target, double *control) {
    qc_subdivision_report report;
    memset(&report, 0, sizeof report);
    report.levels = (int32_t)p->levels;
    qc_status status = qo_measure_cage(run, cage, surface, &report);
    if (status == QC_OK && p->fit) status = fit(run, p, cage, surface, target, control, &report);
    if (status == QC_OK)
        status = qo_measure_limit(run, surface, target, cage->n_vertices, control, cage->position,
                                  &report);
    if (status != QC_OK) return status;
    log_figures(run, &report);
    return publish(run, p, cage, surface, control, &report);
}

static qc_status run_stage(const qc_run *run, const void *raw) {
    const params *p = raw;
    const qc_polygon_mesh *cage = run->input(run, "quads");
    const size_t size = 3 * (size_t)cage->n_vertices * sizeof(double);
    qo_target target = {NULL, NULL, NULL};
    qo_surface *surface = NULL;
    double *control = NULL;
    qc_status status = check(run, cage, p->levels);
    if (status == QC_OK) status = make_target(run, p->closest, &target);
    if (status == QC_OK) status = qo_surface_create(run->ctx, cage, (int32_t)p->levels, &surface);
    if (status == QC_OK) {
        control = malloc(size + 1);
        if (control) memcpy(control, cage->position, size);
        status = control ? work(run, p, cage, surface, &target, control) : qo_nomem(run);
    }
    free(control);
    qo_surface_destroy(surface);
    if (target.tree) target.closest->destroy(target.tree);
    return status;
}

const qc_stage qo_stage = {
    QC_STAGE_SIZES,
    .id = "qc.check.opensubdiv",
    .version = "1.0",
    .brief = "Measures the quads as the cage of a Catmull-Clark surface, and fits it",
    .doc =
        "The quads are refined with OpenSubdiv; their lines and boundaries are sharp creases. The "
        "report has valences, the spacing of extraordinary vertices, and of the limit surface, "
        "at the vertices of the refined mesh: its distance to the surface, its normals against "
        "those of the surface and its smallest scaled Jacobian. The fit solves for the control "
        "points whose limit positions are closest to the surface, by least squares.",
    .cite = "Catmull and Clark (1978); Halstead, Kass, DeRose (1993); Biermann et al. (2000)",
    .in = in,
    .out = out,
    .n_in = sizeof in / sizeof *in,
    .n_out = sizeof out / sizeof *out,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = run_stage,
};
