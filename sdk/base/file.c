/* Whole-file reading, and writing through a temporary which is renamed on success. */
#include "sdk/base/internal.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

qc_status qc__read_file(qc_ctx *ctx, const char *path, char **data, size_t *size) {
    const bool from_stdin = strcmp(path, "-") == 0;
    FILE *file = from_stdin ? stdin : fopen(path, "rb");
    if (!file) return qc__fail(ctx, QC_ERR_IO, -1, "%s: %s", path, strerror(errno));
    struct stat info;
    if (!from_stdin && fstat(fileno(file), &info) == 0 && S_ISDIR(info.st_mode)) {
        fclose(file);
        return qc__fail(ctx, QC_ERR_IO, -1, "%s: is a directory; name a file in it", path);
    }
    char *block = NULL;
    int64_t capacity = 0;
    size_t used = 0;
    qc_status status = QC_OK;
    for (;;) {
        if (!qc__reserve(ctx, (void **)&block, &capacity, (int64_t)used + (1 << 16) + 1, 1)) {
            status = QC_ERR_NOMEM;
            break;
        }
        const size_t got = fread(block + used, 1, (size_t)capacity - used - 1, file);
        used += got;
        if (got == 0) break;
    }
    if (status == QC_OK && ferror(file))
        status = qc__fail(ctx, QC_ERR_IO, -1, "%s: %s", path, strerror(errno));
    if (!from_stdin) fclose(file);
    if (status != QC_OK) {
        qc__free(block);
        return status;
    }
    block[used] = '\0';
    *data = block;
    *size = used;
    return QC_OK;
}

/* Devices and pipes (-o /dev/null) are written to directly: renaming over them would replace them.
 */
static bool is_special(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

/* Creates PATH.XXXXXX beside the target, with the mode a plain fopen would give. */
static FILE *open_temporary(char *temporary) {
    const int fd = mkstemp(temporary);
    if (fd < 0) return NULL;
    const mode_t mask = umask(0);
    umask(mask);
    fchmod(fd, 0666 & ~mask);
    FILE *file = fdopen(fd, "wb");
    if (!file) {
        close(fd);
        unlink(temporary);
    }
    return file;
}

qc_status qc__writer_open(qc_ctx *ctx, const char *path, qc__writer *out) {
    *out = (qc__writer){stdout, NULL, NULL};
    if (strcmp(path, "-") == 0) return QC_OK;
    const size_t length = strlen(path);
    qc__writer w = {NULL, QC__NEW(ctx, char, length + 1), QC__NEW(ctx, char, length + 8)};
    if (!w.path || !w.temporary) {
        qc__writer_abort(&w);
        return QC_ERR_NOMEM;
    }
    memcpy(w.path, path, length + 1);
    memcpy(w.temporary, path, length);
    memcpy(w.temporary + length, ".XXXXXX", 8);
    if (is_special(path)) {
        qc__free(w.temporary);
        w.temporary = NULL;
    }
    w.file = w.temporary ? open_temporary(w.temporary) : fopen(path, "wb");
    if (!w.file) {
        const int reason = errno;
        qc__writer_abort(&w);
        return qc__fail(ctx, QC_ERR_IO, -1, "%s: cannot write: %s", path, strerror(reason));
    }
    *out = w;
    return QC_OK;
}

qc_status qc__writer_commit(qc_ctx *ctx, qc__writer *writer) {
    bool good = fflush(writer->file) == 0 && !ferror(writer->file);
    if (!writer->path)
        return good ? QC_OK : qc__fail(ctx, QC_ERR_IO, -1, "stdout: %s", strerror(errno));
    good = fclose(writer->file) == 0 && good;
    writer->file = NULL;
    if (writer->temporary) good = good && rename(writer->temporary, writer->path) == 0;
    qc_status status = QC_OK;
    if (!good) {
        status =
            qc__fail(ctx, QC_ERR_IO, -1, "%s: cannot write: %s", writer->path, strerror(errno));
        if (writer->temporary) unlink(writer->temporary);
    }
    qc__free(writer->path);
    qc__free(writer->temporary);
    *writer = (qc__writer){NULL, NULL, NULL};
    return status;
}

void qc__writer_abort(qc__writer *writer) {
    if (writer->path && writer->file) {
        fclose(writer->file);
        if (writer->temporary) unlink(writer->temporary);
    }
    qc__free(writer->path);
    qc__free(writer->temporary);
    *writer = (qc__writer){NULL, NULL, NULL};
}
