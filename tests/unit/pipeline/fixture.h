/* Small stages on numbers, enough to test wiring and runs. */
#ifndef QC_TESTS_PIPELINE_FIXTURE_H
#define QC_TESTS_PIPELINE_FIXTURE_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>
#include "sdk/pipeline/internal.h"

#define NUMBER "test.number/1"
#define LABEL  "test.label/1"

#define GREETER "test.greeter/1"
extern const qc_interface fixture_greeter; /* built-in, called "builtin" */

typedef struct number {
    qc_object object;
    double value;
} number;
extern int live_objects;
number *number_create(const char *type, double value);

typedef struct kinds { /* one parameter of each type */
    bool flag;
    int64_t count;
    double ratio;
    int32_t mode;
    const char *name;
} kinds;
extern const char *const modes[]; /* "fast", "best" */

extern const qc_stage stage_make; /* -> number = count + ratio; all kinds of parameters */
extern const qc_stage stage_add;  /* number, optional `more` -> sum + amount */
extern const qc_stage stage_tag;  /* number -> label, and an optional number when `extra` is set */
extern const qc_stage stage_read; /* label -> number */
extern const qc_stage stage_bad;  /* number -> number; fails in the way its parameter says */

typedef struct fixture {
    qc_ctx *ctx;
    qc_registry *registry;
    qc_pipeline *pipeline;
    qc_bag *bag;
    int64_t allowed;  /* allocations which succeed before one fails; < 0 = all do */
    int64_t blocks;   /* not yet freed */
    double cancel_at; /* progress from which the callback says stop */
    double last;      /* last fraction seen */
    bool backwards;   /* a fraction was below the one before it */
    char trace[512];  /* stage names in the order in which they reported */
    char logged[256];
} fixture;
int setup(void **state); /* a context, the registry with the stages above, empty pipeline and bag */
int teardown(void **state); /* also checks that no block and no object is left */
double value_of(const qc_bag *bag, const char *name);
const char *error_text(const fixture *f);

#endif
