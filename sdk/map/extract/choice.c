/* Choice of the open cells: those covered by half or more, or in their centre; where two loops
 * would merge less; cells which hang on one vertex are joined by the better covered of the cells
 * between; a loop which the cells would close gets a cell back. Bounded: every step walks the open
 * cells once. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sdk/map/extract/internal.h"
#include "sdk/mesh/internal.h"

static const double least_bridge = 0.1; /* coverage of a cell which joins two others */

typedef struct choice {
    qc__cells *c;
    const qc__loops *l;
    int32_t *set; /* corners which are one vertex */
} choice;

static const qc__piece *piece_of(const choice *s, int32_t cell) {
    return &s->c->pieces.piece[cell - s->c->n_complete];
}

static void glue(choice *s, int32_t a, int32_t b) {
    s->c->across[a] = b;
    s->c->across[b] = a;
    qc__sets_unite(s->set, a, qc__side_end(b));
    qc__sets_unite(s->set, b, qc__side_end(a));
}

/* Joins a kept open cell with its kept neighbours; a side meets one cell at most. */
static void glue_cell(choice *s, int32_t cell) {
    qc__cells *c = s->c;
    const int32_t i = cell - c->n_complete;
    for (int32_t j = c->contact_first[i]; j < c->contact_first[i + 1]; j++) {
        const int32_t a = c->contact[2 * (int64_t)j], b = c->contact[2 * (int64_t)j + 1];
        if (c->keep[b / 4] && c->across[a] < 0 && c->across[b] < 0 && a / 4 != b / 4) glue(s, a, b);
    }
}

/* All corners of the complete cells and the kept ones anew. */
static void glue_all(choice *s) {
    qc__cells *c = s->c;
    const int64_t open = 4 * (int64_t)c->n_complete;
    qc__sets_init(s->set, 4 * c->n);
    for (int64_t i = open; i < 4 * (int64_t)c->n; i++) {
        if (c->across[i] >= 0 && c->across[i] < open) c->across[c->across[i]] = -1;
        c->across[i] = -1;
    }
    for (int32_t a = 0; a < open; a++)
        if (c->across[a] >= a) glue(s, a, c->across[a]);
    for (int32_t cell = c->n_complete; cell < c->n; cell++)
        if (c->keep[cell]) glue_cell(s, cell);
}

static void keep_covered(choice *s) {
    qc__cells *c = s->c;
    for (int32_t cell = c->n_complete; cell < c->n; cell++) {
        const int32_t i = cell - c->n_complete;
        double limit = 0.5;
        for (int32_t j = s->l->first[i]; j < s->l->first[i + 1]; j++)
            if (s->l->limit[s->l->met[j]] < limit) limit = s->l->limit[s->l->met[j]];
        const qc__piece *p = piece_of(s, cell);
        /* a corner of the surface which holds the centre of the square covers a quarter */
        if (p->middle) limit = fmin(limit, 0.25);
        c->keep[cell] = s->l->pole[i] < 0 && p->disk && p->area >= limit - 1e-9;
    }
}

/* --- bridges ---------------------------------------------------------------------------------- */

typedef struct ranked {
    double area;
    int32_t cell;
} ranked;

static int by_area(const void *a, const void *b) {
    const ranked *x = a, *y = b;
    if (x->area != y->area) return x->area > y->area ? -1 : 1;
    return x->cell < y->cell ? -1 : x->cell > y->cell;
}

/* The corner set of the kept cell across side a of a dropped cell, at the start (0) or end (1) of
 * the side. -1 = none. */
static int32_t across_corner(choice *s, int32_t a, int end) {
    const qc__cells *c = s->c;
    const int32_t i = a / 4 - c->n_complete;
    for (int32_t j = c->contact_first[i]; j < c->contact_first[i + 1]; j++) {
        const int32_t b = c->contact[2 * (int64_t)j + 1];
        if (c->contact[2 * (int64_t)j] != a || !c->keep[b / 4] || c->across[b] >= 0) continue;
        return qc__sets_find(s->set, end ? b : qc__side_end(b));
    }
    return -1;
}

