/* One mesh of a batch in a process of its own: started, watched, ended, and its line made.
 *
 * The process writes into a working folder below the results; its files are renamed into place when
 * it has succeeded, so that nothing of a crash or a kill is ever seen. Memory is what is resident,
 * looked up while it runs: a limit on addresses would count what BLAS and threads reserve, half a
 * gigabyte for a run of 20 MB, and BLAS waits forever for what it is refused. */
#define _DEFAULT_SOURCE /* wait4 */
#include "bindings/cli/batch.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

static const double grace = 1; /* seconds between asking a process to end and ending it */

/* Makes the folders of a path. */
static bool make_parents(const char *path) {
    char *copy = strdup(path);
    for (char *slash = copy ? strchr(copy + 1, '/') : NULL; slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(copy, 0777);
        *slash = '/';
    }
    free(copy);
    return copy != NULL;
}

static bool make_work(batch_worker *w) {
    w->work = batch_format("%s/.batch/%s.XXXXXX", batch_text(w->task, "folder"),
                           batch_text(w->task, "name"));
    if (!w->work || !make_parents(w->work) || !mkdtemp(w->work)) return false;
    w->lock = open(w->work, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (w->lock >= 0) flock(w->lock, LOCK_EX | LOCK_NB);
    return w->lock >= 0;
}

/* Where the process writes output i. */
static char *work_path(const batch_worker *w, size_t i) {
    const char *output = json_string_value(json_array_get(json_object_get(w->task, "outputs"), i));
    return batch_format("%s/%zu%s", w->work, i, strrchr(output, '.'));
}

/* The command with the outputs in the working folder; free() the words and the list. */
static char **make_words(const batch_worker *w) {
    const json_t *command = json_object_get(w->task, "command"),
                 *outputs = json_object_get(w->task, "outputs");
    char **word = calloc(json_array_size(command) + 1, sizeof *word);
    json_t *text, *output;
    size_t i, j;
    json_array_foreach(command, i, text) {
        if (!word) break;
        word[i] = strdup(json_string_value(text));
        json_array_foreach(outputs, j, output) {
            if (i < 3 || strcmp(json_string_value(text), json_string_value(output)) != 0) continue;
            free(word[i]);
            word[i] = work_path(w, j);
        }
    }
    return word;
}

static void redirect(const char *path, int flags, int to) {
    const int fd = open(path, flags, 0666);
    if (fd >= 0) dup2(fd, to);
}

/* In the new process: it ends with its parent, and leaves no core. A group of its own keeps Ctrl-C
 * from it: the parent ends it. */
static void become(const batch_worker *w, char **word, const char *program, pid_t parent) {
    const struct rlimit none = {0, 0};
    sigset_t empty;
    setpgid(0, 0);
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if (getppid() != parent) _exit(EXIT_FAILED);
    setrlimit(RLIMIT_CORE, &none);
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    sigemptyset(&empty);
    sigprocmask(SIG_SETMASK, &empty, NULL);
    char *messages = batch_format("%s/messages", w->work);
    redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    redirect("/dev/null", O_WRONLY, STDOUT_FILENO);
    redirect(messages ? messages : "/dev/null", O_WRONLY | O_CREAT, STDERR_FILENO);
    const char *cwd = batch_text(w->task, "cwd");
    if (chdir(cwd) != 0)
        cli_error(EXIT_FAILED, "%s: cannot enter: %s", cwd, strerror(errno));
    else if (execvp(program, word) != 0)
        cli_error(EXIT_FAILED, "%s: cannot run: %s", program, strerror(errno));
    fflush(stderr);
    _exit(EXIT_FAILED);
}

/* A folder of files. */
static void remove_folder(const char *path) {
    DIR *folder = opendir(path);
    for (struct dirent *entry = folder ? readdir(folder) : NULL; entry; entry = readdir(folder))
        unlinkat(dirfd(folder), entry->d_name, 0);
    if (folder) closedir(folder);
    rmdir(path);
}

static void release(batch_worker *w) {
    if (w->work) remove_folder(w->work);
    if (w->lock >= 0) close(w->lock);
    free(w->work);
    memset(w, 0, sizeof *w);
    w->lock = -1;
}

bool batch_worker_start(batch_worker *w, json_t *task, const char *program) {
    memset(w, 0, sizeof *w);
    w->lock = -1;
    w->task = task;
    w->start = cli_seconds();
    char **word = make_work(w) ? make_words(w) : NULL;
    const pid_t parent = getpid();
    fflush(NULL);
    const pid_t pid = word ? fork() : -1;
    if (pid == 0) become(w, word, program, parent);
    const int reason = errno;
    for (size_t i = 0; word && word[i]; i++) free(word[i]);
    free(word);
    w->pid = pid;
    if (pid > 0) return true;
    cli_error(EXIT_FAILED, "%s: cannot start a process: %s", batch_text(task, "name"),
              strerror(reason));
    release(w);
    return false;
}

void batch_worker_stop(batch_worker *w, const char *verdict) {
    if (w->verdict) return;
    w->verdict = verdict;
    w->kill_at = cli_seconds() + grace;
    kill(w->pid, SIGTERM);
}

double batch_resident(pid_t pid) {
    char path[64];
    long size, pages = 0;
    snprintf(path, sizeof path, "/proc/%ld/statm", (long)pid);
    FILE *file = fopen(path, "r");
    if (!file) return 0;
    if (fscanf(file, "%ld %ld", &size, &pages) != 2) pages = 0;
    fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE) / 1048576;
}

