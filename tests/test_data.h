/* Third-party models for the tests: "$QC_TEST_DATA/name", by default ../shared beside the source
 * tree. */
#ifndef QC_TESTS_TEST_DATA_H
#define QC_TESTS_TEST_DATA_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEST_DATA_PATH = 4096, TEST_SKIPPED = 77 };

static inline const char *test_data(const char *name, char path[TEST_DATA_PATH]) {
    const char *root = getenv("QC_TEST_DATA"), *tests = strstr(__FILE__, "tests/test_data.h");
    if (root)
        snprintf(path, TEST_DATA_PATH, "%s/%s", root, name);
    else
        snprintf(path, TEST_DATA_PATH, "%.*s../shared/%s", tests ? (int)(tests - __FILE__) : 0,
                 __FILE__, name);
    return path;
}

/* 0, or TEST_SKIPPED with a message when the models are not there. */
static inline int test_data_missing(void) {
    char path[TEST_DATA_PATH];
    FILE *file = fopen(test_data("fields/eight.off", path), "rb");
    if (file) return fclose(file);
    puts("skipped: no test data (set QC_TEST_DATA)");
    return TEST_SKIPPED;
}

#endif
