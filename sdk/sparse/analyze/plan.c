/* Schedule of the multifrontal factorisation: which subtrees are independent tasks, when the top of
 * the tree runs, and where every update matrix lives. Depends on the tree alone. */
#include "sdk/sparse/analyze/area.h"
#include "sdk/sparse/internal.h"

/* A step costs about this much, so that progress is felt. */
static const double step_cost = 2.5e8;

static int32_t width_of(const qc_symbolic *S, int32_t s) {
    return S->super[s + 1] - S->super[s];
}
static int32_t rows_of(const qc_symbolic *S, int32_t s) {
    return (int32_t)(S->rowptr[s + 1] - S->rowptr[s]);
}
static int64_t update_size(const qc_symbolic *S, int32_t s) {
    const int64_t m = rows_of(S, s) - width_of(S, s);
    return m * m;
}

/* Flops, plus what assembly and the overhead of a front cost in the same time. */
static double front_cost(const qc_symbolic *S, int32_t s) {
    const double w = width_of(S, s), r = rows_of(S, s), m = r - w;
    return (r * r * r - m * m * m) / 3 + 20 * r * r + 5000;
}

void qc__plan_free(qc__plan *plan) {
    qc__free(plan->task);
    qc__free(plan->step);
    qc__free(plan->top);
    qc__free(plan->update);
    qc__free(plan->shared);
}

/* cost: of the subtree of s; first: its first supernode */
static double subtree_costs(const qc_symbolic *S, double *cost, int32_t *first) {
    double total = 0;
    for (int32_t s = 0; s < S->nsuper; s++) {
        cost[s] = front_cost(S, s);
        first[s] = s;
        for (int32_t c = S->child[s]; c != -1; c = S->sibling[c]) {
            cost[s] += cost[c];
            if (first[c] < first[s]) first[s] = first[c];
        }
        if (S->parent[s] == -1) total += cost[s];
    }
    return total;
}

/* Largest subtrees of cost <= limit; neighbours are joined into one task while small. Steps are cut
 * so that tasks of a step are followed by the top supernodes which lie before the next step. */
static void cut_tree(const qc_symbolic *S, const double *cost, const int32_t *first, double limit,
                     qc__plan *plan) {
    qc__step *step = plan->step;
    double task_cost = 0;
    int32_t ntop = 0, end = -1; /* end: one after the last task */
    if (S->nsuper == 0) return;
    *step = (qc__step){0, 0, 0, 0, 0};
    plan->nstep = 1;
    for (int32_t s = 0; s < S->nsuper; s++) {
        const int32_t p = S->parent[s];
        const bool root_of_task = cost[s] <= limit && (p == -1 || cost[p] > limit);
        if (root_of_task) {
            const bool joins = end == first[s] && task_cost + cost[s] <= limit;
            if (!joins && (step->cost > 4 * step_cost || step->top_end > step->top + 15)) {
                step = &plan->step[plan->nstep++];
                *step = (qc__step){plan->ntask, plan->ntask, ntop, ntop, 0};
            }
            if (joins) {
                plan->task[plan->ntask - 1].last = s;
                task_cost += cost[s];
            } else {
                plan->task[plan->ntask++] = (qc__task){first[s], s};
                task_cost = cost[s];
                step->task_end = plan->ntask;
            }
            step->cost += cost[s];
            end = s + 1;
        } else if (cost[s] > limit) {
            plan->top[ntop++] = s;
            step->top_end = ntop;
            step->cost += front_cost(S, s);
        }
    }
}

/* Inside a task, supernodes of even and odd depth use two stacks: the update matrices of the
 * children are on top of one while their parent pushes on the other. Returns the space needed. */
static int64_t place_on_stacks(const qc_symbolic *S, qc__task task, const int32_t *depth,
                               qc__plan *plan) {
    int64_t top[2] = {0, 0}, peak[2] = {0, 0};
    for (int32_t s = task.first; s <= task.last; s++) {
        const int parity = depth[s] & 1;
        for (int32_t c = S->child[s]; c != -1; c = S->sibling[c]) top[!parity] -= update_size(S, c);
        if (plan->shared[s]) continue;
        plan->update[s] = top[parity];
        top[parity] += update_size(S, s);
        if (top[parity] > peak[parity]) peak[parity] = top[parity];
    }
    for (int32_t s = task.first; s <= task.last; s++)
        if (!plan->shared[s] && (depth[s] & 1)) plan->update[s] += peak[0];
    return peak[0] + peak[1];
}

