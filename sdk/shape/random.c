/* splitmix64 (Steele, Lea, Flood 2014): small, and the same everywhere. */
#include "sdk/shape/internal.h"

static uint64_t next(qc__random *r) {
    uint64_t x = r->state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

double qc__random_unit(qc__random *r) {
    return (double)(next(r) >> 11) * 0x1p-53;
}

/* Box and Muller 1958. */
double qc__random_normal(qc__random *r) {
    double radius = sqrt(-2 * log(1 - qc__random_unit(r)));
    return radius * cos(2 * QC__PI * qc__random_unit(r));
}

int32_t qc__random_below(qc__random *r, int32_t n) {
    return (int32_t)(((next(r) >> 32) * (uint64_t)n) >> 32);
}
