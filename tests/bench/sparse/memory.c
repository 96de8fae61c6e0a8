/* Peak memory of analysis and factorisation: how far the resident set of a child process, which
 * does nothing else, rises above what it was before (VmHWM - VmRSS of /proc/self/status). */
#include "bench.h"

#include <malloc.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static double status_bytes(const char *key) {
    char line[256];
    double kilobytes = 0;
    FILE *file = fopen("/proc/self/status", "r");
    if (!file) return 0;
    while (fgets(line, sizeof line, file))
        if (strncmp(line, key, strlen(key)) == 0) sscanf(line + strlen(key), ": %lf", &kilobytes);
    fclose(file);
    return 1024 * kilobytes;
}

static void reset_peak(void) {
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (!file) return; /* the peak of a new process is its resident set anyway */
    fputs("5", file);
    fclose(file);
}

static double rise(const bench_matrix *M, const bench_runner *r) {
    void *self = r->peer->create(M, r->ordering, r->perm, r->threads);
    malloc_trim(0);
    reset_peak();
    const double before = status_bytes("VmRSS");
    r->peer->analyze(self);
    r->peer->factor(self);
    return status_bytes("VmHWM") - before;
}

double bench_peak_memory(const bench_matrix *M, const bench_runner *r) {
    int channel[2];
    double bytes = 0;
    if (pipe(channel) != 0) return 0;
    malloc_trim(0);
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        bytes = rise(M, r);
        _exit(write(channel[1], &bytes, sizeof bytes) == sizeof bytes ? 0 : 1);
    }
    close(channel[1]);
    if (child < 0 || read(channel[0], &bytes, sizeof bytes) != sizeof bytes) bytes = 0;
    close(channel[0]);
    if (child > 0) waitpid(child, NULL, 0);
    return bytes;
}
