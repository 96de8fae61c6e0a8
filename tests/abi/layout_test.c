/* Layouts frozen by ABI major 1: members may be appended, never moved. 64-bit targets. */
#include "tests/unit/pipeline/fixture.h"

#define AT(T, member, where) _Static_assert(offsetof(T, member) == (where), #T "." #member)

#if UINTPTR_MAX == UINT64_MAX
AT(qc_object, type, 0);
AT(qc_object, destroy, 8);
AT(qc_object, references, 16);
AT(qc_object, reserved, 20);
_Static_assert(sizeof(qc_object) == 24, "starts every object: can never grow");
_Static_assert(sizeof(qc_complex) == 16, "two doubles");

AT(qc_interface, struct_size, 0);
AT(qc_interface, flags, 4);
AT(qc_interface, name, 8);
AT(qc_interface, doc, 16);
_Static_assert(sizeof(qc_interface) == 24, "starts every interface table: can never grow");

AT(qc_ctx_options, struct_size, 0);
AT(qc_ctx_options, threads, 4);
AT(qc_ctx_options, resize, 8);
AT(qc_ctx_options, log, 16);
AT(qc_ctx_options, progress, 24);
AT(qc_ctx_options, user, 32);
AT(qc_ctx_options, instructions, 40);
AT(qc_ctx_options, sample, 48);

AT(qc_error, status, 0);
AT(qc_error, where, 8);
AT(qc_error, stage, 16);
AT(qc_error, text, 24);

AT(qc_port, name, 0);
AT(qc_port, type, 8);
AT(qc_port, flags, 16);
AT(qc_port, doc, 24);

AT(qc_param, name, 0);
AT(qc_param, type, 8);
AT(qc_param, offset, 12);
AT(qc_param, def, 16);
AT(qc_param, min, 24);
AT(qc_param, max, 32);
AT(qc_param, choices, 40);
AT(qc_param, unit, 48);
AT(qc_param, doc, 56);

AT(qc_run, struct_size, 0);
AT(qc_run, host_data, 8);
AT(qc_run, ctx, 16);
AT(qc_run, input, 24);
AT(qc_run, output, 32);
AT(qc_run, progress, 40);
AT(qc_run, log, 48);
AT(qc_run, fail, 56);
AT(qc_run, find, 64);

AT(qc_stage, struct_size, 0);
AT(qc_stage, port_size, 4);
AT(qc_stage, param_size, 8);
AT(qc_stage, id, 16);
AT(qc_stage, version, 24);
AT(qc_stage, brief, 32);
AT(qc_stage, doc, 40);
AT(qc_stage, cite, 48);
AT(qc_stage, in, 56);
AT(qc_stage, out, 64);
AT(qc_stage, n_in, 72);
AT(qc_stage, n_out, 76);
AT(qc_stage, params, 80);
AT(qc_stage, n_params, 88);
AT(qc_stage, params_size, 92);
AT(qc_stage, run, 96);

AT(qc_host, struct_size, 0);
AT(qc_host, abi_major, 4);
AT(qc_host, abi_minor, 6);
AT(qc_host, name, 8);
AT(qc_host, version, 16);
AT(qc_host, host_data, 24);
AT(qc_host, get_interface, 32);

AT(qc_plugin, struct_size, 0);
AT(qc_plugin, abi_major, 4);
AT(qc_plugin, abi_minor, 6);
AT(qc_plugin, id, 8);
AT(qc_plugin, version, 16);
AT(qc_plugin, license, 24);
AT(qc_plugin, url, 32);
AT(qc_plugin, open, 40);
AT(qc_plugin, close, 48);
AT(qc_plugin, stages, 56);
AT(qc_plugin, extension, 64);
#endif

_Static_assert(sizeof(qc_status) == 4, "fixed width");
_Static_assert(QC_ERR_UNSUPPORTED == -12 && QC_ERR_ABI == -6, "statuses are never renumbered");
_Static_assert(QC_BOOL == 1 && QC_INT == 2 && QC_REAL == 3 && QC_ENUM == 4 && QC_TEXT == 5,
               "types");
_Static_assert(QC_LOG_DEBUG == 0 && QC_LOG_ERROR == 3, "levels");

static void the_plugin_symbol_carries_the_major_version(void **state) {
    (void)state;
    char expected[32];
    snprintf(expected, sizeof expected, "qc_plugin_%d", QC_ABI_MAJOR);
    assert_string_equal(QC_PLUGIN_SYMBOL, expected);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_plugin_symbol_carries_the_major_version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
