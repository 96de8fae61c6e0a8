/* Tables as text or Markdown. A ratio is peer / ours: above 1 ours is better. */
#include "bench.h"

#include <stdio.h>
#include <string.h>

bench_row *bench_add_row(bench_table *t, const char *name, const char *unit, double ours) {
    if (t->rows == MOST_ROWS) bench_die("too many rows");
    bench_row *r = &t->row[t->rows++];
    *r = (bench_row){.name = name, .unit = unit, .ours = ours};
    return r;
}

/* 0.0123 s as "12.3 ms". */
static const char *quantity(char *out, size_t size, double value, const char *unit) {
    static const struct {
        double scale;
        const char *prefix;
    } large[] = {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}},
      small[] = {{1, ""}, {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}};
    const bool time = strcmp(unit, "s") == 0;
    int i = 0;
    while (i < 3 && value < (time ? small : large)[i].scale) i++;
    const double scale = (time ? small : large)[i].scale;
    snprintf(out, size, "%.3g %s%s", value / scale, (time ? small : large)[i].prefix, unit);
    return out;
}

static void print_reach(char *out, size_t size, const bench_table *t, const bench_row *r) {
    size_t used = 0;
    out[0] = 0;
    for (int c = 0; c < t->columns && used < size; c++) {
        if (r->reach[c] <= 0 || r->peer[c] <= 0 || r->ours <= 0) continue;
        const bool reached = r->peer[c] / r->ours >= r->reach[c];
        used += (size_t)snprintf(out + used, size - used, "%s%.3g %s", used ? "; " : "",
                                 r->reach[c], reached ? "yes" : "NO");
    }
    if (r->other)
        snprintf(out, size, "%s %.3g: %.3g %s", r->other, r->other_value / r->ours, r->other_reach,
                 r->other_value / r->ours >= r->other_reach ? "yes" : "NO");
}

static void print_cell(const char *text, int width, int format) {
    if (format == FORMAT_MARKDOWN)
        printf(" %s |", text);
    else
        printf("%*s", width, text);
}

static void print_header(const bench_table *t, int format) {
    const bool markdown = format == FORMAT_MARKDOWN;
    printf(markdown ? "\n%s:\n\n| |" : "  %-37s", t->title);
    print_cell("ours", 11, format);
    for (int c = 0; c < t->columns; c++) print_cell(t->column[c], 18, format);
    print_cell("rate", 14, format);
    print_cell("of limit", 9, format);
    print_cell("to reach", 16, format);
    printf("\n");
    if (!markdown) return;
    for (int c = 0; c < t->columns + 5; c++) printf(c ? "---:|" : "|---|");
    printf("\n");
}

static void print_row(const bench_table *t, const bench_row *r, int format) {
    char cell[128];
    printf(format == FORMAT_MARKDOWN ? "| %s |" : "  %-37s", r->name);
    print_cell(r->ours > 0 ? quantity(cell, sizeof cell, r->ours, r->unit) : "", 11, format);
    for (int c = 0; c < t->columns; c++) {
        snprintf(cell, sizeof cell, "%.3g", r->ours > 0 ? r->peer[c] / r->ours : 0);
        print_cell(r->peer[c] > 0 && r->ours > 0 ? cell : "", 18, format);
    }
    print_cell(r->rate > 0 ? quantity(cell, sizeof cell, r->rate, r->rate_unit) : "", 14, format);
    snprintf(cell, sizeof cell, "%.0f %%", r->percent);
    print_cell(r->percent > 0 ? cell : "", 9, format);
    print_reach(cell, sizeof cell, t, r);
    print_cell(cell, 16, format);
    printf("\n");
}

void bench_print_comparison(const bench_comparison *c, int format) {
    const bool markdown = format == FORMAT_MARKDOWN;
    printf(markdown ? "\n### %s: %d faces\n\nn = %d, %.0f entries in the upper triangle; "
                      "largest relative residual of all libraries %.0e.\n"
                    : "%s: %d faces, n = %d, nnz(A) = %.0f, largest residual %.0e\n",
           c->name, (int)c->faces, (int)c->n, c->nnz, c->residual);
    for (int i = 0; i < TABLES; i++) {
        const bench_table *t = &c->table[i];
        if (t->rows == 0) continue;
        print_header(t, format);
        for (int r = 0; r < t->rows; r++) print_row(t, &t->row[r], format);
    }
    printf("\n");
    fflush(stdout);
}

void bench_print_limits(const bench_limits *l, int format) {
    printf(format == FORMAT_MARKDOWN
               ? "One core: %.1f Gflop/s of multiply-adds in registers (AVX2 alone %.1f); zgemm of "
                 "n = 8, 32, 128: %.1f, %.1f, %.1f Gflop/s; read and written in place: %.1f GB/s "
                 "in the second-level cache, %.1f in the third, %.1f from memory, %.1f by two "
                 "cores together.\n"
               : "limits: FMA %.1f (AVX2 %.1f), zgemm %.1f %.1f %.1f Gflop/s; L2 %.1f, L3 %.1f, "
                 "memory %.1f, two cores %.1f GB/s\n",
           l->fma / 1e9, l->fma_avx2 / 1e9, l->zgemm[0] / 1e9, l->zgemm[1] / 1e9, l->zgemm[2] / 1e9,
           l->l2 / 1e9, l->l3 / 1e9, l->memory / 1e9, l->memory2 / 1e9);
    fflush(stdout);
}
