/* Closest names; numbers as text that read back to the same bits, whatever the locale. */
#include "tests/unit/base/base_test.h"
#include <float.h>
#include <locale.h>
#include <math.h>

static void the_closest_name_is_found(void **state) {
    (void)state;
    static const char *const names[] = {"qc.field.smooth", "qc.hodge", "lambda", "alignment", "k"};
    static const char *const table[][2] = {{"lamda", "lambda"},       {"LAMBDA", NULL},
                                           {"hodge", "qc.hodge"},     {"smoth", "qc.field.smooth"},
                                           {"alinment", "alignment"}, {"zzzzzz", NULL},
                                           {"qc.hogde", "qc.hodge"}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const char *found = qc_closest_name(table[i][0], names, 5);
        if (table[i][1]) {
            assert_non_null(found);
            assert_string_equal(found, table[i][1]);
        } else {
            assert_null(found);
        }
    }
    assert_null(qc_closest_name("anything", names, 0));
    char longer[200];
    memset(longer, 'x', sizeof longer);
    longer[199] = '\0';
    assert_null(qc_closest_name(longer, names, 5));
}

static void check_round_trip(double value) {
    char text[64], *end;
    const int n = qc__print_double(text, sizeof text, value);
    assert_int_equal(n, strlen(text));
    assert_null(strchr(text, ','));
    assert_true(qc__parse_double(text, &end) == value);
    assert_int_equal(*end, '\0');
}

static void round_trips(void) {
    static const double some[] = {0,
                                  0.1,
                                  1.0 / 3,
                                  -2.5,
                                  1e300,
                                  DBL_MIN,
                                  DBL_MAX,
                                  DBL_TRUE_MIN,
                                  1e-7,
                                  123456789.125,
                                  1e15,
                                  1e16,
                                  12345678901234567.0,
                                  5e-324,
                                  INFINITY};
    uint64_t x = 88172645463325252u;
    for (size_t i = 0; i < sizeof some / sizeof *some; i++) check_round_trip(some[i]);
    for (int i = 0; i < 2000; i++) {
        x ^= x << 13, x ^= x >> 7, x ^= x << 17;
        double value;
        memcpy(&value, &x, sizeof value);
        if (isfinite(value)) check_round_trip(value);
    }
    char text[64], *end;
    qc__print_double(text, sizeof text, 0.1);
    assert_string_equal(text, "0.1");
    char narrow[5];
    assert_int_equal(qc__print_double(narrow, sizeof narrow, -0.125), 6);
    assert_string_equal(narrow, "-0.1");
    assert_int_equal(qc__print_double(NULL, 0, -0.125), 6);
    assert_true(qc__parse_double("1.5e3/7", &end) == 1500 && *end == '/');
    assert_true(qc__parse_double("-0.25 1", &end) == -0.25 && *end == ' ');
    assert_true(qc__parse_double("x", &end) == 0 && *end == 'x');
}

static void doubles_round_trip(void **state) {
    (void)state;
    round_trips();
}

/* A locale with a decimal comma: one of the machine's, else one compiled into a scratch folder. */
static bool use_decimal_comma(char *folder) {
    static const char *const locales[] = {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "nl_NL.UTF-8"};
    for (size_t i = 0; i < sizeof locales / sizeof *locales; i++)
        if (setlocale(LC_NUMERIC, locales[i])) return true;
    char command[200];
    if (!mkdtemp(folder)) return false;
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >/dev/null 2>&1",
             folder);
    setenv("LOCPATH", folder, 1);
    return system(command) == 0 && setlocale(LC_NUMERIC, "de_DE.UTF-8");
}

static void a_decimal_comma_changes_nothing(void **state) {
    (void)state;
    char folder[] = "/tmp/qc_locale_XXXXXX", command[64];
    const bool found = use_decimal_comma(folder);
    if (found) {
        assert_string_equal(localeconv()->decimal_point, ",");
        round_trips();
        setlocale(LC_NUMERIC, "C");
    }
    snprintf(command, sizeof command, "rm -rf %s", folder);
    assert_int_equal(system(command), 0);
    if (!found) skip();
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_closest_name_is_found),
        cmocka_unit_test(doubles_round_trip),
        cmocka_unit_test(a_decimal_comma_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
