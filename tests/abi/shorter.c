/* A plugin whose header had a qc_port without doc, a qc_param without unit and doc, and a qc_plugin
 * without extension: its tables are shorter, and its strides say so. */
#include <qc/plugin.h>

typedef struct short_port {
    const char *name, *type;
    uint64_t flags;
} short_port;

typedef struct short_param {
    const char *name;
    int32_t type;
    uint32_t offset;
    double def, min, max;
    const char *const *choices;
} short_param;

typedef struct short_plugin {
    uint32_t struct_size;
    uint16_t abi_major, abi_minor;
    const char *id, *version, *license, *url;
    qc_status (*open)(const qc_host *host);
    void (*close)(void);
    const qc_stage *const *(*stages)(void);
} short_plugin;

typedef struct options {
    double factor;
    int64_t count;
} options;

typedef struct number { /* "test.number/1" */
    qc_object object;
    double value;
} number;

/* Publishes its input again, changed: enough to see that every member arrived. */
static qc_status run(const qc_run *r, const void *params) {
    const options *o = params;
    number *n = (number *)qc_object_retain(r->input(r, "given"));
    n->value = n->value * o->factor + (double)o->count;
    return r->output(r, "second", n);
}

static const short_port in[] = {{"given", "test.number/1", 0}};
static const short_port out[] = {{"first", "test.label/1", QC_PORT_OPTIONAL},
                                 {"second", "test.number/1", 0}};
static const short_param params[] = {{"factor", QC_REAL, 0, 2, 0, 10, NULL},
                                     {"count", QC_INT, 8, 5, 0, 9, NULL}};
static const qc_stage stage = {sizeof(qc_stage),
                               sizeof(short_port),
                               sizeof(short_param),
                               "org.test.shorter",
                               "1",
                               "built with a shorter header",
                               "",
                               "",
                               (const qc_port *)in,
                               (const qc_port *)out,
                               1,
                               2,
                               (const qc_param *)params,
                               2,
                               sizeof(options),
                               run};
static const qc_stage *const list[] = {&stage, NULL};
static const qc_stage *const *stages(void) {
    return list;
}

QC_PLUGIN_EXPORT const short_plugin qc_plugin_1 = {sizeof(short_plugin),
                                                   QC_ABI_MAJOR,
                                                   QC_ABI_MINOR,
                                                   "org.test.shorter",
                                                   "1",
                                                   "MIT",
                                                   "",
                                                   NULL,
                                                   NULL,
                                                   stages};
