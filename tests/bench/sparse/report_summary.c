/* The figures to be reached over all meshes: one line for each, the ratios by mesh. */
#include "bench.h"

#include <stdio.h>
#include <string.h>

/* The row of that name, or NULL. */
static const bench_row *find_row(const bench_table *t, const char *name) {
    for (int r = 0; r < t->rows; r++)
        if (strcmp(t->row[r].name, name) == 0) return &t->row[r];
    return NULL;
}

/* What the line is about: a column of a row, or (column -1) another way of ours. */
static double figure(const bench_row *r, int column) {
    return column < 0 ? r->other_reach : r->reach[column];
}
static double ratio(const bench_row *r, int column) {
    const double value = column < 0 ? r->other_value : r->peer[column];
    return r->ours > 0 ? value / r->ours : 0;
}

/* True where the line names no figure before mesh i: it is to be printed once. */
static bool is_first(const bench_comparison *c, int32_t i, int table, const char *name,
                     int column) {
    for (int32_t k = 0; k < i; k++) {
        const bench_row *r = find_row(&c[k].table[table], name);
        if (r && figure(r, column) > 0) return false;
    }
    return true;
}

static void print_line(int32_t n, const bench_comparison *c, int table, const bench_row *row,
                       const char *against, int column, int format) {
    const bool markdown = format == FORMAT_MARKDOWN;
    static const char *const kind[TABLES] = {"", "same ordering: ", "own: "};
    char name[128];
    snprintf(name, sizeof name, "%s%s / %s", kind[table], row->name, against);
    printf(markdown ? "| %s |" : "  %-66s", name);
    for (int32_t i = 0; i < n; i++) {
        const bench_row *r = find_row(&c[i].table[table], row->name);
        char cell[64] = "";
        if (r && figure(r, column) > 0 && ratio(r, column) > 0)
            snprintf(cell, sizeof cell, "%.3g of %.3g", ratio(r, column), figure(r, column));
        const bool short_of = cell[0] && ratio(r, column) < figure(r, column);
        if (markdown)
            printf(short_of ? " %s |" : cell[0] ? " **%s** |" : " %s |", cell);
        else
            printf("%13s%s", cell, short_of ? "-" : cell[0] ? "+" : " ");
    }
    printf("\n");
}

static void print_header(int32_t n, const bench_comparison *c, int format) {
    const bool markdown = format == FORMAT_MARKDOWN;
    printf(markdown ? "\n### Against the figures to be reached\n\n| ratio |" : "%-68s", "summary");
    for (int32_t i = 0; i < n; i++) {
        char cell[64];
        snprintf(cell, sizeof cell, "%dk", (int)((c[i].faces + 500) / 1000));
        printf(markdown ? " %s |" : "%13s ", cell);
    }
    printf("\n");
    for (int32_t i = 0; markdown && i <= n; i++) printf(i ? "---:|" : "|---|");
    if (markdown) printf("\n");
}

void bench_print_summary(int32_t n, const bench_comparison *c, int format) {
    print_header(n, c, format);
    for (int table = 0; table < TABLES; table++)
        for (int32_t i = 0; i < n; i++) {
            const bench_table *t = &c[i].table[table];
            for (int r = 0; r < t->rows; r++)
                for (int column = -1; column < t->columns; column++) {
                    const bench_row *row = &t->row[r];
                    if (figure(row, column) <= 0 || !is_first(c, i, table, row->name, column))
                        continue;
                    print_line(n, c, table, row, column < 0 ? row->other : t->column[column],
                               column, format);
                }
        }
    printf("\n");
}
