/* Supernodes: runs of columns of L with the same structure, then light relaxed amalgamation
 * (Ashcraft, Grimes 1989): a small supernode joins its parent when this stores few extra zeros.
 * Finally the columns are renumbered so that supernodes are contiguous and postordered. */
#include "sdk/sparse/internal.h"

typedef struct group {
    int32_t width, rows; /* the panel is rows x width */
    int32_t parent;      /* group, -1 for roots */
    int32_t into;        /* group it was merged into, -1 = still alive */
    int64_t entries;     /* true entries of L */
} group;

static int64_t trapezoid(int64_t width, int64_t rows) {
    return width * rows - width * (width - 1) / 2;
}

/* parent(j) = j + 1 and equal structure: j belongs to the supernode of j + 1. */
static int32_t find_groups(int32_t n, const int32_t *parent, const int32_t *count,
                           int32_t *group_of, group *g) {
    int32_t ng = 0;
    for (int32_t j = 0; j < n; j++) {
        const bool joins = j > 0 && parent[j - 1] == j && count[j - 1] == count[j] + 1;
        if (!joins) g[ng++] = (group){0, count[j], -1, -1, 0};
        g[ng - 1].width++;
        g[ng - 1].entries += count[j];
        group_of[j] = ng - 1;
    }
    for (int32_t j = 0; j < n; j++)
        if (parent[j] != -1 && group_of[parent[j]] != group_of[j])
            g[group_of[j]].parent = group_of[parent[j]];
    return ng;
}

/* Wide supernodes pay for zeros with flops, narrow ones save more in call overhead. */
static double allowed_zeros(int32_t width) {
    return width <= 4 ? 0.35 : width <= 16 ? 0.12 : width <= 48 ? 0.05 : 0.01;
}

static int32_t alive(const group *g, int32_t s) {
    while (s != -1 && g[s].into != -1) s = g[s].into;
    return s;
}

static void amalgamate(int32_t ng, group *g) {
    for (int32_t s = 0; s < ng; s++) {
        const int32_t p = g[s].parent; /* later in postorder, hence not merged yet */
        if (p == -1) continue;
        const int32_t width = g[s].width + g[p].width, rows = g[s].width + g[p].rows;
        const int64_t entries = g[s].entries + g[p].entries, stored = trapezoid(width, rows);
        if ((double)(stored - entries) > allowed_zeros(width) * (double)stored) continue;
        g[p].width = width;
        g[p].rows = rows;
        g[p].entries = entries;
        g[s].into = p;
    }
}

/* Columns by supernode, supernodes in postorder: fills S->super, super_of, parent, rowptr, panel
 * and newest[column] = its final number. post: place[k] = k-th group; number: group -> supernode.
 */
static void number_columns(qc_symbolic *S, int32_t ng, const group *g, const int32_t *post,
                           int32_t *number, const int32_t *group_of, int32_t *newest) {
    int32_t ns = 0;
    S->super[0] = 0;
    S->rowptr[0] = S->panel[0] = 0;
    for (int32_t k = 0; k < ng; k++) {
        const group *s = &g[post[k]];
        if (s->into != -1) continue;
        number[post[k]] = ns;
        S->super[ns + 1] = S->super[ns] + s->width;
        S->rowptr[ns + 1] = S->rowptr[ns] + s->rows;
        S->panel[ns + 1] = S->panel[ns] + (int64_t)s->width * s->rows;
        ns++;
    }
    S->nsuper = ns;
    for (int32_t s = 0; s < ng; s++)
        if (g[s].into == -1)
            S->parent[number[s]] = g[s].parent == -1 ? -1 : number[alive(g, g[s].parent)];
    for (int32_t s = 0; s < ns; s++) S->child[s] = S->super[s]; /* next free column */
    for (int32_t j = 0; j < S->n; j++) {
        const int32_t s = number[alive(g, group_of[j])];
        newest[j] = S->child[s]++;
        S->super_of[newest[j]] = s;
    }
}

static void link_children(qc_symbolic *S) {
    for (int32_t s = 0; s < S->nsuper; s++) S->child[s] = -1;
    for (int32_t s = S->nsuper; s-- > 0;) {
        const int32_t p = S->parent[s];
        if (p == -1) {
            S->sibling[s] = -1;
        } else {
            S->sibling[s] = S->child[p];
            S->child[p] = s;
        }
    }
}

static void renumber(qc_symbolic *S, const int32_t *newest, int32_t *old) {
    for (int32_t k = 0; k < S->n; k++) old[k] = S->perm[k];
    for (int32_t k = 0; k < S->n; k++) S->perm[newest[k]] = old[k];
    for (int32_t k = 0; k < S->n; k++) S->inverse[S->perm[k]] = k;
}

/* There are far fewer supernodes than columns. */
static qc_status shrink(qc_ctx *ctx, qc_symbolic *S) {
    const int64_t count = (int64_t)S->nsuper + 1;
    const bool ok = qc__shrink(ctx, (void **)&S->super, count, sizeof *S->super) &&
                    qc__shrink(ctx, (void **)&S->parent, count, sizeof *S->parent) &&
                    qc__shrink(ctx, (void **)&S->child, count, sizeof *S->child) &&
                    qc__shrink(ctx, (void **)&S->sibling, count, sizeof *S->sibling) &&
                    qc__shrink(ctx, (void **)&S->rowptr, count, sizeof *S->rowptr) &&
                    qc__shrink(ctx, (void **)&S->panel, count, sizeof *S->panel);
    return ok ? QC_OK : QC_ERR_NOMEM;
}

qc_status qc__supernodes(qc_ctx *ctx, qc_symbolic *S, const int32_t *parent, const int32_t *count) {
    const int32_t n = S->n;
    group *g = QC__NEW(ctx, group, n);
    int32_t *work = QC__NEW(ctx, int32_t, 7 * (int64_t)n);
    qc_status status = QC_ERR_NOMEM;
    if (g && work) {
        int32_t *group_of = work, *up = work + n, *post = work + 2 * (int64_t)n,
                *number = work + 3 * (int64_t)n, *free_work = work + 4 * (int64_t)n;
        const int32_t ng = find_groups(n, parent, count, group_of, g);
        amalgamate(ng, g);
        for (int32_t s = 0; s < ng; s++)
            up[s] = g[s].into != -1 ? g[s].into : alive(g, g[s].parent);
        qc__postorder(ng, up, post, free_work);
        number_columns(S, ng, g, post, number, group_of, free_work);
        renumber(S, free_work, free_work + n);
        link_children(S);
        status = shrink(ctx, S);
    }
    qc__free(g);
    qc__free(work);
    return status;
}
