/* Keeps OpenBLAS in the calling thread while factorisations run. Its thread count is a setting of
 * the whole process, so the bookkeeping here has to be one as well: the first user saves the host's
 * value, the last one restores it. */
#include "sdk/sparse/internal.h"
#include <cblas.h>
#include <stdlib.h>

/* What OpenBLAS takes at its first call: 128 MB and some pages. */
enum { BUFFER = (1 << 27) + (1 << 16) };

static atomic_flag lock = ATOMIC_FLAG_INIT;
static int users, host_threads; /* guarded by lock */
static bool has_buffer;         /* too */

static void acquire(void) {
    while (atomic_flag_test_and_set_explicit(&lock, memory_order_acquire)) {}
}

void qc__blas_begin(void) {
    acquire();
    if (users++ == 0) {
        host_threads = openblas_get_num_threads();
        if (host_threads != 1) openblas_set_num_threads(1);
    }
    atomic_flag_clear_explicit(&lock, memory_order_release);
}

void qc__blas_end(void) {
    acquire();
    if (--users == 0 && host_threads != 1) openblas_set_num_threads(host_threads);
    atomic_flag_clear_explicit(&lock, memory_order_release);
}

/* The memory of the system, not that of the context: OpenBLAS asks there, and goes on asking for
 * ever when it gets none. */
qc_status qc__blas_reserve(qc_ctx *ctx) {
    acquire();
    void *buffer = has_buffer ? NULL : malloc(BUFFER);
    has_buffer |= buffer != NULL;
    const bool there = has_buffer;
    free(buffer);
    atomic_flag_clear_explicit(&lock, memory_order_release);
    return there ? QC_OK : qc__fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
}
