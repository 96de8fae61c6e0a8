/* bench_thesis: the numbers of Kaelberer 2013, chapters 6 and 7, beside ours.
 *
 * A part computes one table or figure and prints a section of docs/results.md on stdout. A new part
 * is a function in a file of its own and a line in the list of main.c, with a pair of marks
 * <!-- begin NAME --> <!-- end NAME --> in the page. */
#ifndef QC_BENCH_THESIS_H
#define QC_BENCH_THESIS_H

#include <qc/optimize.h>

#include "tests/bench/common/common.h"

typedef struct thesis_run {
    qc_ctx *ctx;         /* one thread                                                           */
    bool quick;          /* a generated surface of 1000 faces and little work: the smoke test    */
    const char *figures; /* folder for CSV and SVG files; NULL = none are written                */
    /* Called wherever the library reports progress, unless NULL. */
    void (*watch)(void *user);
    void *watch_user;
} thesis_run;

/* Path of a mesh of the test data such as "bunny.off", kept for the whole run; NULL when quick. */
const char *thesis_mesh(const thesis_run *run, const char *name);

/* --- parts ------------------------------------------------------------------------------------ */

void thesis_evaluation(thesis_run *run); /* Table 6.1: time of an evaluation of E_D              */
void thesis_descent(thesis_run *run);    /* Figure 6.1: E_D and branch points over evaluations   */
void thesis_rounding(thesis_run *run);   /* 6.3.3: ways to round                                 */
void thesis_balance(thesis_run *run);    /* Figures 6.5, 6.6: E_D + E_H over branch points       */
void thesis_regularity(thesis_run *run); /* Table 7.1: regularity of the quads                   */

/* --- table.c: Markdown tables ----------------------------------------------------------------- */

/* First column is `label`. */
void thesis_head(const char *label, int n, const char *const *column);
/* Three digits; a number which is not finite leaves its cell empty. */
void thesis_row(const char *label, int n, const double *value);
/* Three rows: the number of the thesis, ours, and thesis / ours (above 1 ours is smaller). */
void thesis_compare(const char *label, int n, const double *thesis, const double *ours);

/* --- plot.c: curves as CSV and SVG ------------------------------------------------------------ */

enum { PLOT_CURVES = 6, PLOT_PANELS = 6 };
typedef struct plot_curve {
    const char *name, *colour; /* colour of SVG, as "#c22"                    */
    bool right;                /* measured on the right axis                  */
    bool dots;                 /* a dot at each value as well                 */
    bool repeated;             /* drawn for comparison, left out of the CSV   */
    int32_t n, capacity;
    double *x, *y;
} plot_curve;
typedef struct plot_panel {
    const char *title;
    int n_curves;
    plot_curve curve[PLOT_CURVES];
} plot_panel;
/* All panels have the same axes. */
typedef struct plot {
    const char *x_label, *left_label, *right_label;
    double left_most, right_most; /* upper ends of the axes; 0 = the largest value */
    int columns, n_panels;
    plot_panel panel[PLOT_PANELS];
} plot;
void plot_add(plot_curve *curve, double x, double y);
/* folder/name.csv (panel,curve,x,y; a panel by the first word of its title) and folder/name.svg,
 * long curves thinned. */
void plot_write(const plot *p, const char *folder, const char *name);
void plot_clear(plot *p);

/* --- periods.c, anneal.c ---------------------------------------------------------------------- */

/* The period matrix (thesis 6.3.2); n x n, free() it. */
double *thesis_period_matrix(qc_ctx *ctx, const qc_matching *matching, const qc_sizing *sizing,
                             int32_t *n);
/* Least energy which `runs` slow simulated annealings find in a reduced basis. */
double thesis_anneal(qc_ctx *ctx, int32_t n, const double *P, const double *t, int32_t runs,
                     int64_t sweeps);

#endif
