/* Which vector instructions the processor has. Kernels are compiled once per set; this is the one
 * place which chooses among them at run time. */
#include "sdk/base/internal.h"
#include <string.h>

static const char *const names[QC__ISAS] = {"portable", "avx2", "avx512"};

const char *qc__isa_name(qc__isa isa) {
    return names[isa];
}

static qc__isa best(void) {
#if defined(__x86_64__) && defined(__GNUC__)
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return QC__PORTABLE;
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") ? QC__AVX512
                                                                                   : QC__AVX2;
#else
    return QC__PORTABLE;
#endif
}

qc_status qc__isa_select(const char *name, qc__isa *out) {
    const qc__isa has = best();
    if (!name) {
        *out = has;
        return QC_OK;
    }
    for (int isa = 0; isa < QC__ISAS; isa++) {
        if (strcmp(name, names[isa]) != 0) continue;
        if (isa > (int)has) return QC_ERR_UNSUPPORTED;
        *out = (qc__isa)isa;
        return QC_OK;
    }
    return QC_ERR_ARGUMENT;
}
