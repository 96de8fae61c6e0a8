/* A plugin for the test of batch: one stage which leaves a mesh alone, but crashes, hangs or takes
 * memory on meshes of a given number of faces. */
#include <qc/mesh.h>
#include <qc/plugin.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

typedef struct options {
    int64_t crash, hang, eat;
} options;
static const qc_param params[] = {
    QC_PARAM_INT(options, crash, 0, 0, 1000000, "", "abort at this number of faces"),
    QC_PARAM_INT(options, hang, 0, 0, 1000000, "",
                 "wait while there is a file 'hang', also on SIGTERM"),
    QC_PARAM_INT(options, eat, 0, 0, 1000000, "", "take memory until there is none"),
};
static const qc_port in[] = {{"mesh", QC_TYPE_MESH, 0, "any mesh"}};

/* As long as there is a file of this name. */
static void hang(void) {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, NULL);
    while (access("hang", F_OK) == 0) sleep(1);
}

static void eat(void) {
    const struct timespec moment = {0, 10000000};
    const size_t some = (size_t)4 << 20;
    for (int i = 0; i < 1000; i++) {
        char *volatile memory = malloc(some);
        if (memory) memset(memory, 1, some);
        nanosleep(&moment, NULL);
    }
}

static qc_status run(const qc_run *r, const void *p) {
    const options *o = p;
    const qc_mesh *mesh = r->input(r, "mesh");
    if (mesh->n_faces == o->crash) abort();
    if (mesh->n_faces == o->hang) hang();
    if (mesh->n_faces == o->eat) eat();
    return QC_OK;
}

static const qc_stage stage = {
    QC_STAGE_SIZES,
    .id = "test.trouble",
    .version = "1.0",
    .brief = "Makes trouble",
    .doc = "Crashes, hangs or takes memory.",
    .in = in,
    .n_in = 1,
    .params = params,
    .n_params = sizeof params / sizeof *params,
    .params_size = sizeof(options),
    .run = run,
};
static const qc_stage *const list[] = {&stage, NULL};
static const qc_stage *const *stages(void) {
    return list;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {
    sizeof(qc_plugin), QC_ABI_MAJOR,     QC_ABI_MINOR,     .id = "org.test.trouble",
    .version = "1.0",  .license = "MIT", .stages = stages,
};
