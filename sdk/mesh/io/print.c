/* Numbers of written meshes: the shortest decimal which reads back the same.
 *
 * x 10^k with 17 digits before the point is an exact sum of two doubles (Dekker's product), hence
 * its nearest integer is known; 15, 16 or all 17 digits of it are taken, the first which
 * qc__decimal turns back into x. What is out of range goes to qc__print_double. */
#include "internal.h"

#include <math.h>
#include <string.h>

static const double POWER[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9, 1e10,
                               1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20};

/* (all + rest) / unit to the nearest integer, halves to even; |rest| <= 1/2. */
static uint64_t shorten(uint64_t all, double rest, uint64_t unit) {
    uint64_t w = all / unit, part = all % unit;
    bool half = 2 * part == unit;
    bool up = half ? rest > 0 || (rest == 0 && w % 2 == 1) : 2 * part > unit;
    return w + up;
}

/* Digits w and decimals k with w 10^-k == x, for 1e-4 <= x < 1e15. */
static bool digits_of(double x, uint64_t *w, int *k) {
    int e = 0; /* x < 10^e */
    if (x >= 1)
        while (x >= POWER[e]) e++;
    else
        while (x * POWER[-e] < 0.1) e--;
    int decimals = 17 - e;
    if (decimals > 20) return false;
    double hi = x * POWER[decimals], lo = fma(x, POWER[decimals], -hi);
    if (!(hi >= 1e15 && hi < 1e18)) return false;
    double step = rint(lo), rest = lo - step; /* x 10^decimals = all + rest */
    uint64_t all = step < 0 ? (uint64_t)hi - (uint64_t)-step : (uint64_t)hi + (uint64_t)step;
    static const uint64_t unit[] = {100, 10, 1};
    for (int i = 0; i < 3; i++) {
        double back;
        *w = shorten(all, rest, unit[i]);
        *k = decimals - 2 + i;
        if (qc__decimal(*w, -*k, &back) && back == x) return true;
    }
    return false;
}

size_t qc__put_number(char *out, double value) {
    double x = fabs(value);
    uint64_t w;
    int k;
    if (!(x >= 1e-4 && x < 1e15) || !digits_of(x, &w, &k)) {
        int n = qc__print_double(out, 32, value);
        return n > 0 ? (size_t)n : 0;
    }
    for (; k > 0 && w % 10 == 0; k--) w /= 10;
    char digits[32];
    size_t n = sizeof digits, length;
    for (int i = 0; i < k || w > 0 || i == k; i++) { /* at least one digit before the point */
        if (i == k && k > 0) digits[--n] = '.';
        digits[--n] = (char)('0' + w % 10);
        w /= 10;
    }
    length = sizeof digits - n;
    *out = '-';
    memcpy(out + (value < 0), digits + n, length);
    return length + (value < 0);
}
