/* The forward solution z = L^{-1} P b of one right-hand side, carried along with the factor (theory
 * S.11, S.12). Every supernode keeps its part of z, what it hands to the rows below (its
 * contribution, as in the multifrontal method) and the energy of its subtree. After a modification
 * each front on the path starts again from b and the contributions of its children; hence z is at
 * any time, bit for bit, what a solve from the start with the present L gives. */
#include <string.h>
#include "sdk/sparse/modify/modify.h"

static int64_t width(const qc_symbolic *S, int32_t s) {
    return S->super[s + 1] - S->super[s];
}
static int64_t rows(const qc_symbolic *S, int32_t s) {
    return S->rowptr[s + 1] - S->rowptr[s];
}
static double *contribution_of(const qc_factor *F, int32_t s) {
    return F->modify->forward->contribution + F->components * (F->S->rowptr[s] - F->S->super[s]);
}

void qc__forward_free(qc__forward *forward) {
    if (!forward) return;
    qc__free(forward->b);
    qc__free(forward->z);
    qc__free(forward->work);
    qc__free(forward->contribution);
    qc__free(forward->energy);
    qc__free(forward->root);
    qc__free(forward->pending);
    qc__free(forward->is_pending);
    qc__free(forward);
}

double qc__forward_assemble(const qc_factor *F, int32_t s, double *f) {
    const qc_symbolic *S = F->S;
    const qc__forward *forward = F->modify->forward;
    const int64_t nc = F->components, w = width(S, s), r = rows(S, s);
    double energy = 0;
    memcpy(f, forward->b + nc * S->super[s], (size_t)(nc * w) * sizeof *f);
    memset(f + nc * w, 0, (size_t)(nc * (r - w)) * sizeof *f);
    for (int32_t c = S->child[s]; c != -1; c = S->sibling[c]) {
        const int32_t *local = S->relative + S->rowptr[c] + width(S, c);
        const double *x = contribution_of(F, c);
        const int64_t m = rows(S, c) - width(S, c);
        energy += forward->energy[c];
        if (nc == 1) {
            for (int64_t i = 0; i < m; i++) f[local[i]] += x[i];
        } else {
            for (int64_t i = 0; i < m; i++) {
                f[2 * (int64_t)local[i]] += x[2 * i];
                f[2 * (int64_t)local[i] + 1] += x[2 * i + 1];
            }
        }
    }
    return energy;
}

void qc__forward_store(const qc_factor *F, int32_t s, const double *f, double below) {
    const qc_symbolic *S = F->S;
    const qc__forward *forward = F->modify->forward;
    const int64_t nc = F->components, first = S->super[s], w = width(S, s), r = rows(S, s);
    double energy = 0;
    for (int64_t k = 0; k < w; k++) {
        double size = 0;
        for (int64_t c = 0; c < nc; c++) size += f[nc * k + c] * f[nc * k + c];
        energy += size / F->D[first + k];
    }
    memcpy(forward->z + nc * first, f, (size_t)(nc * w) * sizeof *f);
    memcpy(contribution_of(F, s), f + nc * w, (size_t)(nc * (r - w)) * sizeof *f);
    forward->energy[s] = below + energy;
}

void qc__forward_save(qc_factor *F, int32_t s) {
    const qc_symbolic *S = F->S;
    const qc__forward *forward = F->modify->forward;
    const int64_t nc = F->components, w = width(S, s), r = rows(S, s);
    double *to = qc__journal_record(F, QC__SOLUTION, s, 0);
    memcpy(to, forward->z + nc * S->super[s], (size_t)(nc * w) * sizeof *to);
    memcpy(to + nc * w, contribution_of(F, s), (size_t)(nc * (r - w)) * sizeof *to);
    to[nc * r] = forward->energy[s];
    F->modify->journal.used += nc * r + 1;
}