/* Whether kept cells on both sides of a corner of the dropped cell are not joined there. */
static bool is_bridge(choice *s, int32_t cell) {
    for (int k = 0; k < 4; k++) {
        const int32_t before = across_corner(s, 4 * cell + ((k + 3) & 3), 1);
        const int32_t after = across_corner(s, 4 * cell + k, 0);
        if (before >= 0 && after >= 0 && before != after) return true;
    }
    return false;
}

static qc_status keep_bridges(qc_ctx *ctx, choice *s) {
    qc__cells *c = s->c;
    ranked *rank = QC__NEW(ctx, ranked, c->n - c->n_complete);
    if (!rank) return QC_ERR_NOMEM;
    int32_t n = 0;
    for (int32_t cell = c->n_complete; cell < c->n; cell++) {
        const int32_t i = cell - c->n_complete;
        const qc__piece *p = piece_of(s, cell);
        bool wanted = false;
        for (int32_t j = s->l->first[i]; j < s->l->first[i + 1]; j++)
            wanted |= s->l->bridge[s->l->met[j]] != 0;
        if (wanted && s->l->pole[i] < 0 && !c->keep[cell] && p->disk && p->area >= least_bridge)
            rank[n++] = (ranked){p->area, cell};
    }
    qsort(rank, (size_t)n, sizeof *rank, by_area);
    for (int32_t i = 0; i < n; i++)
        if (is_bridge(s, rank[i].cell)) {
            c->keep[rank[i].cell] = 1;
            glue_cell(s, rank[i].cell);
        }
    qc__free(rank);
    return QC_OK;
}

/* --- loops which vanish ----------------------------------------------------------------------- */

/* A side on the boundary of the kept cells, no slit between two sides which would close. */
static bool is_rim(const qc__cells *c, int32_t a) {
    if (!c->keep[a / 4] || c->across[a] >= 0) return false;
    return qc__next_boundary_side(c, qc__next_boundary_side(c, a)) != a;
}

/* Whether kept cells which the loop meets, or neighbours of dropped ones, are on the rim. */
static bool has_rim(const qc__cells *c, int32_t cell) {
    const int32_t i = cell - c->n_complete;
    bool rim = false;
    for (int k = 0; c->keep[cell] && k < 4; k++) rim |= is_rim(c, 4 * cell + k);
    for (int32_t j = c->contact_first[i]; !c->keep[cell] && j < c->contact_first[i + 1]; j++)
        rim |= is_rim(c, c->contact[2 * (int64_t)j + 1]);
    return rim;
}

/* least[loop] = least covered of its kept cells. */
static void find_open_loops(const choice *s, uint8_t *open, int32_t *least) {
    const qc__cells *c = s->c;
    for (int32_t i = 0; i < s->l->n; i++) {
        open[i] = 0;
        least[i] = -1;
    }
    for (int32_t cell = c->n_complete; cell < c->n; cell++) {
        const int32_t i = cell - c->n_complete;
        const bool rim = has_rim(c, cell);
        for (int32_t j = s->l->first[i]; j < s->l->first[i + 1]; j++) {
            int32_t *l = &least[s->l->met[j]];
            open[s->l->met[j]] |= rim;
            if (c->keep[cell] && (*l < 0 || piece_of(s, cell)->area < piece_of(s, *l)->area))
                *l = cell;
        }
    }
}

/* Drops the least covered cell of each closed loop. */
static qc_status reopen(qc_ctx *ctx, choice *s) {
    uint8_t *open = QC__NEW(ctx, uint8_t, s->l->n);
    int32_t *least = QC__NEW(ctx, int32_t, s->l->n);
    const qc_status status = open && least ? QC_OK : QC_ERR_NOMEM;
    bool changed = false;
    if (status == QC_OK) find_open_loops(s, open, least);
    for (int32_t i = 0; status == QC_OK && i < s->l->n; i++)
        if (!open[i] && least[i] >= 0) {
            s->c->keep[least[i]] = 0;
            changed = true;
        }
    if (changed) glue_all(s);
    qc__free(open);
    qc__free(least);
    return status;
}

qc_status qc__choose(qc_ctx *ctx, qc__cells *cells, const qc__loops *loops, int32_t *set) {
    choice s = {cells, loops, set};
    memset(cells->keep, 1, (size_t)cells->n_complete);
    keep_covered(&s);
    glue_all(&s);
    const qc_status status = keep_bridges(ctx, &s);
    return status == QC_OK ? reopen(ctx, &s) : status;
}
