/* Markdown tables of the numbers of the thesis beside ours. */
#include "tests/bench/thesis/thesis.h"

#include <math.h>
#include <stdio.h>

void thesis_head(const char *label, int n, const char *const *column) {
    printf("\n| %s |", label);
    for (int i = 0; i < n; i++) printf(" %s |", column[i]);
    printf("\n|---|");
    for (int i = 0; i < n; i++) printf("---:|");
    printf("\n");
}

/* Three digits, whole numbers in full. */
static void print_number(double value) {
    if (!isfinite(value))
        printf(" |");
    else if (fabs(value) >= 100 || value == floor(value))
        printf(" %.0f |", value);
    else
        printf(" %.*f |", fabs(value) >= 10 ? 1 : fabs(value) >= 1 ? 2 : 3, value);
}

void thesis_row(const char *label, int n, const double *value) {
    printf("| %s |", label);
    for (int i = 0; i < n; i++) print_number(value[i]);
    printf("\n");
}

void thesis_compare(const char *label, int n, const double *thesis, const double *ours) {
    printf("| %s: thesis |", label);
    for (int i = 0; i < n; i++) print_number(thesis[i]);
    printf("\n| ours |");
    for (int i = 0; i < n; i++) print_number(ours[i]);
    printf("\n| thesis / ours |");
    for (int i = 0; i < n; i++) print_number(ours[i] != 0 ? thesis[i] / ours[i] : NAN);
    printf("\n");
}
