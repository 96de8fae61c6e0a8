#include "tests/unit/pipeline/fixture.h"
#include "sdk/pipeline/builtin.h"
#include <stdlib.h>

int live_objects;
const char *const modes[] = {"fast", "best", NULL};

static void destroy(qc_object *object) {
    free(object);
    live_objects--;
}

number *number_create(const char *type, double value) {
    number *n = malloc(sizeof *n);
    qc_object_init(&n->object, type, destroy);
    n->value = value;
    live_objects++;
    return n;
}

static qc_status run_make(const qc_run *run, const void *params) {
    const kinds *k = params;
    return run->output(run, "number", number_create(NUMBER, (double)k->count + k->ratio));
}
static const qc_port make_out[] = {{"number", NUMBER, 0, "the sum"}};
static const qc_param make_params[] = {
    QC_PARAM_BOOL(kinds, flag, true, "a flag"),
    QC_PARAM_INT(kinds, count, 3, -10, 1e9, "", "a count"),
    QC_PARAM_REAL(kinds, ratio, 0.1, 0, 1, "edge", "a ratio"),
    QC_PARAM_ENUM(kinds, mode, 1, modes, "a mode"),
    QC_PARAM_TEXT(kinds, name, "a name"),
};
const qc_stage stage_make = {
    QC_STAGE_SIZES, "qc.make", "1.0",         "makes a number", "", "", NULL, make_out, 0, 1,
    make_params,    5,         sizeof(kinds), run_make};

typedef struct add_options {
    double amount;
} add_options;
static qc_status run_add(const qc_run *run, const void *params) {
    const number *a = run->input(run, "number"), *b = run->input(run, "more");
    for (int i = 0; i < 4; i++)
        if (!run->progress(run, i / 4.0)) return QC_ERR_CANCELLED;
    run->log(run, QC_LOG_INFO, "adding");
    const double sum = a->value + (b ? b->value : 0) + ((const add_options *)params)->amount;
    return run->output(run, "number", number_create(NUMBER, sum));
}
static const qc_port add_in[] = {{"number", NUMBER, 0, ""}, {"more", LABEL, QC_PORT_OPTIONAL, ""}};
static const qc_param add_params[] = {
    QC_PARAM_REAL(add_options, amount, 1, -1e30, 1e30, "", "what to add")};
const qc_stage stage_add = {
    QC_STAGE_SIZES,      "qc.add", "1.0", "adds", "", "", add_in, make_out, 2, 1, add_params, 1,
    sizeof(add_options), run_add};

typedef struct tag_options {
    bool extra;
} tag_options;
static qc_status run_tag(const qc_run *run, const void *params) {
    const number *a = run->input(run, "number");
    const qc_status status = run->output(run, "label", number_create(LABEL, 100 * a->value));
    if (status != QC_OK || !((const tag_options *)params)->extra) return status;
    return run->output(run, "extra", number_create(NUMBER, -a->value));
}
static const qc_port tag_out[] = {{"label", LABEL, 0, ""}, {"extra", NUMBER, QC_PORT_OPTIONAL, ""}};
static const qc_param tag_params[] = {QC_PARAM_BOOL(tag_options, extra, false, "")};
const qc_stage stage_tag = {QC_STAGE_SIZES,
                            "org.test.tag",
                            "2.5",
                            "tags",
                            "",
                            "",
                            add_in,
                            tag_out,
                            1,
                            2,
                            tag_params,
                            1,
                            sizeof(tag_options),
                            run_tag};

static qc_status run_read(const qc_run *run, const void *params) {
    (void)params;
    const number *a = run->input(run, "label");
    return run->output(run, "number", number_create(NUMBER, a->value));
}
static const qc_port read_in[] = {{"label", LABEL, 0, ""}};
const qc_stage stage_read = {QC_STAGE_SIZES, "qc.read", "1.0", "reads", "", "", read_in,
                             make_out,       1,         1,     NULL,    0,  0,  run_read};

