/* Everything measured, as JSON. Values are in seconds, bytes, entries; 0 = not measured. */
#include "bench.h"

#include <jansson.h>

static json_t *limits_object(const bench_limits *l) {
    return json_pack("{s:f,s:f,s:[f,f,f],s:f,s:f,s:f,s:f}", "fma_flops", l->fma, "fma_avx2_flops",
                     l->fma_avx2, "zgemm_flops_8_32_128", l->zgemm[0], l->zgemm[1], l->zgemm[2],
                     "l2_bytes", l->l2, "l3_bytes", l->l3, "memory_bytes", l->memory,
                     "memory_two_cores_bytes", l->memory2);
}

static json_t *row_object(const bench_table *t, const bench_row *r) {
    json_t *peers = json_object();
    for (int c = 0; c < t->columns; c++) {
        if (r->peer[c] <= 0) continue;
        json_t *peer = json_pack("{s:f}", "value", r->peer[c]);
        if (r->ours > 0) json_object_set_new(peer, "ratio", json_real(r->peer[c] / r->ours));
        if (r->reach[c] > 0) json_object_set_new(peer, "reach", json_real(r->reach[c]));
        json_object_set_new(peers, t->column[c], peer);
    }
    json_t *object =
        json_pack("{s:s,s:s,s:f,s:o,s:f,s:f}", "name", r->name, "unit", r->unit, "ours", r->ours,
                  "peers", peers, "rate", r->rate, "percent_of_limit", r->percent);
    if (r->other) {
        json_t *other = json_pack("{s:f,s:f,s:f}", "value", r->other_value, "ratio",
                                  r->other_value / r->ours, "reach", r->other_reach);
        json_object_set_new(object, r->other, other);
    }
    return object;
}

static json_t *comparison_object(const bench_comparison *c) {
    json_t *tables = json_object();
    for (int i = 0; i < TABLES; i++) {
        const bench_table *t = &c->table[i];
        if (t->rows == 0) continue;
        json_t *rows = json_array();
        for (int r = 0; r < t->rows; r++) json_array_append_new(rows, row_object(t, &t->row[r]));
        json_object_set_new(tables, t->title, rows);
    }
    return json_pack("{s:s,s:i,s:i,s:f,s:f,s:o}", "mesh", c->name, "faces", (int)c->faces, "n",
                     (int)c->n, "nnz", c->nnz, "residual", c->residual, "tables", tables);
}

void bench_write_json(const char *path, const bench_limits *l, int32_t n,
                      const bench_comparison *c) {
    json_t *list = json_array();
    for (int32_t i = 0; i < n; i++) json_array_append_new(list, comparison_object(&c[i]));
    json_t *root = json_pack("{s:o,s:o}", "limits", limits_object(l), "meshes", list);
    if (!root || json_dump_file(root, path, JSON_INDENT(1) | JSON_REAL_PRECISION(6)) != 0)
        bench_die("cannot write %s", path);
    json_decref(root);
}
