/* Errors, log and progress of a context: nested ranges, cancelling, option structs of any size. */
#include "tests/unit/base/base_test.h"

typedef struct watcher {
    double fraction;
    char stage[64], text[64];
    bool stop;
} watcher;

static bool on_progress(void *user, const char *stage, double fraction) {
    watcher *w = user;
    w->fraction = fraction;
    snprintf(w->stage, sizeof w->stage, "%s", stage);
    return !w->stop;
}
static void on_log(void *user, int32_t level, const char *stage, const char *text) {
    watcher *w = user;
    snprintf(w->text, sizeof w->text, "%d|%s|%s", (int)level, stage, text);
}

static qc_ctx *watched(watcher *w) {
    qc_ctx_options o = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx;
    *w = (watcher){0};
    o.progress = on_progress;
    o.log = on_log;
    o.user = w;
    assert_int_equal(qc_ctx_create(&o, &ctx), QC_OK);
    return ctx;
}

static void ranges_nest(void **state) {
    (void)state;
    watcher w;
    qc_ctx *ctx = watched(&w);
    assert_true(qc__progress(ctx, 0.25) && w.fraction == 0.25);
    assert_string_equal(w.stage, "");
    const qc__range outer = qc__range_begin(ctx, "hodge", 0.5, 1.0);
    assert_true(qc__progress(ctx, -1.0) && w.fraction == 0.5); /* clamped */
    const qc__range inner = qc__range_begin(ctx, NULL, 0.0, 0.5);
    assert_true(qc__progress(ctx, 0.5) && w.fraction == 0.625);
    assert_true(qc__progress(ctx, 7.0) && w.fraction == 0.75);
    assert_string_equal(w.stage, "hodge");
    qc__log(ctx, QC_LOG_WARNING, "%d steps", 3);
    assert_string_equal(w.text, "2|hodge|3 steps");
    qc__range_end(ctx, inner);
    qc__range_end(ctx, outer);
    assert_true(qc__progress(ctx, 1.0) && w.fraction == 1.0);
    qc_ctx_free(ctx);
}

/* Loops which start again report small fractions; who watches sees none go back. */
static void fractions_never_fall_within_the_outermost_range(void **state) {
    (void)state;
    watcher w;
    qc_ctx *ctx = watched(&w);
    for (int run = 0; run < 2; run++) {
        const qc__range outer = qc__range_begin(ctx, "round", 0.0, 1.0);
        for (int trial = 0; trial < 3; trial++) {
            const qc__range inner = qc__range_begin(ctx, NULL, 0.25, 0.75);
            assert_true(qc__progress(ctx, 0.0) && w.fraction == (trial ? 0.75 : 0.25));
            assert_true(qc__progress(ctx, 1.0) && w.fraction == 0.75);
            assert_true(qc__poll(ctx) == QC_OK && w.fraction == 0.75);
            qc__range_end(ctx, inner);
        }
        qc__range_end(ctx, outer);
    }
    assert_true(qc__progress(ctx, 0.1) && w.fraction == 0.1); /* outside of ranges: as given */
    qc_ctx_free(ctx);
}

static void false_cancels(void **state) {
    (void)state;
    watcher w;
    qc_ctx *ctx = watched(&w);
    w.stop = true;
    assert_false(qc__progress(ctx, 0.5));
    assert_true(qc__cancelled(ctx));
    assert_int_equal(qc__poll(ctx), QC_ERR_CANCELLED);
    assert_int_equal(qc_ctx_error(ctx)->status, QC_ERR_CANCELLED);
    w.stop = false;
    assert_true(qc__progress(ctx, 0.0)); /* the next run starts afresh */
    assert_false(qc__cancelled(ctx));
    qc_ctx_free(ctx);
}

static void a_step_speaks_for_itself(void **state) {
    (void)state;
    watcher w;
    qc_ctx *ctx = watched(&w);
    assert_string_equal(qc_ctx_progress_detail(ctx), "");
    const qc__range outer = qc__range_begin(ctx, "curl", 0, 0.5);
    qc__detail(ctx, "%d points", 12);
    assert_string_equal(qc_ctx_progress_detail(ctx), "12 points");
    qc__range_end(ctx, qc__range_begin(ctx, NULL, 0, 0.5));
    assert_string_equal(qc_ctx_progress_detail(ctx), "12 points");
    qc__range_end(ctx, outer);
    qc__range_begin(ctx, "hodge", 0.5, 1);
    assert_string_equal(qc_ctx_progress_detail(ctx), "");
    qc_ctx_free(ctx);
}

