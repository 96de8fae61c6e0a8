/* qc/pipeline.h - registry of stages, pipelines as data, runs.
 *
 * A pipeline is a list of steps: a stage, a name, parameters. A step's input port takes the latest
 * earlier output of the same type, counting the objects in the bag at the start as earliest (those
 * called like an output of the pipeline are that step's product from an earlier run, seen by the
 * steps after it only). A wire overrides the rule: it names "step.port" or a bag object. Everything
 * is checked before anything runs.
 * On error outputs are untouched; the context of the registry has the text, with the name of the
 * step in qc_error.stage. NOMEM is possible wherever a qc_status is returned.
 * Thread rule: registry, pipeline and bag belong to the thread of their context. */
#ifndef QC_PIPELINE_H
#define QC_PIPELINE_H

#include <qc/stage.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- registry --------------------------------------------------------------------------------- */

typedef struct qc_registry qc_registry;
/* Holds all built-in stages. The registry must not outlive ctx. */
QC_API qc_status qc_registry_create(qc_ctx *ctx, qc_registry **out);
/* Plugins are closed here, latest first: free pipelines, bags and objects made by them before. NULL
 * is fine. */
QC_API void qc_registry_free(qc_registry *registry);
/* Adds a stage of the host program; the strings of its table are borrowed. A stage with a known id
 * replaces it for pipelines made from now on. Errors: ABI (sizes), ARGUMENT (a table that makes no
 * sense: the text says what). */
QC_API qc_status qc_registry_add(qc_registry *registry, const qc_stage *stage);
/* Loads a plugin library (never implicit); loading it again does nothing. A path without '/' is a
 * file in the working directory. Errors: IO (not loadable), ABI (no qc_plugin_1, other version,
 * refused by open), ARGUMENT (bad stage table). On error no stage of it is registered. */
QC_API qc_status qc_registry_load(qc_registry *registry, const char *plugin_path);
QC_API uint32_t qc_registry_count(const qc_registry *registry);
/* Stages in order of registration; NULL past the end. The table has this header's layout whatever
 * the plugin was built with, no text in it is NULL, and enums have the range 0 .. n-1. Borrowed
 * until the registry is freed. */
QC_API const qc_stage *qc_registry_stage(const qc_registry *registry, uint32_t i);
/* Port or parameter i of a stage from the registry; NULL past the end. */
QC_API const qc_port *qc_stage_in(const qc_stage *stage, uint32_t i);
QC_API const qc_port *qc_stage_out(const qc_stage *stage, uint32_t i);
QC_API const qc_param *qc_stage_param(const qc_stage *stage, uint32_t i);
/* By id; the prefix "qc." may be left out. NOT_FOUND offers the closest id. */
QC_API qc_status qc_registry_find(qc_registry *registry, const char *id, const qc_stage **out);

/* Offers a table of the host program under an interface id, borrowed until the registry is freed
 * (&solver.head under QC_SOLVER_ID). Errors: ABI (struct_size), ARGUMENT (no id or name). */
QC_API qc_status qc_registry_offer(qc_registry *registry, const char *id,
                                   const qc_interface *table);
/* Table i under an id: the built-in ones, those of the host program, those of plugins in order of
 * loading; NULL past the end. Borrowed until the registry is freed. */
QC_API const qc_interface *qc_registry_interface(const qc_registry *registry, const char *id,
                                                 uint32_t i);
/* By name, the latest of equal names; name NULL or "" = table 0. NOT_FOUND offers the closest. */
QC_API qc_status qc_registry_find_interface(qc_registry *registry, const char *id, const char *name,
                                            const qc_interface **out);

/* --- objects ---------------------------------------------------------------------------------- */

typedef struct qc_bag qc_bag; /* named, typed, shared objects: input and output of runs           */
QC_API qc_status qc_bag_create(qc_ctx *ctx, qc_bag **out);
QC_API void qc_bag_free(qc_bag *bag); /* releases its objects; NULL is fine                       */
/* Adds a reference; a known name is replaced and counts as the latest arrival. object starts with a
 * qc_object. Errors: ARGUMENT (no name, no object). */
QC_API qc_status qc_bag_put(qc_bag *bag, const char *name, const void *object);
/* Borrowed; NULL when absent. name: a name put, or "step.port" after a run. */
QC_API const void *qc_bag_get(const qc_bag *bag, const char *name);
/* The latest object of a type; NULL when absent. Borrowed. */
QC_API const void *qc_bag_latest(const qc_bag *bag, const char *type);
QC_API uint32_t qc_bag_count(const qc_bag *bag);
QC_API const char *qc_bag_name(const qc_bag *bag, uint32_t i); /* in order of arrival             */

