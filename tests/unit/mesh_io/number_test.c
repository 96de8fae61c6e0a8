/* Numbers are exactly rounded: the fast path agrees with strtod bit by bit. */
#include "unit/mesh_io/common.h"

#include <math.h>
#include <stdio.h>

#include "sdk/mesh/io/internal.h"

static double take(const char *text) {
    qc__text t = {.p = text, .begin = text, .end = text + strlen(text), .line = 1};
    double value = -999;
    assert_true(qc__take_double(&t, &value));
    assert_ptr_equal(t.p, t.end);
    return value;
}

static void same_as_strtod(const char *text) {
    double a = take(text), b = strtod(text, NULL);
    if (memcmp(&a, &b, sizeof a)) print_error("%s: %a instead of %a\n", text, a, b);
    assert_memory_equal(&a, &b, sizeof a);
}

static void test_notations(void **state) {
    (void)state;
    const char *const texts[] = {"0",
                                 "-0",
                                 "+1",
                                 "1.",
                                 ".5",
                                 "-.5e3",
                                 "1e5",
                                 "1E+5",
                                 "1e-5",
                                 "123456789012345678901234567890",
                                 "0.000000000000000000000000000000000001",
                                 "1e22",
                                 "1e23",
                                 "1e-22",
                                 "1e-23",
                                 "9007199254740993",
                                 "9007199254740992.5",
                                 "0.35444599999999998",
                                 "-2.2250738585072011e-308",
                                 "1e308",
                                 "4.9e-324",
                                 "0.1234567890123456789",
                                 "00000000000000000000000000001.5",
                                 "1e-400",
                                 "0e999999999999999999",
                                 "179769313486231570000000000000000000000",
                                 "0.500000000000000166533453693773481063544750213623046875"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) same_as_strtod(texts[i]);
}

static void test_refused(void **state) {
    (void)state;
    const char *const texts[] = {"",    "-",     ".",   "e5",  "1e",    "1e+", "0x10",
                                 "1,5", "1.5.2", "abc", "--1", "1_000", "+-1", "."};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        qc__text t = {.p = texts[i], .begin = texts[i], .end = texts[i] + strlen(texts[i])};
        double value;
        assert_false(qc__take_double(&t, &value));
        assert_ptr_equal(t.p, texts[i]);
    }
}

static uint64_t random_bits(uint64_t *s) {
    *s ^= *s << 13;
    *s ^= *s >> 7;
    return *s ^= *s << 17;
}

/* Random numbers of 1 to 19 digits, and doubles printed with 15 to 19 digits. */
static void test_random(void **state) {
    (void)state;
    uint64_t seed = 12345;
    char text[64];
    for (int i = 0; i < 100000; i++) {
        uint64_t r = random_bits(&seed);
        int digits = 15 + (int)(random_bits(&seed) % 5), e = (int)(random_bits(&seed) % 12) - 8;
        double x = ((double)(int64_t)r / 9.2e18) * pow(10, e);
        snprintf(text, sizeof text, i % 2 ? "%.*g" : "%.*f", digits, x);
        same_as_strtod(text);
        snprintf(text, sizeof text, "%llu.%03u", (unsigned long long)(r >> (r & 63)),
                 (unsigned)(r % 1000));
        same_as_strtod(text);
    }
}

/* Digits next to the middle between two doubles: the correction must not decide these. */
static void test_near_ties(void **state) {
    (void)state;
    uint64_t seed = 777;
    char text[128];
    for (int i = 0; i < 20000; i++) {
        double x = 1 + (double)(random_bits(&seed) >> 12) * 0x1p-52;
        double middle_lo = x, middle_hi = 0x1p-53; /* x + 2^-53 exactly, as 19 digits and as 17 */
        long double middle = (long double)middle_lo + (long double)middle_hi;
        snprintf(text, sizeof text, "%.18Lf", middle);
        same_as_strtod(text);
        snprintf(text, sizeof text, "%.16Lf", middle);
        same_as_strtod(text);
    }
}

/* Written numbers read back the same and are those of qc__print_double. */
static void test_printed(void **state) {
    (void)state;
    uint64_t seed = 99;
    char a[64], b[64];
    int different = 0;
    const double some[] = {0,
                           -0.0,
                           1,
                           -1,
                           0.1,
                           1.0 / 3,
                           1e15,
                           1e-4,
                           9.9999999999999995e-5,
                           0.5,
                           100,
                           1e14,
                           999999999999999.9,
                           123456,
                           0.30000000000000004,
                           1e22,
                           1e-300,
                           0x1p-1074,
                           0.99999999999999989,
                           1.0000000000000002};
    for (int i = 0; i < 60000; i++) {
        double x = ((double)(int64_t)random_bits(&seed) / 9.2e18) *
                   pow(10, (double)(random_bits(&seed) % 24) - 7);
        if (i % 3 == 0) x = (double)(float)x;
        if (i % 3 == 1) x = round(x * 1e6) / 1e6;
        if (i < 20) x = some[i];
        a[qc__put_number(a, x)] = 0;
        qc__print_double(b, sizeof b, x);
        double back = strtod(a, NULL);
        assert_memory_equal(&back, &x, sizeof x);

        different += strcmp(a, b) != 0;
        if (i < 20) assert_string_equal(a, b);
    }
    assert_int_equal(different, 0);
}

static void test_integers(void **state) {
    (void)state;
    const char *good[] = {"0", "-12", "+7", "123456789012345678901234567890"};
    int64_t value = 0;
    for (size_t i = 0; i < 4; i++) {
        qc__text t = {.p = good[i], .begin = good[i], .end = good[i] + strlen(good[i])};
        assert_true(qc__take_int(&t, &value));
    }
    assert_true(value > INT32_MAX); /* saturated, not wrapped */
    const char *bad[] = {"", "-", "1.5", "3x", "x"};
    for (size_t i = 0; i < 5; i++) {
        qc__text t = {.p = bad[i], .begin = bad[i], .end = bad[i] + strlen(bad[i])};
        assert_false(qc__take_int(&t, &value));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_notations), cmocka_unit_test(test_refused),
        cmocka_unit_test(test_random),    cmocka_unit_test(test_near_ties),
        cmocka_unit_test(test_integers),  cmocka_unit_test(test_printed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