/* Far from either end, so that the speed of the machine does not matter. */
static void budgets_are_for_steps(void **state) {
    (void)state;
    watcher w;
    qc_ctx *ctx = watched(&w);
    qc__time outer = qc__time_begin_step(ctx);
    assert_false(qc__out_of_time(ctx)); /* no budget */
    assert_true(qc__time_left(ctx) > 1e300);
    qc__time_end_step(ctx, outer);
    qc_ctx_set_time_budget(ctx, 1e6);
    assert_true(qc__time_left(ctx) > 1e300); /* not in a step */
    outer = qc__time_begin_step(ctx);
    assert_false(qc__out_of_time(ctx));
    assert_true(qc__time_left(ctx) > 4e5 && qc__time_left(ctx) <= 5e5);
    qc__time_end_step(ctx, outer);
    const qc__time whole = qc__time_share(ctx, 0.1);
    outer = qc__time_begin_step(ctx);
    assert_true(qc__time_left(ctx) > 4e4 && qc__time_left(ctx) <= 5e4);
    qc__time_end_step(ctx, outer);
    qc__time_end_share(ctx, whole);
    qc_ctx_set_time_budget(ctx, 0);
    assert_false(qc__out_of_time(ctx)); /* not in a step */
    outer = qc__time_begin_step(ctx);
    assert_true(qc__out_of_time(ctx));
    assert_string_equal(w.text, "2||ended early for lack of time, with the best so far");
    w.text[0] = '\0';
    assert_true(qc__out_of_time(ctx));
    assert_string_equal(w.text, ""); /* said once */
    qc__time_end_step(ctx, outer);
    qc_ctx_set_time_budget(ctx, -1);
    outer = qc__time_begin_step(ctx);
    assert_false(qc__out_of_time(ctx));
    qc__time_end_step(ctx, outer);
    qc_ctx_free(ctx);
}

static void errors_are_one_line(void **state) {
    (void)state;
    watcher w;
    qc_ctx *ctx = watched(&w);
    const qc__range outer = qc__range_begin(ctx, "round", 0, 1);
    assert_int_equal(qc__fail(ctx, QC_ERR_INPUT, 12, "line\n%s", "break"), QC_ERR_INPUT);
    qc__range_end(ctx, outer);
    const qc_error *e = qc_ctx_error(ctx);
    assert_string_equal(e->text, "line break");
    assert_string_equal(e->stage, "round");
    assert_int_equal(e->where, 12);
    assert_int_equal(qc__fail(ctx, QC_ERR_IO, 1, "again: %s", e->text), QC_ERR_IO);
    assert_string_equal(qc_ctx_error(ctx)->text, "again: line break");
    char longer[2000];
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    qc__fail(ctx, QC_ERR_IO, 1, "%s", longer);
    assert_in_range(strlen(qc_ctx_error(ctx)->text), 100, 1000);
    qc_ctx_free(ctx);
}

static void option_structs_of_any_size_are_read(void **state) {
    (void)state;
    struct {
        qc_ctx_options o;
        void *later;
    } newer = {QC_CTX_OPTIONS_INIT, NULL};
    qc_ctx *ctx;
    newer.o.struct_size = sizeof newer;
    newer.o.threads = 3;
    assert_int_equal(qc_ctx_create(&newer.o, &ctx), QC_OK);
    assert_int_equal(qc_ctx_threads(ctx), 3);
    qc_ctx_free(ctx);
    newer.o.struct_size = offsetof(qc_ctx_options, resize); /* the first two members only */
    assert_int_equal(qc_ctx_create(&newer.o, &ctx), QC_OK);
    qc_ctx_free(ctx);
    newer.o.struct_size = 0;
    assert_int_equal(qc_ctx_create(&newer.o, &ctx), QC_ERR_ABI);
    assert_int_equal(qc_ctx_create(NULL, NULL), QC_ERR_ARGUMENT);
    qc_ctx_free(NULL);
}

static void instructions_are_chosen_and_reported(void **state) {
    (void)state;
    qc_ctx_options o = QC_CTX_OPTIONS_INIT;
    qc_ctx *ctx;
    assert_int_equal(qc_ctx_create(&o, &ctx), QC_OK);
    const char *best = qc_ctx_instructions(ctx);
    qc_ctx_free(ctx);
    o.instructions = best;
    assert_int_equal(qc_ctx_create(&o, &ctx), QC_OK);
    assert_string_equal(qc_ctx_instructions(ctx), best);
    qc_ctx_free(ctx);
    o.instructions = "portable"; /* every processor has it */
    assert_int_equal(qc_ctx_create(&o, &ctx), QC_OK);
    assert_string_equal(qc_ctx_instructions(ctx), "portable");
    qc_ctx_free(ctx);
    o.instructions = "avx1024";
    assert_int_equal(qc_ctx_create(&o, &ctx), QC_ERR_ARGUMENT);
}

static void every_status_has_a_name(void **state) {
    (void)state;
    assert_string_equal(qc_status_name(QC_OK), "ok");
    assert_string_equal(qc_status_name(QC_ERR_CANCELLED), "cancelled");
    for (qc_status s = QC_ERR_UNSUPPORTED; s <= QC_OK; s++)
        assert_string_not_equal(qc_status_name(s), "unknown status");
    assert_string_equal(qc_status_name(1), "unknown status");
    assert_string_equal(qc_status_name(INT32_MIN), "unknown status");
    assert_string_equal(qc_status_name(QC_ERR_UNSUPPORTED - 1), "unknown status");
    assert_string_equal(qc_version(), QC_VERSION_STRING);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranges_nest),
        cmocka_unit_test(fractions_never_fall_within_the_outermost_range),
        cmocka_unit_test(false_cancels),
        cmocka_unit_test(a_step_speaks_for_itself),
        cmocka_unit_test(budgets_are_for_steps),
        cmocka_unit_test(errors_are_one_line),
        cmocka_unit_test(option_structs_of_any_size_are_read),
        cmocka_unit_test(instructions_are_chosen_and_reported),
        cmocka_unit_test(every_status_has_a_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
