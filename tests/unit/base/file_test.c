/* Files: all or nothing on writing, whole files on reading. */
#include "tests/unit/base/base_test.h"
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "qc_file_test_XXXXXX";

static int make_folder(void **state) {
    (void)state;
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : 1;
}
static int remove_folder(void **state) {
    (void)state;
    return chdir("..") == 0 && rmdir(folder) == 0 ? 0 : 1; /* fails when a file was left */
}

static int files(void) {
    DIR *dir = opendir(".");
    int n = -2;
    while (readdir(dir)) n++;
    closedir(dir);
    return n;
}

static void a_committed_file_is_complete(void **state) {
    (void)state;
    counter c;
    qc_ctx *ctx = counting_context(&c, 1);
    qc__writer w;
    char *data;
    size_t size;
    for (int round = 0; round < 2; round++) { /* the second replaces the first */
        assert_int_equal(qc__writer_open(ctx, "a.txt", &w), QC_OK);
        fprintf(w.file, "round %d\n", round);
        assert_int_equal(qc__writer_commit(ctx, &w), QC_OK);
        assert_int_equal(files(), 1);
        assert_int_equal(qc__read_file(ctx, "a.txt", &data, &size), QC_OK);
        assert_string_equal(data, round ? "round 1\n" : "round 0\n");
        assert_int_equal(size, 8);
        qc__free(data);
    }
    struct stat info;
    assert_int_equal(stat("a.txt", &info), 0);
    const mode_t mask = umask(0);
    umask(mask);
    assert_int_equal(info.st_mode & 0777, 0666 & ~mask);
    unlink("a.txt");
    free_counting_context(ctx, &c);
}

static void an_aborted_file_leaves_nothing(void **state) {
    (void)state;
    counter c;
    qc_ctx *ctx = counting_context(&c, 1);
    qc__writer w;
    assert_int_equal(qc__writer_open(ctx, "b.txt", &w), QC_OK);
    fputs("half", w.file);
    qc__writer_abort(&w);
    qc__writer_abort(&w); /* twice is fine */
    assert_int_equal(files(), 0);
    assert_int_equal(qc__writer_open(ctx, "no/such/folder/b.txt", &w), QC_ERR_IO);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "no/such/folder/b.txt"));
    for (c.allowed = 0; c.allowed < 2; c.allowed++) {
        const int64_t allowed = c.allowed;
        assert_int_equal(qc__writer_open(ctx, "b.txt", &w), QC_ERR_NOMEM);
        c.allowed = allowed;
    }
    c.allowed = -1;
    assert_int_equal(files(), 0);
    free_counting_context(ctx, &c);
}

static void a_full_disk_is_an_error(void **state) {
    (void)state;
    counter c;
    qc_ctx *ctx = counting_context(&c, 1);
    qc__writer w;
    if (access("/dev/full", W_OK) != 0) skip();
    assert_int_equal(qc__writer_open(ctx, "/dev/full", &w), QC_OK);
    fputs("text", w.file);
    assert_int_equal(qc__writer_commit(ctx, &w), QC_ERR_IO);
    struct stat info;
    assert_int_equal(stat("/dev/full", &info), 0); /* still there */
    free_counting_context(ctx, &c);
}

static void unreadable_files_are_errors(void **state) {
    (void)state;
    counter c;
    qc_ctx *ctx = counting_context(&c, 1);
    char *data = NULL;
    size_t size;
    assert_int_equal(qc__read_file(ctx, "missing.obj", &data, &size), QC_ERR_IO);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "missing.obj"));
    assert_int_equal(qc__read_file(ctx, ".", &data, &size), QC_ERR_IO);
    assert_non_null(strstr(qc_ctx_error(ctx)->text, "directory"));
    c.allowed = 0;
    assert_int_equal(qc__read_file(ctx, "/dev/null", &data, &size), QC_ERR_NOMEM);
    c.allowed = -1;
    assert_null(data);
    assert_int_equal(qc__read_file(ctx, "/dev/null", &data, &size), QC_OK);
    assert_int_equal(size, 0);
    assert_string_equal(data, "");
    qc__free(data);
    free_counting_context(ctx, &c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_committed_file_is_complete),
        cmocka_unit_test(an_aborted_file_leaves_nothing),
        cmocka_unit_test(a_full_disk_is_an_error),
        cmocka_unit_test(unreadable_files_are_errors),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
