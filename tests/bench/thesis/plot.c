/* Curves over common axes as CSV and as SVG: panels side by side, one axis on the left and one on
 * the right. */
#include "tests/bench/thesis/thesis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of the picture, in its units; a curve gets at most THIN points. */
enum { WIDTH = 380, HEIGHT = 240, LEFT = 56, RIGHT = 56, TOP = 34, BOTTOM = 64, THIN = 250 };

typedef struct axes {
    double x, left, right; /* upper ends; the lower ones are 0 */
} axes;

void plot_add(plot_curve *c, double x, double y) {
    if (c->n == c->capacity) {
        c->capacity = 2 * c->capacity + 64;
        c->x = realloc(c->x, (size_t)c->capacity * sizeof *c->x);
        c->y = realloc(c->y, (size_t)c->capacity * sizeof *c->y);
        if (!c->x || !c->y) bench_die("no memory");
    }
    c->x[c->n] = x;
    c->y[c->n++] = y;
}

void plot_clear(plot *p) {
    for (int i = 0; i < p->n_panels; i++)
        for (int k = 0; k < p->panel[i].n_curves; k++) {
            free(p->panel[i].curve[k].x);
            free(p->panel[i].curve[k].y);
        }
    *p = (plot){0};
}

static axes find_axes(const plot *p) {
    axes a = {0, 0, 0};
    for (int i = 0; i < p->n_panels; i++)
        for (int k = 0; k < p->panel[i].n_curves; k++) {
            const plot_curve *c = &p->panel[i].curve[k];
            double *most = c->right ? &a.right : &a.left;
            for (int32_t j = 0; j < c->n; j++) {
                a.x = fmax(a.x, c->x[j]);
                *most = fmax(*most, c->y[j]);
            }
        }
    if (p->left_most > 0) a.left = p->left_most;
    if (p->right_most > 0) a.right = p->right_most;
    a.x = a.x > 0 ? a.x : 1;
    a.left = a.left > 0 ? 1.05 * a.left : 1;
    a.right = a.right > 0 ? 1.05 * a.right : 1;
    return a;
}

/* Whether point j is needed to see the curve: far enough from the last one, or an end. */
static bool keep(const plot_curve *c, const axes *a, int32_t j, double last) {
    return j == 0 || j + 1 == c->n || c->n <= THIN || c->x[j] - last >= a->x / THIN;
}

/* 1, 2 or 5 times a power of ten, about an eighth of the whole. */
static double tick(double whole) {
    const double power = pow(10, floor(log10(whole / 8))), part = whole / 8 / power;
    return power * (part > 5 ? 10 : part > 2 ? 5 : part > 1 ? 2 : 1);
}

static void line(FILE *f, double x1, double y1, double x2, double y2, const char *colour) {
    fprintf(f, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", x1, y1,
            x2, y2, colour);
}

static void text(FILE *f, double x, double y, const char *anchor, const char *colour,
                 const char *string) {
    fprintf(f, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" fill=\"%s\">%s</text>\n", x, y,
            anchor, colour, string);
}

static void frame(FILE *f, const plot *p, const axes *a) {
    char number[32];
    for (double x = 0; x <= a->x * 1.0001; x += tick(a->x)) {
        const double at = WIDTH * x / a->x;
        line(f, at, 0, at, HEIGHT, "#e6e6e6");
        snprintf(number, sizeof number, "%g", x);
        text(f, at, HEIGHT + 15, "middle", "#333", number);
    }
    for (int side = 0; side < 2; side++) {
        const double most = side ? a->right : a->left;
        if (!(side ? p->right_label : p->left_label)) continue;
        for (double y = 0; y <= most; y += tick(most)) {
            const double at = HEIGHT * (1 - y / most);
            if (!side) line(f, 0, at, WIDTH, at, "#e6e6e6");
            snprintf(number, sizeof number, "%g", y);
            text(f, side ? WIDTH + 6 : -6, at + 4, side ? "start" : "end", "#333", number);
        }
    }
    fprintf(f, "<rect width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#888\"/>\n", WIDTH, HEIGHT);
    text(f, 0.5 * WIDTH, HEIGHT + 30, "middle", "#333", p->x_label);
    if (p->left_label) text(f, 0, -6, "start", "#333", p->left_label);
    if (p->right_label) text(f, WIDTH, -6, "end", "#333", p->right_label);
}

