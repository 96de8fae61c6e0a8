/* A plugin built with a later header of the same major version: every struct has grown at its end.
 */
#include <qc/plugin.h>

typedef struct long_port {
    qc_port port;
    const char *colour;
} long_port;

typedef struct long_param {
    qc_param param;
    double step;
} long_param;

typedef struct long_stage {
    qc_stage stage;
    void *more;
} long_stage;

typedef struct long_plugin {
    qc_plugin plugin;
    void *more;
} long_plugin;

typedef struct options {
    bool a, b;
} options;

typedef struct number {
    qc_object object;
    double value;
} number;

QC_EXPORT int opened, closed, knows_host;

static qc_status run(const qc_run *r, const void *params) {
    const options *o = params;
    number *n = (number *)qc_object_retain(r->input(r, "two"));
    n->value = (o->a ? 1 : 0) + (o->b ? 10 : 0);
    return r->output(r, "number", n);
}

static const long_port in[] = {{{"one", "test.label/1", QC_PORT_OPTIONAL, "first"}, "red"},
                               {{"two", "test.number/1", 0, "second"}, "blue"}};
static const long_port out[] = {{{"number", "test.number/1", 0, "result"}, "green"}};
static const long_param params[] = {{QC_PARAM_BOOL(options, a, false, "a flag"), 1},
                                    {QC_PARAM_BOOL(options, b, true, "another"), 2}};
static const long_stage stage = {{sizeof(long_stage), sizeof(long_port), sizeof(long_param),
                                  "org.test.longer", "1", "built with a longer header", "", "",
                                  &in[0].port, &out[0].port, 2, 1, &params[0].param, 2,
                                  sizeof(options), run},
                                 NULL};
static const qc_stage *const list[] = {&stage.stage, NULL};
static const qc_stage *const *stages(void) {
    return list;
}

static qc_status open(const qc_host *host) {
    opened++;
    knows_host = host->abi_major == QC_ABI_MAJOR && host->struct_size >= sizeof(qc_host) &&
                 host->get_interface(host, "org.test.nothing/1") == NULL;
    return QC_OK;
}
static void close(void) {
    closed++;
}

QC_PLUGIN_EXPORT const long_plugin qc_plugin_1 = {{sizeof(long_plugin), QC_ABI_MAJOR, 7,
                                                   "org.test.longer", "1", "MIT", "", open, close,
                                                   stages, NULL},
                                                  NULL};
