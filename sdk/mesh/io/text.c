/* A bounded cursor over the text of a mesh file: lines, blanks, words, and messages which name the
 * line. Lines end with LF, CR LF or CR. */
#include "internal.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

qc_status qc__text_fail(qc__text *t, int64_t line, const char *format, ...) {
    char text[400];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return qc__fail(t->ctx, QC_ERR_INPUT, line, "%s:%lld: %s", t->name, (long long)line, text);
}

qc_status qc__byte_fail(qc__text *t, const char *at, const char *format, ...) {
    char text[400];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return qc__fail(t->ctx, QC_ERR_INPUT, at - t->begin, "%s: byte %lld: %s", t->name,
                    (long long)(at - t->begin), text);
}

bool qc__text_progress(qc__text *t) {
    double size = (double)(t->end - t->begin);
    return qc__progress(t->ctx, size > 0 ? (double)(t->p - t->begin) / size : 1);
}

/* Length of the line end at p: 2 for CR LF, 1 for CR or LF, 0 elsewhere. */
static size_t end_length(const char *p, const char *end) {
    if (p == end) return 0;
    if (*p == '\r') return p + 1 < end && p[1] == '\n' ? 2 : 1;
    return *p == '\n';
}

void qc__skip_blanks(qc__text *t) {
    for (;;) {
        while (t->p < t->end && qc__is_blank(*t->p)) t->p++;
        if (!t->continued || t->p == t->end || *t->p != '\\') return;
        size_t n = end_length(t->p + 1, t->end);
        if (n == 0) return;
        t->p += 1 + n;
        t->line++;
    }
}

bool qc__at_line_end(const qc__text *t) {
    return t->p == t->end || qc__is_end(*t->p);
}

void qc__skip_line(qc__text *t) {
    for (;;) {
        while (t->p < t->end && !qc__is_end(*t->p)) t->p++;
        bool join = t->continued && t->p > t->begin && t->p[-1] == '\\';
        size_t n = end_length(t->p, t->end);
        t->p += n;
        t->line += n > 0;
        if (!join || n == 0) return;
    }
}

void qc__skip_space(qc__text *t) {
    for (;;) {
        qc__skip_blanks(t);
        if (t->p == t->end) return;
        if (*t->p != '#' && !qc__is_end(*t->p)) return;
        qc__skip_line(t);
    }
}

size_t qc__word_length(const qc__text *t) {
    const char *p = t->p;
    while (p < t->end && !qc__is_blank(*p) && !qc__is_end(*p)) p++;
    return (size_t)(p - t->p);
}

static char lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

bool qc__take_word(qc__text *t, const char *word) {
    size_t n = qc__word_length(t);
    if (n != strlen(word)) return false;
    for (size_t i = 0; i < n; i++)
        if (lower(t->p[i]) != lower(word[i])) return false;
    t->p += n;
    return true;
}

const char *qc__excerpt(const qc__text *t, char buffer[QC__EXCERPT]) {
    size_t n = qc__word_length(t), m = n < QC__EXCERPT - 4 ? n : QC__EXCERPT - 4;
    if (n == 0) return "the end of the line";
    for (size_t i = 0; i < m; i++) buffer[i] = t->p[i] > ' ' && t->p[i] < 127 ? t->p[i] : '?';
    memcpy(buffer + m, n > m ? "..." : "", n > m ? 4 : 1);
    return buffer;
}

qc_status qc__take_point(qc__text *t, const char *what, int64_t number, double xyz[3]) {
    char excerpt[QC__EXCERPT];
    for (int k = 0; k < 3; k++) {
        qc__skip_blanks(t);
        if (!qc__take_double(t, &xyz[k]))
            return qc__text_fail(t, t->line, "coordinate %d of %s %lld is not a number: '%s'; %s",
                                 k + 1, what, (long long)number, qc__excerpt(t, excerpt),
                                 "the file is damaged or cut off, export it again");
        if (!isfinite(xyz[k]))
            return qc__text_fail(t, t->line,
                                 "coordinate %d of %s %lld is not finite; remove that vertex or "
                                 "export the mesh again",
                                 k + 1, what, (long long)number);
    }
    return QC_OK;
}