static void place_updates(const qc_symbolic *S, qc__plan *plan, const int32_t *depth,
                          qc__area *area) {
    for (int32_t s = 0; s < S->nsuper; s++) plan->shared[s] = true;
    for (int32_t t = 0; t < plan->ntask; t++)
        for (int32_t s = plan->task[t].first; s <= plan->task[t].last; s++)
            plan->shared[s] = S->parent[s] == -1 || S->parent[s] > plan->task[t].last;
    for (int32_t i = 0; i < plan->nstep; i++) {
        const qc__step *step = &plan->step[i];
        for (int32_t t = step->task; t < step->task_end; t++) {
            const int64_t need = place_on_stacks(S, plan->task[t], depth, plan);
            if (need > plan->stack) plan->stack = need;
            for (int32_t s = plan->task[t].first; s <= plan->task[t].last; s++)
                if (plan->shared[s]) qc__area_place(area, s, update_size(S, s));
        }
        for (int32_t k = step->top; k < step->top_end; k++) {
            const int32_t s = plan->top[k];
            qc__area_place(area, s, update_size(S, s));
            for (int32_t c = S->child[s]; c != -1; c = S->sibling[c]) qc__area_release(area, c);
        }
    }
    plan->area = area->total;
}

static void measure(const qc_symbolic *S, qc__plan *plan) {
    for (int32_t s = 0; s < S->nsuper; s++) {
        const int32_t w = width_of(S, s), r = rows_of(S, s);
        if (r > plan->largest_front) plan->largest_front = r;
        if (w > plan->largest_width) plan->largest_width = w;
        if (qc__front_work(r, w) > plan->work) plan->work = qc__front_work(r, w);
    }
}

static qc_status shrink(qc_ctx *ctx, qc__plan *plan) {
    const int32_t tops = plan->nstep > 0 ? plan->step[plan->nstep - 1].top_end : 0;
    const bool ok = qc__shrink(ctx, (void **)&plan->task, plan->ntask, sizeof *plan->task) &&
                    qc__shrink(ctx, (void **)&plan->step, plan->nstep, sizeof *plan->step) &&
                    qc__shrink(ctx, (void **)&plan->top, tops, sizeof *plan->top);
    return ok ? QC_OK : QC_ERR_NOMEM;
}

qc_status qc__plan_create(qc_ctx *ctx, qc_symbolic *S) {
    qc__plan *plan = &S->plan;
    const int32_t ns = S->nsuper;
    double *cost = QC__NEW(ctx, double, ns);
    int32_t *first = QC__NEW(ctx, int32_t, ns), *depth = QC__NEW(ctx, int32_t, ns);
    qc__area area = {0};
    plan->task = QC__NEW(ctx, qc__task, ns);
    plan->step = QC__NEW(ctx, qc__step, ns + 1);
    plan->top = QC__NEW(ctx, int32_t, ns);
    plan->update = QC__NEW(ctx, int64_t, ns);
    plan->shared = QC__NEW(ctx, bool, ns);
    qc_status status = QC_ERR_NOMEM;
    if (cost && first && depth && plan->task && plan->step && plan->top && plan->update &&
        plan->shared) {
        plan->cost = subtree_costs(S, cost, first);
        double limit = plan->cost / 16;
        if (limit < 1e6) limit = 1e6; /* smaller pieces would cost more than they gain */
        if (limit > step_cost) limit = step_cost;
        cut_tree(S, cost, first, limit, plan);
        for (int32_t s = ns; s-- > 0;) depth[s] = S->parent[s] == -1 ? 0 : depth[S->parent[s]] + 1;
        measure(S, plan);
        status = shrink(ctx, plan);
        if (status == QC_OK) status = qc__area_create(ctx, ns, plan->update, &area);
        if (status == QC_OK) place_updates(S, plan, depth, &area);
        qc__area_free(&area);
    }
    qc__free(cost);
    qc__free(first);
    qc__free(depth);
    return status;
}