/* --- pipelines -------------------------------------------------------------------------------- */

typedef struct qc_pipeline qc_pipeline;
QC_API qc_status qc_pipeline_create(qc_registry *registry, qc_pipeline **out); /* empty           */
/* {"qc_pipeline": 1, "stages": [ {"stage": ID, "as": STEP, "params": {..}, "in": {PORT: NAME}} ]}
 * "as" defaults to the id without its "qc." prefix; "version" of a stage may be given, and one that
 * differs is logged as a warning. Unknown keys, ids, parameters, values are errors (INPUT for JSON
 * syntax with the line in where; NOT_FOUND with the closest name; ARGUMENT with the range). */
QC_API qc_status qc_pipeline_parse(qc_registry *registry, const char *json, qc_pipeline **out);
QC_API void qc_pipeline_free(qc_pipeline *pipeline);
/* Inserts a step before position `at` (at = count appends). step NULL = id without "qc.". Errors:
 * NOT_FOUND (stage), ARGUMENT (position; step name taken, or not of letters, digits and . _ -). */
QC_API qc_status qc_pipeline_insert(qc_pipeline *pipeline, uint32_t at, const char *step,
                                    const char *stage_id);
QC_API qc_status qc_pipeline_remove(qc_pipeline *pipeline, uint32_t at);
/* Parameter from text: "true", "12", "0.5", an enum name, any text. Errors name the closest
 * parameter or step, or the range. */
QC_API qc_status qc_pipeline_set(qc_pipeline *pipeline, const char *step, const char *param,
                                 const char *text);
/* Wires an input port to "step.port" or a bag name; source NULL = back to the rule, "" = leave an
 * optional port unwired. Errors: NOT_FOUND (step or port); the source itself is checked later. */
QC_API qc_status qc_pipeline_wire(qc_pipeline *pipeline, const char *step, const char *port,
                                  const char *source);
QC_API uint32_t qc_pipeline_count(const qc_pipeline *pipeline);
QC_API const char *qc_pipeline_step_name(const qc_pipeline *pipeline, uint32_t i);
QC_API const qc_stage *qc_pipeline_step_stage(const qc_pipeline *pipeline, uint32_t i);
/* Current value as text (valid until the next call on the pipeline; "" = text not set); NULL =
 * unknown step or parameter. */
QC_API const char *qc_pipeline_get(const qc_pipeline *pipeline, const char *step,
                                   const char *param);
/* The whole pipeline as JSON with every parameter and version; qc_pipeline_parse reads it back. The
 * caller frees it with qc_text_free. Errors: INPUT (a text which is not UTF-8). */
QC_API qc_status qc_pipeline_print(const qc_pipeline *pipeline, char **json);
QC_API void qc_text_free(char *text);

/* Ports, types and ranges, given the objects in io (NULL = an empty bag). A required input must be
 * met for sure: an optional output counts only when a wire names it. Errors: WIRING names step,
 * port, type and the stages which give that type, where = step; ARGUMENT (range). */
QC_API qc_status qc_pipeline_check(const qc_pipeline *pipeline, const qc_bag *io);
/* Checks, then runs all steps; outputs land in io as "step.port" once all have succeeded. On error
 * io is as before: CANCELLED, or what the failing stage returned (FAILED when it kept a promised
 * output back). Each step gets an equal share of the context's progress range. */
QC_API qc_status qc_pipeline_run(qc_pipeline *pipeline, qc_bag *io);
/* The same for steps first .. last-1: the products of earlier steps must be in io. Errors also:
 * ARGUMENT (no such steps). */
QC_API qc_status qc_pipeline_run_range(qc_pipeline *pipeline, uint32_t first, uint32_t last,
                                       qc_bag *io);
/* Seconds a step took, summed over all runs of this pipeline so far. */
QC_API double qc_pipeline_seconds(const qc_pipeline *pipeline, uint32_t i);

/* One stage without registry and JSON. params: the stage's struct, checked against the ranges; NULL
 * = defaults. An input port takes the object called like it when the type fits, else the latest of
 * its type. Outputs land in io under their port names. Errors: ABI and ARGUMENT (table, ranges),
 * WIRING (an input is not in io), those of the stage. */
QC_API qc_status qc_stage_run(qc_ctx *ctx, const qc_stage *stage, const void *params, qc_bag *io);

#ifdef __cplusplus
}
#endif
#endif