void qc__forward_settle(qc_factor *F) {
    qc__forward *forward = F->modify->forward;
    if (!forward) return;
    while (forward->pendings > 0) {
        const int32_t s = forward->pending[--forward->pendings];
        forward->is_pending[s] = false;
        qc__journal_record(F, QC__PENDING, s, 0);
    }
}

/* Everything from the start; the kernel is that of the sweep, so the bits are as well. */
void qc__forward_solve(qc_factor *F) {
    const qc_symbolic *S = F->S;
    qc__forward *forward = F->modify->forward;
    for (int32_t s = 0; s < S->nsuper; s++) {
        double *f = forward->work;
        const double below = qc__forward_assemble(F, s, f);
        qc__update_front front = {.r = rows(S, s),
                                  .w = width(S, s),
                                  .k0 = width(S, s),
                                  .panel = F->values + F->components * S->panel[s],
                                  .solution = f};
        F->kernels->update_front(&front);
        qc__forward_store(F, s, f, below);
    }
    while (forward->pendings > 0)
        forward->is_pending[forward->pending[--forward->pendings]] = false;
    forward->stale = false;
}

static qc__forward *create(qc_ctx *ctx, const qc_symbolic *S, int64_t nc) {
    qc__forward *forward = QC__ZERO(ctx, qc__forward, 1);
    if (!forward) return NULL;
    const int64_t n = S->n, ns = S->nsuper;
    forward->b = QC__NEW(ctx, double, nc *n);
    forward->z = QC__NEW(ctx, double, nc *n);
    forward->work = QC__NEW(ctx, double, nc * S->plan.largest_front);
    forward->contribution = QC__NEW(ctx, double, nc *(S->rowptr[ns] - n));
    forward->energy = QC__NEW(ctx, double, ns);
    forward->root = QC__NEW(ctx, int32_t, ns);
    forward->pending = QC__NEW(ctx, int32_t, ns);
    forward->is_pending = QC__ZERO(ctx, bool, ns);
    if (!forward->b || !forward->z || !forward->work || !forward->contribution ||
        !forward->energy || !forward->root || !forward->pending || !forward->is_pending) {
        qc__forward_free(forward);
        return NULL;
    }
    for (int32_t s = 0; s < S->nsuper; s++)
        if (S->parent[s] == -1) forward->root[forward->roots++] = s;
    return forward;
}

static qc_status attach(qc_ctx *ctx, qc_factor *F, int32_t nc, const double *b) {
    qc_status status = qc__factor_check(ctx, F, nc, true);
    if (status == QC_OK) status = qc__modify_open(ctx, F);
    if (status != QC_OK) return status;
    const qc_symbolic *S = F->S;
    if (S->n > 0 && !b)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "forward solution needs a right-hand side");
    if (F->modify->journal.savepoints > 0)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "right-hand side cannot be exchanged within a transaction: commit first");
    if (!F->modify->forward && !(F->modify->forward = create(ctx, S, nc))) return QC_ERR_NOMEM;
    qc__journal_begin(F);
    double *to = F->modify->forward->b;
    for (int64_t k = 0; k < S->n; k++)
        memcpy(to + nc * k, b + nc * (int64_t)S->perm[k], (size_t)nc * sizeof *to);
    qc__forward_solve(F);
    return QC_OK;
}

qc_status qc_forward_attach(qc_ctx *ctx, qc_factor *F, const qc_complex *b) {
    return attach(ctx, F, 2, (const double *)b);
}
qc_status qc_forward_attach_real(qc_ctx *ctx, qc_factor *F, const double *b) {
    return attach(ctx, F, 1, b);
}

qc_status qc_forward_detach(qc_ctx *ctx, qc_factor *F) {
    if (!F->modify || !F->modify->forward) return QC_OK;
    if (F->modify->journal.savepoints > 0)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "right-hand side cannot be detached within a transaction: commit first");
    qc__journal_begin(F);
    qc__forward_free(F->modify->forward);
    F->modify->forward = NULL;
    return QC_OK;
}