static void draw_curve(FILE *f, const plot_curve *c, const axes *a) {
    const double most = c->right ? a->right : a->left;
    double last = 0;
    fprintf(f, "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\" points=\"", c->colour);
    for (int32_t j = 0; j < c->n; j++) {
        if (!keep(c, a, j, last)) continue;
        last = c->x[j];
        fprintf(f, "%.1f,%.1f ", WIDTH * c->x[j] / a->x, HEIGHT * (1 - fmin(c->y[j] / most, 1)));
    }
    fprintf(f, "\"/>\n");
    for (int32_t j = 0; c->dots && j < c->n; j++)
        fprintf(f, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.4\" fill=\"%s\"/>\n",
                WIDTH * c->x[j] / a->x, HEIGHT * (1 - fmin(c->y[j] / most, 1)), c->colour);
}

/* Names of the curves below the axis. */
static void legend(FILE *f, const plot_panel *panel) {
    const double step = (double)WIDTH / panel->n_curves;
    for (int k = 0; k < panel->n_curves; k++)
        text(f, (k + 0.5) * step, HEIGHT + 48, "middle", panel->curve[k].colour,
             panel->curve[k].name);
}

static void write_svg(const plot *p, const axes *a, FILE *f) {
    const int cell_x = LEFT + WIDTH + RIGHT, cell_y = TOP + HEIGHT + BOTTOM;
    const int rows = (p->n_panels + p->columns - 1) / p->columns;
    fprintf(f,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" "
            "font-family=\"sans-serif\" "
            "font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
            cell_x * p->columns, cell_y * rows);
    for (int i = 0; i < p->n_panels; i++) {
        const plot_panel *panel = &p->panel[i];
        fprintf(f, "<g transform=\"translate(%d %d)\">\n", LEFT + i % p->columns * cell_x,
                TOP + i / p->columns * cell_y);
        frame(f, p, a);
        text(f, 0.5 * WIDTH, -20, "middle", "#000", panel->title);
        for (int over = 0; over < 2; over++) /* repeated ones below the others */
            for (int k = 0; k < panel->n_curves; k++)
                if (panel->curve[k].repeated != over) draw_curve(f, &panel->curve[k], a);
        legend(f, panel);
        fprintf(f, "</g>\n");
    }
    fprintf(f, "</svg>\n");
}

static void write_csv(const plot *p, const axes *a, FILE *f) {
    fprintf(f, "panel,curve,x,y\n");
    for (int i = 0; i < p->n_panels; i++) {
        const char *title = p->panel[i].title;
        for (int k = 0; k < p->panel[i].n_curves; k++) {
            const plot_curve *c = &p->panel[i].curve[k];
            double last = 0;
            for (int32_t j = 0; j < c->n && !c->repeated; j++) {
                if (!keep(c, a, j, last)) continue;
                last = c->x[j];
                fprintf(f, "%.*s,\"%s\",%g,%.4g\n", (int)strcspn(title, " "), title, c->name,
                        c->x[j], c->y[j]);
            }
        }
    }
}

void plot_write(const plot *p, const char *folder, const char *name) {
    const axes a = find_axes(p);
    char path[4096];
    for (int kind = 0; kind < 2; kind++) {
        snprintf(path, sizeof path, "%s/%s.%s", folder, name, kind ? "csv" : "svg");
        FILE *f = fopen(path, "w");
        if (!f) bench_die("cannot write %s", path);
        if (kind)
            write_csv(p, &a, f);
        else
            write_svg(p, &a, f);
        if (fclose(f) != 0) bench_die("cannot write %s", path);
    }
}
