/* Runs the tasks of a batch, so many at a time, and hands their lines to one collector. */
#include "bindings/cli/batch.h"
#include <signal.h>
#include <stdlib.h>
#include <time.h>

typedef struct pool {
    batch_worker *worker;
    int jobs, running, status;
    size_t next;
    bool stopping;
} pool;

/* Ctrl-C, or the collector wants no more: everything running ends, without lines. */
static void stop(pool *p) {
    p->stopping = true;
    for (int i = 0; i < p->jobs; i++)
        if (p->worker[i].pid > 0) batch_worker_stop(&p->worker[i], "interrupted");
}

static void start(pool *p, const json_t *tasks, const char *program) {
    for (int i = 0; i < p->jobs && p->next < json_array_size(tasks) && !p->stopping; i++) {
        if (p->worker[i].pid > 0) continue;
        if (!batch_worker_start(&p->worker[i], json_array_get(tasks, p->next), program)) {
            p->status = EXIT_FAILED;
            stop(p);
            return;
        }
        p->next++;
        p->running++;
    }
}

static void collect(pool *p, const batch_events *events) {
    for (int i = 0; i < p->jobs; i++) {
        json_t *line = NULL, *task = p->worker[i].task;
        if (!batch_worker_ended(&p->worker[i], &line)) {
            if (p->worker[i].pid > 0) batch_worker_watch(&p->worker[i]);
            continue;
        }
        p->running--;
        if (line && p->status == EXIT_DONE) {
            p->status = events->line(events->user, task, line);
            if (p->status != EXIT_DONE) stop(p);
        }
        json_decref(line);
    }
}

/* Until a worker ends or a signal comes, or for a moment: limits are looked at in between. */
static void wait_a_moment(const sigset_t *child_ends) {
    const struct timespec moment = {0, 50000000};
    sigtimedwait(child_ends, NULL, &moment);
}

int batch_run(const json_t *tasks, int jobs, const char *program, const batch_events *events) {
    pool p = {calloc((size_t)jobs, sizeof *p.worker), jobs, 0, EXIT_DONE, 0, false};
    sigset_t child_ends, before;
    if (!p.worker) return cli_error(EXIT_FAILED, "out of memory");
    sigemptyset(&child_ends);
    sigaddset(&child_ends, SIGCHLD);
    sigprocmask(SIG_BLOCK, &child_ends, &before);
    cli_catch_interrupts();
    for (start(&p, tasks, program); p.running > 0; start(&p, tasks, program)) {
        if (events->tick) events->tick(events->user, p.running);
        wait_a_moment(&child_ends);
        if (cli_interrupted() && !p.stopping) stop(&p);
        collect(&p, events);
    }
    sigprocmask(SIG_SETMASK, &before, NULL);
    free(p.worker);
    if (p.status == EXIT_DONE && cli_interrupted())
        return cli_error(EXIT_INTERRUPTED, "interrupted; what is finished is kept");
    return p.status;
}
