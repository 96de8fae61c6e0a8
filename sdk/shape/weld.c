/* Welds the patches of a soup: vertices closer than 1e-8 of the extent become one. Candidates are
 * neighbours in the order of a projection to a line in general position. */
#include "sdk/mesh/internal.h"
#include "sdk/shape/internal.h"

static const double TOLERANCE = 1e-8;

static double extent(const qc__soup *s) {
    double largest = 0;
    for (int64_t i = 0; i < 3 * s->n_vertices; i++) largest = fmax(largest, fabs(s->position[i]));
    return largest;
}

static bool near(const qc__soup *s, int32_t v, int32_t w, double tolerance) {
    double d[3];
    for (int i = 0; i < 3; i++)
        d[i] = s->position[3 * (int64_t)v + i] - s->position[3 * (int64_t)w + i];
    return qc__dot(d, d) <= tolerance * tolerance;
}

/* set[v] = lowest vertex at the place of v. */
static qc_status find_equal(const qc__soup *s, int32_t *set) {
    static const double line[3] = {0.5231, 0.6127, 0.5923};
    int32_t n = (int32_t)s->n_vertices;
    double size = extent(s), tolerance = TOLERANCE * size;
    uint64_t *key = QC__NEW(s->ctx, uint64_t, n);
    int32_t *order = QC__NEW(s->ctx, int32_t, n);
    double *height = QC__NEW(s->ctx, double, n);
    qc_status status = key && order && height ? QC_OK : QC_ERR_NOMEM;
    for (int32_t v = 0; status == QC_OK && v < n; v++) {
        height[v] = 2 * size + qc__dot(line, s->position + 3 * (int64_t)v);
        key[v] = qc__sort_key(height[v]);
        order[v] = v;
    }
    if (status == QC_OK) status = qc__sort_keys(s->ctx, n, key, order);
    if (status == QC_OK) qc__sets_init(set, n);
    for (int32_t i = 1; status == QC_OK && i < n; i++)
        for (int32_t j = i - 1; j >= 0 && height[order[i]] - height[order[j]] <= 2 * tolerance; j--)
            if (near(s, order[i], order[j], tolerance)) qc__sets_unite(set, order[i], order[j]);
    qc__free(key);
    qc__free(order);
    qc__free(height);
    return status;
}

/* Moves the surviving vertices together, in their order; set[] becomes the new number. */
static void renumber(qc__soup *s, int32_t *set) {
    int32_t n = 0;
    for (int32_t v = 0; v < s->n_vertices; v++) {
        int32_t root = qc__sets_find(set, v);
        if (root != v) {
            set[v] = root;
            continue;
        }
        for (int i = 0; i < 3; i++)
            s->position[3 * (int64_t)n + i] = s->position[3 * (int64_t)v + i];
        n++;
    }
    int32_t next = 0; /* roots come before their members */
    for (int32_t v = 0; v < s->n_vertices; v++) set[v] = set[v] == v ? next++ : set[set[v]];
    for (int64_t c = 0; c < 3 * s->n_faces; c++) s->face[c] = set[s->face[c]];
    s->n_vertices = n;
}

qc_status qc__soup_mesh(qc__soup *s, qc_mesh **out) {
    int32_t *set = s->status == QC_OK ? QC__NEW(s->ctx, int32_t, s->n_vertices) : NULL;
    if (s->status == QC_OK && !set) s->status = QC_ERR_NOMEM;
    if (s->status == QC_OK) s->status = find_equal(s, set);
    if (s->status == QC_OK) {
        renumber(s, set);
        s->status = qc_mesh_create(s->ctx, (int32_t)s->n_vertices, s->position, (int32_t)s->n_faces,
                                   s->face, out);
    }
    qc__free(set);
    qc__free(s->position);
    qc__free(s->face);
    return s->status;
}
