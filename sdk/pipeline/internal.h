/* Internals of sdk/pipeline: stage tables in this header's layout, bags, steps. Not installed.
 *
 * Everything below works on imported tables (qc__table_import), so strides and missing members are
 * dealt with in one place. The layer needs sdk/base only: objects are opaque with a type id. */
#ifndef QC_PIPELINE_INTERNAL_H
#define QC_PIPELINE_INTERNAL_H

#include <qc/pipeline.h>
#include <qc/plugin.h>
#include "sdk/base/internal.h"
#include "sdk/pipeline/builtin.h"

/* --- tables ----------------------------------------------------------------------------------- */

/* Checks a stage table built with any compatible header and copies it, its ports and its parameters
 * into `arena` in this header's layout: members the table does not have are zero, texts are never
 * NULL, the range of an enum is 0 .. n-1. Strings stay where they are. Errors: ABI (sizes),
 * ARGUMENT (the text names the stage and what is wrong), NOMEM. */
qc_status qc__table_import(qc_ctx *ctx, qc__arena *arena, const qc_stage *table,
                           const qc_stage **out);
/* "qc.field" -> "field"; ids without the prefix as they are. */
const char *qc__short_id(const char *id);
/* Letters, digits and any of `extra`, 1 .. 63 of them. */
bool qc__is_name(const char *text, const char *extra);
char *qc__copy_text(qc_ctx *ctx, const char *text);
/* " (closest: 'lambda')" among n structs of `stride` bytes which start with their name, or "". */
typedef struct qc__hint {
    char text[96];
} qc__hint;
qc__hint qc__closest_hint(qc_ctx *ctx, const char *wanted, const void *names, int64_t n,
                          size_t stride);

/* --- parameters ------------------------------------------------------------------------------- */

/* A block of params_size bytes with the defaults of the table; caller frees. NULL = NOMEM. */
void *qc__params_create(qc_ctx *ctx, const qc_stage *stage);
/* Index of a parameter, or -1 with NOT_FOUND and the closest name recorded. `step` is only named.
 */
int32_t qc__params_find(qc_ctx *ctx, const qc_stage *stage, const char *step, const char *name);
/* Text -> value, range-checked. A QC_TEXT member keeps pointing to `text` ("" = NULL). */
qc_status qc__param_set(qc_ctx *ctx, const qc_param *param, const char *step, void *params,
                        const char *text);
/* Value -> text: a static or borrowed string, or `number` (64 bytes) filled in. NULL = text not
 * set. */
const char *qc__param_print(const qc_param *param, const void *params, char *number);
/* Range check of a struct that was filled by hand. */
qc_status qc__params_check(qc_ctx *ctx, const qc_stage *stage, const char *step,
                           const void *params);

/* --- bags ------------------------------------------------------------------------------------- */

/* The object called "step.port", NULL when absent. */
const qc_object *qc__bag_output(const qc_bag *bag, const char *step, const char *port);
const qc_object *qc__bag_object(const qc_bag *bag, uint32_t i);
/* Puts under "step.port" (step NULL: under "port") and takes over the caller's reference, also on
 * failure. */
qc_status qc__bag_take(qc_bag *bag, const char *step, const char *port, const qc_object *object);
/* Moves everything from `source` to `target`; on NOMEM both are as before. */
qc_status qc__bag_absorb(qc_bag *target, qc_bag *source);

/* --- registry and steps ----------------------------------------------------------------------- */

typedef struct qc__library { /* a loaded plugin */
    void *handle;
    const qc_plugin *plugin;
} qc__library;

struct qc_registry {
    qc_ctx *ctx;
    qc__arena *arena;       /* tables; replaced ones stay for the pipelines that use them */
    const qc_stage **stage; /* in order of registration */
    int64_t n, capacity;
    qc__library *library; /* in order of loading */
    int64_t n_libraries, library_capacity;
    qc__offer *offer; /* interfaces of the host program, in order of registration */
    int64_t n_offers, offer_capacity;
    qc_host host;
};

/* Registers n imported tables at once; nothing changes on NOMEM. */
qc_status qc__registry_commit(qc_registry *registry, const qc_stage *const *stage, int64_t n);
void qc__library_close(qc__library library);
bool qc__has_extension(const qc_plugin *plugin);
/* qc_registry_find_interface, also without a registry (NULL: built-in tables only). Errors start
 * with `subject`. */
qc_status qc__interface_find(qc_ctx *ctx, const qc_registry *registry, const char *subject,
                             const char *id, const char *name, const qc_interface **out);

typedef struct qc__step {
    char *name;
    const qc_stage *stage;
    void *params;
    char **text; /* [n_params] storage of QC_TEXT values */
    char **wire; /* [n_in] NULL = by the rule, "" = unwired, else "step.port" or a bag name */
    double seconds;
} qc__step;

struct qc_pipeline {
    qc_registry *registry;
    qc__step *step;
    int64_t n, capacity;
    char *number; /* 64 bytes: the answer of qc_pipeline_get */
};

/* -1 when there is none. */
int64_t qc__pipeline_find(const qc_pipeline *pipeline, const char *step);

/* --- ports ------------------------------------------------------------------------------------ */

/* The objects a step may see: those of `io` and the outputs of steps first .. step-1, which are in
 * `held` during a run and only promised before it (held NULL). */
typedef struct qc__scope {
    const qc_pipeline *pipeline;
    uint32_t first;
    const qc_bag *io, *held;
} qc__scope;

typedef enum qc__fit {
    QC__FIT_NONE,  /* nothing there, or nothing of this type */
    QC__FIT_MAYBE, /* promised by an optional output */
    QC__FIT_SURE
} qc__fit;

/* Finds what input port `port` of step `step` takes: *object, or NULL while it is only promised. */
qc__fit qc__port_resolve(const qc__scope *scope, uint32_t step, uint32_t port,
                         const qc_object **object);

qc_status qc__check_range(const qc_pipeline *pipeline, uint32_t first, uint32_t last,
                          const qc_bag *io);

#endif
