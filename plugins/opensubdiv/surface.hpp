/* What the C++ files of the plugin share. */
#ifndef QO_SURFACE_HPP
#define QO_SURFACE_HPP

#include "surface.h"

#include <opensubdiv/far/topologyRefiner.h>

#include <exception>
#include <memory>
#include <new>

struct qo_surface {
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner;
    int32_t n_creases;
    const OpenSubdiv::Far::TopologyLevel &level(int i) const { return refiner->GetLevel(i); }
    const OpenSubdiv::Far::TopologyLevel &last() const { return level(refiner->GetMaxLevel()); }
};

namespace qo {

/* Runs `body`; whatever it throws becomes an error of the context. */
template <class Body> qc_status guarded(qc_ctx *ctx, Body body) noexcept {
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "opensubdiv: out of memory");
    } catch (const std::exception &e) {
        try {
            return qc_ctx_fail(ctx, QC_ERR_FAILED, -1, e.what());
        } catch (...) {}
    } catch (...) {}
    return qc_ctx_fail(ctx, QC_ERR_FAILED, -1, "opensubdiv: unknown exception");
}

} // namespace qo

#endif
