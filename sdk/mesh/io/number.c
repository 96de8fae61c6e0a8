/* Decimal numbers of mesh files, exactly rounded and fast.
 *
 * w 10^e with an integer w < 2^53 and |e| <= 22 is one exact operation away from the result
 * (Clinger 1990). Longer digit strings (the usual 17) are divided in two parts: q = w_hi / p, then
 * the exact remainder gives a correction c; q + c is the rounded result unless it lies so close to
 * a tie that the error of c matters (Ziv's test). Whatever is left goes to qc__parse_double. */
#include "internal.h"

#include <math.h>
#include <string.h>

static const double POWER[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                               1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                               1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* w / 10^k for 2^53 <= w < 10^19; false when rounding is in doubt. */
static bool divide_long(uint64_t w, int k, double *out) {
    double hi = (double)w, p = POWER[k];
    uint64_t h = (uint64_t)hi;
    double lo = w >= h ? (double)(w - h) : -(double)(h - w);
    double q = hi / p;
    double c = (fma(-q, p, hi) + lo) / p;
    double up = q + c * (1 + 0x1p-50), down = q + c * (1 - 0x1p-50);
    *out = up;
    return up == down;
}

bool qc__decimal(uint64_t w, int64_t e, double *out) {
    if (w == 0) {
        *out = 0;
        return true;
    }
    if (e < -22 || e > 22) return false;
    if (w < (UINT64_C(1) << 53)) {
        *out = e < 0 ? (double)w / POWER[-e] : (double)w * POWER[e];
        return true;
    }
    return e <= 0 && divide_long(w, (int)-e, out);
}

static bool ends_number(const char *p, const char *end) {
    return p == end || qc__is_blank(*p) || qc__is_end(*p) || *p == '/' || *p == '\\';
}

/* strtod on a copy of the token: the data need not end with a NUL. */
static bool take_slowly(qc__text *t, double *out) {
    char token[512], *stop;
    size_t n = 0;
    while (t->p + n < t->end && n < sizeof token - 1 && !ends_number(t->p + n, t->end)) {
        token[n] = t->p[n];
        n++;
    }
    token[n] = 0;
    if (n == 0 || token[0] == '_' || strpbrk(token, "xX(")) return false;
    double value = qc__parse_double(token, &stop);
    if (stop != token + n || !ends_number(t->p + n, t->end)) return false;
    t->p += n;
    *out = value;
    return true;
}

bool qc__take_double(qc__text *t, double *out) {
    const char *p = t->p, *end = t->end;
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) p++;
    uint64_t w = 0;
    int64_t digits = 0, significant = 0, e = 0;
    for (; p < end && (unsigned)(*p - '0') < 10; p++, digits++) {
        significant += significant > 0 || *p != '0';
        if (significant <= 19) w = 10 * w + (unsigned)(*p - '0');
    }
    if (p < end && *p == '.') {
        for (p++; p < end && (unsigned)(*p - '0') < 10; p++, digits++, e--) {
            significant += significant > 0 || *p != '0';
            if (significant <= 19) w = 10 * w + (unsigned)(*p - '0');
        }
    }
    if (digits > 0 && significant <= 19 && p < end && (*p == 'e' || *p == 'E')) {
        const char *q = p + 1;
        bool minus = q < end && *q == '-';
        if (q < end && (*q == '-' || *q == '+')) q++;
        int64_t x = 0;
        int n = 0;
        for (; q < end && (unsigned)(*q - '0') < 10; q++, n++)
            if (x < 100000) x = 10 * x + (*q - '0');
        if (n == 0) return false;
        e += minus ? -x : x;
        p = q;
    }
    double value;
    if (digits == 0 || significant > 19 || !ends_number(p, end) || !qc__decimal(w, e, &value))
        return take_slowly(t, out);
    t->p = p;
    *out = negative ? -value : value;
    return true;
}

bool qc__take_int(qc__text *t, int64_t *out) {
    const char *p = t->p;
    bool negative = p < t->end && *p == '-';
    if (p < t->end && (*p == '-' || *p == '+')) p++;
    int64_t value = 0;
    const char *first = p;
    for (; p < t->end && (unsigned)(*p - '0') < 10; p++)
        if (value < INT64_C(1000000000000000)) value = 10 * value + (*p - '0'); /* saturates */
    if (p == first || !ends_number(p, t->end)) return false;
    t->p = p;
    *out = negative ? -value : value;
    return true;
}
