/* One good stage, which replaces a built-in one, and one bad stage: neither may be registered. */
#include <qc/plugin.h>

QC_EXPORT int closed;

static qc_status run(const qc_run *r, const void *params) {
    (void)params;
    return (r->fail)(r, QC_ERR_FAILED, -1, "never");
}
static const qc_stage good = {QC_STAGE_SIZES, "qc.make", "666", "",   "", "", NULL,
                              NULL,           0,         0,     NULL, 0,  0,  run};
static const qc_stage bad = {
    QC_STAGE_SIZES, "no spaces please", "1", "", "", "", NULL, NULL, 0, 0, NULL, 0, 0, run};
static const qc_stage *const list[] = {&good, &bad, NULL};
static const qc_stage *const *stages(void) {
    return list;
}
static void close(void) {
    closed++;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {sizeof(qc_plugin),
                                                QC_ABI_MAJOR,
                                                QC_ABI_MINOR,
                                                "org.test.two_stages",
                                                "1",
                                                "MIT",
                                                "",
                                                NULL,
                                                close,
                                                stages,
                                                NULL};