typedef struct bad_options {
    int32_t how;
} bad_options;
static const char *const ways[] = {"text", "silent", "nothing", "type", "port", "twice", NULL};
static qc_status run_bad(const qc_run *run, const void *params) {
    const int32_t how = ((const bad_options *)params)->how;
    qc_status status = QC_OK;
    if (how != 2) status = run->output(run, "number", number_create(NUMBER, 1));
    if (how == 0) return (run->fail)(run, QC_ERR_FAILED, 7, "face 7 is folded");
    if (how == 1) return QC_ERR_NOT_POSDEF;
    if (how == 3) status = run->output(run, "number", number_create(LABEL, 1));
    if (how == 4) status = run->output(run, "nowhere", number_create(NUMBER, 1));
    if (how == 5) status = run->output(run, "number", number_create(NUMBER, 2));
    return status;
}
static const qc_param bad_params[] = {QC_PARAM_ENUM(bad_options, how, 0, ways, "")};
const qc_stage stage_bad = {
    QC_STAGE_SIZES,      "qc.bad", "1.0", "fails", "", "", add_in, make_out, 1, 1, bad_params, 1,
    sizeof(bad_options), run_bad};

const qc_stage *const qc__builtin_stages[] = {&stage_make, &stage_add, &stage_tag,
                                              &stage_read, &stage_bad, NULL};

const qc_interface fixture_greeter = {sizeof(qc_interface), 0, "builtin", "says hello"};
const qc__offer qc__builtin_interfaces[] = {{GREETER, &fixture_greeter}, {NULL, NULL}};

static void *counted_resize(void *user, void *p, size_t old_size, size_t new_size) {
    fixture *f = user;
    (void)old_size;
    if (new_size == 0) {
        if (p) f->blocks--;
        free(p);
        return NULL;
    }
    if (f->allowed == 0) return NULL;
    if (f->allowed > 0) f->allowed--;
    if (!p) f->blocks++;
    return realloc(p, new_size);
}

static bool on_progress(void *user, const char *stage, double fraction) {
    fixture *f = user;
    const size_t used = strlen(f->trace), n = strlen(stage);
    const char *last = strrchr(f->trace, ' ');
    if (strcmp(last ? last + 1 : f->trace, stage) != 0 && used + n + 2 < sizeof f->trace)
        snprintf(f->trace + used, sizeof f->trace - used, "%s%s", used ? " " : "", stage);
    f->backwards = f->backwards || fraction < f->last;
    f->last = fraction;
    return fraction < f->cancel_at;
}

static void on_log(void *user, int32_t level, const char *stage, const char *text) {
    fixture *f = user;
    snprintf(f->logged, sizeof f->logged, "%d %s: %s", (int)level, stage, text);
}

int setup(void **state) {
    fixture *f = calloc(1, sizeof *f);
    f->allowed = -1;
    f->cancel_at = 2;
    qc_ctx_options o = QC_CTX_OPTIONS_INIT;
    o.resize = counted_resize;
    o.log = on_log;
    o.progress = on_progress;
    o.threads = 1;
    o.user = f;
    live_objects = 0;
    *state = f;
    return qc_ctx_create(&o, &f->ctx) || qc_registry_create(f->ctx, &f->registry) ||
           qc_pipeline_create(f->registry, &f->pipeline) || qc_bag_create(f->ctx, &f->bag);
}

int teardown(void **state) {
    fixture *f = *state;
    qc_bag_free(f->bag);
    qc_pipeline_free(f->pipeline);
    qc_registry_free(f->registry);
    qc_ctx_free(f->ctx);
    const int leaked = f->blocks != 0 || live_objects != 0;
    free(f);
    return leaked;
}

double value_of(const qc_bag *bag, const char *name) {
    const number *n = qc_bag_get(bag, name);
    assert_non_null(n);
    return n->value;
}

const char *error_text(const fixture *f) {
    return qc_ctx_error(f->ctx)->text;
}
