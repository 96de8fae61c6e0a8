/* Files of the command line: early checks, texts written whole or not at all, reading of meshes. */
#include "bindings/cli/cli.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int cannot_write(const char *path, int reason) {
    return cli_error(EXIT_FAILED, "%s: cannot write: %s", path, strerror(reason));
}

int cli_check_writable(const char *path) {
    if (!path || strcmp(path, "-") == 0) return EXIT_DONE;
    struct stat info;
    if (stat(path, &info) == 0) {
        if (S_ISDIR(info.st_mode)) return cannot_write(path, EISDIR);
        if (!S_ISREG(info.st_mode))
            return access(path, W_OK) == 0 ? EXIT_DONE : cannot_write(path, errno);
    }
    char *folder = strdup(path);
    if (!folder) return cli_error(EXIT_FAILED, "out of memory");
    char *slash = strrchr(folder, '/');
    if (slash) slash[slash == folder] = '\0';
    const int reason = access(slash ? folder : ".", W_OK | X_OK) == 0 ? 0 : errno;
    free(folder);
    return reason ? cannot_write(path, reason) : EXIT_DONE;
}

static bool write_all(FILE *file, const char *bytes, size_t n) {
    return fwrite(bytes, 1, n, file) == n && fflush(file) == 0;
}

static int write_beside(const char *path, const char *bytes, size_t n) {
    const size_t length = strlen(path);
    char *temporary = malloc(length + 8);
    if (!temporary) return cli_error(EXIT_FAILED, "out of memory");
    memcpy(temporary, path, length);
    memcpy(temporary + length, ".XXXXXX", 8);
    const int fd = mkstemp(temporary);
    FILE *file = fd >= 0 ? fdopen(fd, "w") : NULL;
    int status = EXIT_DONE;
    if (!file) {
        status = cannot_write(path, errno);
        if (fd >= 0) close(fd);
    } else {
        const mode_t mask = umask(0);
        umask(mask);
        bool good = fchmod(fd, 0666 & ~mask) == 0 && write_all(file, bytes, n);
        good = fclose(file) == 0 && good;
        if (!good || rename(temporary, path) != 0) status = cannot_write(path, errno);
    }
    if (status != EXIT_DONE && fd >= 0) unlink(temporary);
    free(temporary);
    return status;
}

int cli_write_text(const char *path, const char *text) {
    return cli_write_bytes(path, text, strlen(text));
}

int cli_write_bytes(const char *path, const char *bytes, size_t n) {
    struct stat info;
    if (strcmp(path, "-") == 0)
        return write_all(stdout, bytes, n) ? EXIT_DONE : cannot_write("stdout", errno);
    if (stat(path, &info) != 0 || S_ISREG(info.st_mode)) return write_beside(path, bytes, n);
    FILE *file = fopen(path, "w");
    if (!file) return cannot_write(path, errno);
    const bool good = write_all(file, bytes, n);
    return fclose(file) == 0 && good ? EXIT_DONE : cannot_write(path, errno);
}

const char *const cli_format_names[] = {"auto", "obj", "off", "ply", "ply-ascii", NULL};

int cli_read_mesh(cli_session *session, const char *path, qc_polygon_mesh **out) {
    if (qc_polygon_mesh_read(session->ctx, path, out) == QC_OK) return EXIT_DONE;
    return cli_session_error(session, strcmp(path, "-") == 0 ? "stdin" : path, EXIT_INPUT);
}
