/* A binary tree of bounding boxes over the centroids of triangles, split at the median of the
 * longest axis. */
#include "sdk/mesh/box_tree.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { LEAF = 4, POLL = 1 << 16 /* triangles of a box before which it asks whether to go on */ };

typedef struct builder {
    qc_ctx *ctx;
    const double *centroid; /* 3 n */
    int32_t *order;
    qc__box_tree *tree;
    bool stopped;
} builder;

/* Moves the `middle - begin` smallest along `axis` to the front of order[begin, end). */
static void select_median(const builder *b, int32_t begin, int32_t end, int32_t middle, int axis) {
    int32_t *order = b->order;
    while (end - begin > 1) {
        const double pivot = b->centroid[3 * (int64_t)order[begin + (end - begin) / 2] + axis];
        int32_t i = begin, j = end - 1;
        while (i <= j) {
            while (b->centroid[3 * (int64_t)order[i] + axis] < pivot) i++;
            while (b->centroid[3 * (int64_t)order[j] + axis] > pivot) j--;
            if (i > j) break;
            const int32_t swap = order[i];
            order[i++] = order[j];
            order[j--] = swap;
        }
        if (middle <= j)
            end = j + 1;
        else if (middle >= i)
            begin = i;
        else
            return;
    }
}

static int longest_axis(const builder *b, int32_t begin, int32_t end) {
    double lo[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, hi[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (int32_t i = begin; i < end; i++)
        for (int k = 0; k < 3; k++) {
            const double x = b->centroid[3 * (int64_t)b->order[i] + k];
            lo[k] = fmin(lo[k], x);
            hi[k] = fmax(hi[k], x);
        }
    int axis = hi[1] - lo[1] > hi[0] - lo[0] ? 1 : 0;
    if (hi[2] - lo[2] > hi[axis] - lo[axis]) axis = 2;
    return axis;
}

static void split(builder *b, int32_t at, int32_t begin, int32_t end) {
    qc__box *self = &b->tree->box[at];
    if (end - begin <= LEAF) {
        self->first = begin;
        self->count = end - begin;
        return;
    }
    if (end - begin > POLL && !b->stopped) b->stopped = qc__poll(b->ctx) != QC_OK;
    if (b->stopped) return;
    const int32_t middle = begin + (end - begin) / 2;
    select_median(b, begin, end, middle, longest_axis(b, begin, end));
    self->first = b->tree->n_boxes;
    self->count = 0;
    b->tree->n_boxes += 2;
    const int32_t child = self->first;
    split(b, child, begin, middle);
    split(b, child + 1, middle, end);
}

static void copy_corners(const builder *b, int32_t n, const double *position,
                         const int32_t *vertex) {
    for (int32_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            memcpy(b->tree->corner + 9 * (int64_t)i + 3 * k,
                   position + 3 * (int64_t)vertex[3 * (int64_t)b->order[i] + k],
                   3 * sizeof(double));
}

/* Children have higher numbers than their parent, so one backward sweep fits all boxes. */
static void fit_boxes(qc__box_tree *tree) {
    for (int32_t at = tree->n_boxes - 1; at >= 0; at--) {
        qc__box *self = &tree->box[at];
        for (int k = 0; k < 3; k++) {
            double lo = DBL_MAX, hi = -DBL_MAX;
            if (self->count == 0) {
                const qc__box *child = &tree->box[self->first];
                lo = fmin(child[0].lo[k], child[1].lo[k]);
                hi = fmax(child[0].hi[k], child[1].hi[k]);
            }
            for (int32_t c = 3 * self->first; c < 3 * (self->first + self->count); c++) {
                lo = fmin(lo, tree->corner[3 * (int64_t)c + k]);
                hi = fmax(hi, tree->corner[3 * (int64_t)c + k]);
            }
            self->lo[k] = lo;
            self->hi[k] = hi;
        }
    }
}

void qc__box_tree_free(qc__box_tree *tree) {
    qc__free(tree->box);
    qc__free(tree->corner);
    qc__free(tree->order);
    qc__free(tree->place);
    *tree = (qc__box_tree){0};
}

static bool allocate(qc_ctx *ctx, int64_t n, qc__box_tree *tree) {
    *tree = (qc__box_tree){0};
    tree->box = QC__NEW(ctx, qc__box, 2 * n);
    tree->corner = QC__NEW(ctx, double, 9 * n);
    tree->order = QC__NEW(ctx, int32_t, n);
    tree->place = QC__NEW(ctx, int32_t, n);
    if (tree->box && tree->corner && tree->order && tree->place) return true;
    qc__box_tree_free(tree);
    return false;
}

qc_status qc__box_tree_build(qc_ctx *ctx, int32_t n, const double *position, const int32_t *vertex,
                             qc__box_tree *out) {
    qc__box_tree tree = {0};
    double *centroid = QC__NEW(ctx, double, 3 * (int64_t)n);
    if (!centroid || !allocate(ctx, n, &tree)) {
        qc__free(centroid);
        return QC_ERR_NOMEM;
    }
    for (int32_t i = 0; i < n; i++) {
        const int32_t *v = vertex + 3 * (int64_t)i;
        tree.order[i] = i;
        for (int k = 0; k < 3; k++)
            centroid[3 * (int64_t)i + k] =
                (position[3 * (int64_t)v[0] + k] + position[3 * (int64_t)v[1] + k] +
                 position[3 * (int64_t)v[2] + k]) /
                3;
    }
    builder b = {ctx, centroid, tree.order, &tree, false};
    tree.n_boxes = 1;
    split(&b, 0, 0, n);
    if (b.stopped) {
        qc__free(centroid);
        qc__box_tree_free(&tree);
        return QC_ERR_CANCELLED;
    }
    for (int32_t i = 0; i < n; i++) tree.place[tree.order[i]] = i;
    copy_corners(&b, n, position, vertex);
    fit_boxes(&tree);
    qc__free(centroid);
    *out = tree;
    return QC_OK;
}
