/* An allocator whose n-th call fails, and a loop over n which checks that nothing is leaked. */
#ifndef QC_TEST_FAILING_ALLOCATOR_H
#define QC_TEST_FAILING_ALLOCATOR_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <qc/base.h>

#include "tests/counting.h"

/* Runs work with the first, second, ... allocation failing until it succeeds. */
static inline void fail_every_allocation(qc_status (*work)(qc_ctx *, const void *),
                                         const void *data) {
    qc_status status = QC_ERR_NOMEM;
    for (int64_t fail_at = 0; status != QC_OK; fail_at++) {
        counter c = {0, -1, 0};
        qc_ctx_options options = QC_CTX_OPTIONS_INIT;
        options.threads = 1;
        options.resize = counting_resize;
        options.user = &c;
        qc_ctx *ctx = NULL;
        assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
        const int64_t blocks = c.blocks;
        c.fail_at = c.made + fail_at;
        status = work(ctx, data);
        assert_true(status == QC_OK || status == QC_ERR_NOMEM);
        assert_int_equal(qc_ctx_error(ctx)->status, status);
        assert_int_equal(c.blocks, blocks);
        qc_ctx_free(ctx);
        assert_true(fail_at < 10000);
    }
}

#endif
