/* qc/stage.h - a stage is a constant table plus one function.
 *
 * Built-in stages and those of plugins use the same table; the registry, the command line, the
 * bindings and the reference pages are all made from it. Ports carry objects whose type id includes
 * its version ("qc.mesh/1"). A stage sees nothing but its `qc_run`. */
#ifndef QC_STAGE_H
#define QC_STAGE_H

#include <qc/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Names of ports and parameters are made of letters, digits, _ and -; ids also of dots. All strings
 * of a table live as long as the table. */
enum { QC_PORT_OPTIONAL = 1 };
typedef struct qc_port {
    const char *name, *type; /* "field", "qc.face_field/1"                                        */
    uint32_t flags;          /* QC_PORT_OPTIONAL: may be unwired (in) or absent (out)             */
    const char *doc;
} qc_port;

enum { QC_BOOL = 1, QC_INT, QC_REAL, QC_ENUM, QC_TEXT }; /* qc_param.type                         */

/* One parameter: enough for a command line flag, a Python keyword and a row of documentation. The
 * member at `offset` of the stage's params struct is a bool, int64_t, double, int32_t (position in
 * choices) or const char * (borrowed for the run; NULL when not set) respectively. */
typedef struct qc_param {
    const char *name;
    int32_t type;
    uint32_t offset;
    double def, min, max;       /* def in [min, max], may be infinite; bool: 0/1; enum: def is a
                                   position, min and max ignored; text: all ignored               */
    const char *const *choices; /* QC_ENUM: NULL-terminated names; QC_TEXT: NULL, or { id, NULL }:
                                   the text names an interface of that id (qc_run.find)           */
    const char *unit, *doc;     /* "deg", "edge" (= mean edge length), "" for pure numbers        */
} qc_param;

#define QC_PARAM_BOOL(S, field, def, doc)                                                          \
    { #field, QC_BOOL, (uint32_t)offsetof(S, field), (def) ? 1.0 : 0.0, 0, 1, NULL, "", doc }
#define QC_PARAM_INT(S, field, def, min, max, unit, doc)                                           \
    { #field, QC_INT, (uint32_t)offsetof(S, field), def, min, max, NULL, unit, doc }
#define QC_PARAM_REAL(S, field, def, min, max, unit, doc)                                          \
    { #field, QC_REAL, (uint32_t)offsetof(S, field), def, min, max, NULL, unit, doc }
#define QC_PARAM_ENUM(S, field, def, choices, doc)                                                 \
    { #field, QC_ENUM, (uint32_t)offsetof(S, field), def, 0, 0, choices, "", doc }
#define QC_PARAM_TEXT(S, field, doc)                                                               \
    { #field, QC_TEXT, (uint32_t)offsetof(S, field), 0, 0, 0, NULL, "", doc }
/* id: a `const char *const []` of an interface id and NULL. */
#define QC_PARAM_INTERFACE(S, field, id, doc)                                                      \
    { #field, QC_TEXT, (uint32_t)offsetof(S, field), 0, 0, 0, id, "", doc }

/* A stage's whole view of its host; valid during run() only. Calling thread only. */
typedef struct qc_run {
    uint32_t struct_size;
    void *host_data;
    qc_ctx *ctx;
    /* Borrowed object on an input port (its first member is a qc_object); NULL = unwired. */
    const void *(*input)(const struct qc_run *run, const char *port);
    /* Publishes an object on an output port: moves the caller's reference, also on failure.
     * ARGUMENT when the port is unknown or the object's type is not the port's. */
    qc_status (*output)(const struct qc_run *run, const char *port, void *object);
    /* fraction of this stage; false: clean up and return QC_ERR_CANCELLED. */
    bool (*progress)(const struct qc_run *run, double fraction);
    void (*log)(const struct qc_run *run, int32_t level, const char *text);
    /* Records the error text (one line; which element, what to do) and returns status. Call it as
     * (run->fail)(...) where a macro `fail` is about. */
    qc_status (*fail)(const struct qc_run *run, qc_status status, int64_t where, const char *text);
    /* The interface called `name` under an id (QC_SOLVER_ID), the built-in one for NULL; borrowed
     * for the run. NULL after recording NOT_FOUND with the closest name. Since ABI minor 1. */
    const qc_interface *(*find)(const struct qc_run *run, const char *id, const char *name);
} qc_run;

typedef struct qc_stage {
    uint32_t struct_size, port_size, param_size; /* QC_STAGE_SIZES: older tables still read       */
    const char *id, *version; /* "qc.hodge", "1.0"; both recorded in every result                 */
    const char *brief;        /* one line                                                         */
    const char *doc;          /* paragraphs                                                       */
    const char *cite;         /* source: "thesis 4.1, eq. (6.1)"                                  */
    const qc_port *in, *out;
    uint32_t n_in, n_out;
    const qc_param *params;
    uint32_t n_params, params_size; /* params_size = sizeof the params struct                     */
    /* Success requires that every non-optional output was published. On error nothing published
     * counts. params points to a filled, range-checked struct. Inputs are immutable; the stage owns
     * nothing but what it makes, and keeps no pointer after it returns. */
    qc_status (*run)(const qc_run *run, const void *params);
} qc_stage;
#define QC_STAGE_SIZES sizeof(qc_stage), sizeof(qc_port), sizeof(qc_param)

#ifdef __cplusplus
}
#endif
#endif
