/* Closest names, by edit distance. */
#include "bindings/cli/cli.h"
#include <string.h>

static size_t edit_distance(const char *a, const char *b) {
    enum { LONGEST = 64 };
    size_t row[LONGEST + 1];
    const size_t n = strlen(a), m = strlen(b);
    if (n > LONGEST || m > LONGEST) return SIZE_MAX;
    for (size_t j = 0; j <= m; j++) row[j] = j;
    for (size_t i = 1; i <= n; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= m; j++) {
            const size_t replace = diagonal + (a[i - 1] != b[j - 1]);
            const size_t other = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
            diagonal = row[j];
            row[j] = replace < other ? replace : other;
        }
    }
    return row[m];
}

const char *cli_closest(const char *name, const char *const *names, size_t n) {
    const char *best = NULL;
    size_t best_distance = 2 + strlen(name) / 2;
    for (size_t i = 0; i < n; i++) {
        const size_t d = edit_distance(name, names[i]);
        if (d >= best_distance || !*names[i]) continue;
        best_distance = d;
        best = names[i];
    }
    return best;
}
