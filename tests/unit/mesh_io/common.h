/* Shared by the tests of reading, writing and repair: parsing literals, expecting errors.
 */
#ifndef QC_TESTS_MESH_IO_COMMON_H
#define QC_TESTS_MESH_IO_COMMON_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include <qc/mesh.h>

#include "unit/context.h"

/* Parses a copy which ends exactly with the data, so that reading beyond it is found. */
static inline qc_status parse_bytes(qc_ctx *ctx, const void *data, size_t size, const char *name,
                                    qc_polygon_mesh **out) {
    char *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    memcpy(copy, data, size);
    qc_status status = qc_polygon_mesh_parse(ctx, copy, size, name, out);
    free(copy);
    return status;
}

static inline qc_polygon_mesh *parse_text(qc_ctx *ctx, const char *text, const char *name) {
    qc_polygon_mesh *mesh = NULL;
    qc_status status = parse_bytes(ctx, text, strlen(text), name, &mesh);
    if (status != QC_OK) print_error("%s\n", qc_ctx_error(ctx)->text);
    assert_int_equal(status, QC_OK);
    return mesh;
}

/* The data are refused as INPUT, with `where` and a one-line text which contains `part`. */
static inline void expect_bad(qc_ctx *ctx, const void *data, size_t size, const char *name,
                              int64_t where, const char *part) {
    qc_polygon_mesh *mesh = NULL;
    assert_int_equal(parse_bytes(ctx, data, size, name, &mesh), QC_ERR_INPUT);
    assert_null(mesh);
    const qc_error *e = qc_ctx_error(ctx);
    if (!strstr(e->text, part) || e->where != where)
        print_error("%lld: %s\n", (long long)e->where, e->text);
    assert_int_equal(e->status, QC_ERR_INPUT);
    assert_non_null(strstr(e->text, part));
    assert_non_null(strstr(e->text, name));
    assert_null(strchr(e->text, '\n'));
    assert_int_equal(e->where, where);
}

#endif
