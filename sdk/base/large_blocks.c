/* Large blocks of the default allocator. Touching a new page costs a microsecond or more; a factor
 * of a gigabyte has 250 000 of them, but only 500 of the large ones which Linux offers on request.
 */
#define _DEFAULT_SOURCE
#include <stdint.h>
#include <stdlib.h>
#ifdef __linux__
#include <sys/mman.h>
#endif
#include "sdk/base/context_private.h"

static const size_t large_page = (size_t)2 << 20;

void *qc__large_block(size_t size) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (size >= 2 * large_page && size < SIZE_MAX - large_page) {
        const size_t rounded = (size + large_page - 1) & ~(large_page - 1);
        void *p = aligned_alloc(large_page, rounded);
        if (p) (void)madvise(p, rounded, MADV_HUGEPAGE); /* a wish: failure changes nothing */
        return p;
    }
#endif
    return malloc(size);
}
