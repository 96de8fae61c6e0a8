/* The tables of the built-in stages: complete enough for flags, keywords and reference pages. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <qc/pipeline.h>
#include <string.h>

static qc_ctx *ctx;
static qc_registry *registry;

static int setup(void **state) {
    (void)state;
    return qc_ctx_create(NULL, &ctx) || qc_registry_create(ctx, &registry);
}

static int teardown(void **state) {
    (void)state;
    qc_registry_free(registry);
    qc_ctx_free(ctx);
    return 0;
}

static void has_text(const char *stage, const char *what, const char *text) {
    if (!text || !*text) print_error("stage %s: %s has no text\n", stage, what);
    assert_true(text && *text);
}

static void every_stage_is_documented(void **state) {
    (void)state;
    assert_true(qc_registry_count(registry) > 0);
    for (uint32_t i = 0; i < qc_registry_count(registry); i++) {
        const qc_stage *s = qc_registry_stage(registry, i);
        assert_true(strncmp(s->id, "qc.", 3) == 0);
        has_text(s->id, "version", s->version);
        has_text(s->id, "brief", s->brief);
        assert_null(strchr(s->brief, '\n'));
        has_text(s->id, "doc", s->doc);
        for (uint32_t k = 0; k < s->n_in; k++) has_text(s->id, s->in[k].name, s->in[k].doc);
        for (uint32_t k = 0; k < s->n_out; k++) has_text(s->id, s->out[k].name, s->out[k].doc);
        for (uint32_t k = 0; k < s->n_params; k++)
            has_text(s->id, s->params[k].name, s->params[k].doc);
    }
}

/* "qc.mesh/1": every port type carries its version, and somebody gives what somebody takes. */
static void port_types_carry_a_version(void **state) {
    (void)state;
    for (uint32_t i = 0; i < qc_registry_count(registry); i++) {
        const qc_stage *s = qc_registry_stage(registry, i);
        for (uint32_t k = 0; k < s->n_in + s->n_out; k++) {
            const qc_port *port = k < s->n_in ? &s->in[k] : &s->out[k - s->n_in];
            const char *slash = strrchr(port->type, '/');
            assert_true(slash && slash[1] >= '1' && slash[1] <= '9');
        }
    }
}

static void defaults_survive_printing_and_reading(void **state) {
    (void)state;
    qc_pipeline *a, *b;
    char *first, *second;
    assert_int_equal(qc_pipeline_create(registry, &a), QC_OK);
    for (uint32_t i = 0; i < qc_registry_count(registry); i++)
        assert_int_equal(qc_pipeline_insert(a, i, NULL, qc_registry_stage(registry, i)->id), QC_OK);
    assert_int_equal(qc_pipeline_print(a, &first), QC_OK);
    assert_int_equal(qc_pipeline_parse(registry, first, &b), QC_OK);
    assert_int_equal(qc_pipeline_print(b, &second), QC_OK);
    assert_string_equal(first, second);
    qc_text_free(first);
    qc_text_free(second);
    qc_pipeline_free(a);
    qc_pipeline_free(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_stage_is_documented),
        cmocka_unit_test(port_types_carry_a_version),
        cmocka_unit_test(defaults_survive_printing_and_reading),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
