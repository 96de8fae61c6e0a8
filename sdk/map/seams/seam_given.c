/* Coordinates which are no unknowns: those of points and those across features (see seams.h). */
#include "sdk/map/seams/levels.h"

static bool has_level(const qc__levels *levels, int32_t x) {
    return levels->coordinate && levels->coordinate[x].level >= 0;
}

static qc_status allocate_given(qc_ctx *ctx, qc__seams *s, const qc__levels *levels) {
    int64_t terms = 2 * (int64_t)s->n_cones;
    s->vertex_given = QC__NEW(ctx, int32_t, s->mesh->n_vertices);
    if (!s->vertex_given) return QC_ERR_NOMEM;
    for (int32_t v = 0; v < s->mesh->n_vertices; v++) {
        const bool given =
            s->vertex_cone[v] >= 0 || has_level(levels, 2 * v) || has_level(levels, 2 * v + 1);
        s->vertex_given[v] = given ? s->n_given++ : -1;
        for (int32_t x = 2 * v; x < 2 * v + 2 && s->vertex_cone[v] < 0; x++)
            if (has_level(levels, x)) terms += 1 + levels->coordinate[x].n;
    }
    s->given_start = QC__NEW(ctx, int64_t, 2 * (int64_t)s->n_given + 1);
    s->given_symbol = QC__NEW(ctx, int32_t, terms);
    s->given_value = QC__NEW(ctx, int32_t, terms);
    return s->given_start && s->given_symbol && s->given_value ? QC_OK : QC_ERR_NOMEM;
}

static void write_given(qc__seams *s, const qc__levels *levels) {
    int64_t at = 0;
    int32_t row = 0;
    for (int32_t x = 0; x < 2 * s->mesh->n_vertices; x++) {
        const int32_t cone = s->vertex_cone[x / 2];
        if (s->vertex_given[x / 2] < 0) continue;
        s->given_start[row++] = at;
        if (cone >= 0) {
            s->given_symbol[at] = qc__position_symbol(s, cone, x % 2);
            s->given_value[at++] = 1;
        } else if (has_level(levels, x)) {
            const qc__coordinate *c = &levels->coordinate[x];
            s->given_symbol[at] = qc__level_symbol(s, c->level);
            s->given_value[at++] = c->sign;
            for (int64_t i = c->start; i < c->start + c->n; i++) {
                s->given_symbol[at] = levels->pool[i].symbol;
                s->given_value[at++] = c->offset_sign * levels->pool[i].value;
            }
        }
    }
    s->given_start[row] = at;
}

qc_status qc__seams_find_given(qc_ctx *ctx, qc__seams *s, const qc__features *f) {
    qc__levels levels = {0};
    qc_status status = f->axis ? qc__levels_find(ctx, s, f, &levels) : QC_OK;
    if (status == QC_OK) status = allocate_given(ctx, s, &levels);
    if (status == QC_OK) write_given(s, &levels);
    qc__levels_free(&levels);
    return status;
}
