/* Numbers and names as text, independent of the host's locale. */
#include "sdk/base/internal.h"
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Levenshtein distance, bounded: names are short. */
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
            diagonal = row[j];
            size_t best = row[j - 1] < row[j] ? row[j - 1] + 1 : row[j] + 1;
            row[j] = replace < best ? replace : best;
        }
    }
    return row[m];
}

const char *qc_closest_name(const char *name, const char *const *names, size_t n) {
    const char *best = NULL;
    size_t best_distance = 2 + strlen(name) / 2;
    for (size_t i = 0; i < n; i++) {
        /* A missing prefix ("hodge" for "qc.hodge") is nearer than its length. */
        const char *tail = strrchr(names[i], '.');
        if (!*names[i]) continue;
        size_t d = edit_distance(name, names[i]);
        const size_t e = tail ? edit_distance(name, tail + 1) : SIZE_MAX;
        if (e < d) d = e;
        if (d < best_distance) {
            best_distance = d;
            best = names[i];
        }
    }
    return best;
}

/* The locale's decimal separator, of any length; "." almost always. */
static const char *decimal_point(void) {
    const char *point = localeconv()->decimal_point;
    return point && *point ? point : ".";
}

double qc__parse_double(const char *text, char **end) {
    const char *point = decimal_point();
    if (strcmp(point, ".") == 0) return strtod(text, end);
    char buffer[128];
    const size_t length = strspn(text, "+-0123456789.eE"), extra = strlen(point);
    const char *dot = memchr(text, '.', length);
    if (!dot || length + extra >= sizeof buffer) return strtod(text, end);
    const size_t before = (size_t)(dot - text);
    memcpy(buffer, text, before);
    memcpy(buffer + before, point, extra);
    memcpy(buffer + before + extra, dot + 1, length - before - 1);
    buffer[length - 1 + extra] = '\0';
    char *stop;
    const double value = strtod(buffer, &stop);
    size_t used = (size_t)(stop - buffer);
    if (used > before) used -= extra - 1;
    if (end) *end = (char *)(uintptr_t)(text + used);
    return value;
}

int qc__print_double(char *buffer, size_t size, double value) {
    char text[64]; /* sign, 17 digits, exponent and a separator of any locale */
    int length = 0;
    for (int digits = 15; digits <= 17; digits++) {
        length = snprintf(text, sizeof text, "%.*g", digits, value);
        if (digits == 17 || strtod(text, NULL) == value) break;
    }
    const char *point = decimal_point();
    if (strcmp(point, ".") != 0) {
        char *p = strstr(text, point);
        if (p) {
            const size_t extra = strlen(point);
            *p = '.';
            memmove(p + 1, p + extra, strlen(p + extra) + 1);
            length -= (int)extra - 1;
        }
    }
    if (size == 0) return length;
    const size_t kept = (size_t)length < size ? (size_t)length : size - 1;
    memcpy(buffer, text, kept);
    buffer[kept] = '\0';
    return length;
}
