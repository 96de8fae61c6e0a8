/* What a solve has to know of each supernode, in one place, and where its sums of updates live:
 * inside a task of the schedule on a stack of the worker; update vectors which leave a task or come
 * from the top of the tree get slots in a shared area. */
#include "sdk/sparse/internal.h"

/* Heights of the two stacks between which the levels of the tree alternate. */
typedef struct stacks {
    int64_t top[2], peak[2];
} stacks;

static void open(const qc_symbolic *S, const bool *parity, int32_t s, stacks *T) {
    qc__solve_node *node = &S->solve.node[s];
    const bool side = parity[s];
    node->sum = T->top[side];
    T->top[side] += node->w + node->m + 1;
    if (T->top[side] > T->peak[side]) T->peak[side] = T->top[side];
}

/* The sum of a parent opens with its first child: what the child's own children used is free by
 * then, and the child itself is on the other stack. */
static int64_t place_task(const qc_symbolic *S, qc__task task, const bool *parity) {
    stacks T = {{0, 0}, {0, 0}};
    qc__solve_node *node = S->solve.node;
    for (int32_t s = task.first; s <= task.last; s++) {
        const int32_t p = S->parent[s];
        if (node[s].sum < 0) open(S, parity, s, &T);
        node[s].leaves = p == -1 || p > task.last;
        if (!node[s].leaves && node[p].sum < 0) open(S, parity, p, &T);
        T.top[parity[s]] -= node[s].w + node[s].m + 1;
    }
    for (int32_t s = task.first; s <= task.last; s++)
        if (parity[s]) node[s].sum += T.peak[0] + QC__SOLVE_PAD;
    for (int32_t s = task.first; s <= task.last; s++)
        if (!node[s].leaves) node[s].to = node[S->parent[s]].sum;
    return T.peak[0] + T.peak[1] + 2 * QC__SOLVE_PAD;
}

static void describe(const qc_symbolic *S) {
    for (int32_t s = 0; s < S->nsuper; s++) {
        const int32_t first = S->super[s], w = S->super[s + 1] - first;
        const int64_t r = S->rowptr[s + 1] - S->rowptr[s];
        S->solve.node[s] = (qc__solve_node){S->panel[s], S->rowptr[s] + w, 0,    -1,  0, first,
                                            w,           (int32_t)r - w,   true, true};
    }
}

/* Copies the rows in the parent's sum of all supernodes which push there, up to full vectors: what
 * is past the end goes to the spare row. */
static qc_status list_targets(qc_ctx *ctx, const qc_symbolic *S, qc__solve_plan *solve) {
    int64_t count = 0;
    for (int32_t s = 0; s < S->nsuper; s++) {
        solve->node[s].push = count;
        if (!solve->node[s].leaves)
            count += (solve->node[s].m + QC__SOLVE_PAD - 1) / QC__SOLVE_PAD * QC__SOLVE_PAD;
    }
    solve->target = QC__NEW(ctx, int32_t, count);
    if (!solve->target) return QC_ERR_NOMEM;
    for (int32_t s = 0; s < S->nsuper; s++) {
        const qc__solve_node *N = &solve->node[s];
        if (N->leaves) continue;
        const qc__solve_node *up = &solve->node[S->parent[s]];
        int32_t *to = solve->target + N->push;
        int64_t i = 0;
        for (; i < N->m; i++) to[i] = S->relative[N->below + i];
        for (; i % QC__SOLVE_PAD != 0; i++) to[i] = up->w + up->m;
    }
    return QC_OK;
}

qc_status qc__solve_plan_create(qc_ctx *ctx, qc_symbolic *S) {
    const qc__plan *plan = &S->plan;
    qc__solve_plan *solve = &S->solve;
    bool *parity = QC__NEW(ctx, bool, S->nsuper);
    solve->node = QC__NEW(ctx, qc__solve_node, S->nsuper);
    if (!parity || !solve->node) {
        qc__free(parity);
        return QC_ERR_NOMEM;
    }
    describe(S);
    for (int32_t s = S->nsuper; s-- > 0;) parity[s] = S->parent[s] != -1 && !parity[S->parent[s]];
    for (int32_t t = 0; t < plan->ntask; t++) {
        const int64_t need = place_task(S, plan->task[t], parity);
        if (need > solve->stack) solve->stack = need;
        for (int32_t s = plan->task[t].first; s <= plan->task[t].last; s++)
            solve->node[s].top = false;
    }
    for (int32_t s = 0; s < S->nsuper; s++) {
        if (!solve->node[s].leaves) continue;
        solve->node[s].to = solve->area;
        solve->area += solve->node[s].m;
    }
    solve->top = plan->top;
    solve->ntop = plan->nstep > 0 ? plan->step[plan->nstep - 1].top_end : 0;
    solve->work = (plan->largest_front + 2 * QC__SOLVE_PAD) / QC__SOLVE_PAD * QC__SOLVE_PAD;
    qc__free(parity);
    return list_targets(ctx, S, solve);
}