void batch_worker_watch(batch_worker *w) {
    const double now = cli_seconds(), limit = batch_number(w->task, "limit"),
                 memory = batch_number(w->task, "memory");
    if (memory > 0 && !w->verdict && batch_resident(w->pid) > memory) {
        w->verdict = "memory";
        kill(-w->pid, SIGKILL);
    }
    if (limit > 0 && now - w->start > limit) batch_worker_stop(w, "timeout");
    if (w->kill_at > 0 && now > w->kill_at) kill(-w->pid, SIGKILL);
}

/* Renames the outputs into place. */
static bool publish(const batch_worker *w) {
    json_t *output;
    size_t i;
    json_array_foreach(json_object_get(w->task, "outputs"), i, output) {
        const char *path = json_string_value(output);
        char *made = work_path(w, i);
        const bool placed = made && make_parents(path) && rename(made, path) == 0;
        free(made);
        if (!placed) return false;
    }
    return true;
}

bool batch_worker_ended(batch_worker *w, json_t **line) {
    struct rusage usage;
    int ended = 0;
    if (w->pid <= 0 || wait4(w->pid, &ended, WNOHANG, &usage) != w->pid) return false;
    kill(-w->pid, SIGKILL); /* what it started itself */
    const bool interrupted = w->verdict && strcmp(w->verdict, "interrupted") == 0;
    const bool done = !w->verdict && WIFEXITED(ended) && WEXITSTATUS(ended) == EXIT_DONE;
    const bool written = !done || publish(w);
    *line = interrupted ? NULL : batch_make_line(w, ended, &usage, written);
    release(w);
    return true;
}

void batch_remove_leftovers(const char *folder) {
    char *path = batch_format("%s/.batch", folder);
    DIR *all = path ? opendir(path) : NULL;
    for (struct dirent *entry = all ? readdir(all) : NULL; entry; entry = readdir(all)) {
        char *work = batch_format("%s/%s", path, entry->d_name);
        const int lock =
            entry->d_name[0] == '.' || !work ? -1 : open(work, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0) remove_folder(work);
        if (lock >= 0) close(lock);
        free(work);
    }
    if (all) closedir(all);
    if (path) rmdir(path); /* only when it is empty */
    free(path);
}