static qc_status check_attached(qc_ctx *ctx, const qc_factor *F, int32_t nc) {
    const qc_status status = qc__factor_check(ctx, F, nc, true);
    if (status != QC_OK) return status;
    if (F->modify && F->modify->forward) return QC_OK;
    return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "factor has no right-hand side: attach one");
}

static qc_status add(qc_ctx *ctx, qc_factor *F, int32_t nc, int32_t nb, const int32_t *row,
                     const double *db) {
    qc_status status = check_attached(ctx, F, nc);
    if (status != QC_OK) return status;
    const qc_symbolic *S = F->S;
    if (nb < 0 || (nb > 0 && (!row || !db)))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "change of a right-hand side needs arrays");
    for (int32_t p = 0; p < nb; p++)
        if (row[p] < 0 || row[p] >= S->n)
            return qc__fail(ctx, QC_ERR_ARGUMENT, row[p], "right-hand side has row %d of %d",
                            (int)row[p], (int)S->n);
    qc__journal_begin(F);
    status = qc__journal_reserve(ctx, F, (int64_t)nc * nb, nb);
    if (status != QC_OK) return status;
    qc__forward *forward = F->modify->forward;
    for (int32_t p = 0; p < nb; p++) {
        const int32_t k = S->inverse[row[p]], s = S->super_of[k];
        double *b = forward->b + (int64_t)nc * k;
        memcpy(qc__journal_record(F, QC__RHS, k, !forward->is_pending[s]), b,
               (size_t)nc * sizeof *b);
        F->modify->journal.used += nc;
        for (int32_t c = 0; c < nc; c++) b[c] += db[(int64_t)nc * p + c];
        if (!forward->is_pending[s]) forward->pending[forward->pendings++] = s;
        forward->is_pending[s] = true;
    }
    F->modify->journal.undoable = true;
    return QC_OK;
}

qc_status qc_forward_add(qc_ctx *ctx, qc_factor *F, int32_t nb, const int32_t *row,
                         const qc_complex *db) {
    return add(ctx, F, 2, nb, row, (const double *)db);
}
qc_status qc_forward_add_real(qc_ctx *ctx, qc_factor *F, int32_t nb, const int32_t *row,
                              const double *db) {
    return add(ctx, F, 1, nb, row, db);
}

/* Brings z up to date with what is pending. */
static qc_status flush(qc_ctx *ctx, qc_factor *F, int32_t nc) {
    const qc_status status = check_attached(ctx, F, nc);
    if (status != QC_OK) return status;
    const qc__forward *forward = F->modify->forward;
    if (!forward->stale && forward->pendings == 0) return QC_OK;
    return qc__sweep(ctx, F, &(qc__change){0});
}

qc_status qc_forward_energy(qc_ctx *ctx, qc_factor *F, double *energy) {
    const qc_status status = flush(ctx, F, F->components);
    if (status != QC_OK) return status;
    const qc__forward *forward = F->modify->forward;
    double sum = 0;
    for (int32_t i = 0; i < forward->roots; i++) sum += forward->energy[forward->root[i]];
    *energy = sum;
    return QC_OK;
}

static qc_status get(qc_ctx *ctx, qc_factor *F, int32_t nc, double *y) {
    const qc_status status = flush(ctx, F, nc);
    if (status != QC_OK) return status;
    const double *z = F->modify->forward->z;
    for (int64_t k = 0; k < F->S->n; k++) {
        const double scale = 1 / sqrt(F->D[k]);
        for (int32_t c = 0; c < nc; c++) y[nc * k + c] = z[nc * k + c] * scale;
    }
    return QC_OK;
}

qc_status qc_forward_get(qc_ctx *ctx, qc_factor *F, qc_complex *y) {
    return get(ctx, F, 2, (double *)y);
}
qc_status qc_forward_get_real(qc_ctx *ctx, qc_factor *F, double *y) {
    return get(ctx, F, 1, y);
}
