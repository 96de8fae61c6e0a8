/* A buffer in front of the file a mesh is written to. */
#include "output.h"

#include <string.h>

void qc__flush(qc__output *o) {
    if (o->n && fwrite(o->buffer, 1, o->n, o->file) != o->n) o->failed = true;
    o->n = 0;
}

/* Room for one number or word. */
static void need(qc__output *o, size_t n) {
    if (o->n + n > sizeof o->buffer) qc__flush(o);
}

void qc__put_text(qc__output *o, const char *text, size_t n) {
    while (n > 0) {
        need(o, 1);
        size_t m = sizeof o->buffer - o->n < n ? sizeof o->buffer - o->n : n;
        memcpy(o->buffer + o->n, text, m);
        o->n += m;
        text += m;
        n -= m;
    }
}

void qc__put_char(qc__output *o, char c) {
    need(o, 1);
    o->buffer[o->n++] = c;
}

void qc__put_int(qc__output *o, int32_t i) {
    char digits[12];
    size_t n = sizeof digits;
    uint32_t u = (uint32_t)i;
    do digits[--n] = (char)('0' + u % 10);
    while (u /= 10);
    qc__put_text(o, digits + n, sizeof digits - n);
}

void qc__put_double(qc__output *o, double value) {
    need(o, 40);
    o->n += qc__put_number(o->buffer + o->n, value);
}

void qc__put_point(qc__output *o, const char *word, const double *x, int n) {
    qc__put_text(o, word, strlen(word));
    for (int k = 0; k < n; k++) {
        qc__put_char(o, ' ');
        qc__put_double(o, x[k]);
    }
    qc__put_char(o, '\n');
}

void qc__put_comment(qc__output *o, const char *prefix, const char *comment) {
    while (comment && *comment) {
        const size_t n = strcspn(comment, "\r\n");
        qc__put_text(o, prefix, strlen(prefix));
        qc__put_text(o, comment, n);
        qc__put_char(o, '\n');
        comment += n + (comment[n] != 0);
    }
}
