/* Edge lengths from a text file (see size_file.h). */
#include "size_file.h"

#include <ctype.h>
#include <string.h>

/* A length along a direction, a length across, the direction. */
enum { DIRECTED = 5 };

typedef struct number {
    double x;
    int64_t line;
} number;

typedef struct table {
    const char *path;
    number *number;
    int64_t n;
    int columns;    /* 1 or DIRECTED */
    bool of_faces;  /* a row for each face, not for each vertex */
    int32_t n_rows; /* of the input */
    double *value;  /* n_rows: the length, of two their geometric mean */
} table;

/* --- the text --------------------------------------------------------------------------------- */

/* Names the word at the start of the text. */
static qc_status not_positive(qc_ctx *ctx, const char *path, int64_t line, const char *text) {
    const int n = (int)strcspn(text, " \t\r\n,#");
    return qc__fail(ctx, QC_ERR_INPUT, line,
                    "%s:%lld: '%.*s' is not a positive number; a length for each vertex or face "
                    "is needed",
                    path, (long long)line, n < 40 ? n : 40, text);
}

/* All numbers; # begins a comment. */
static qc_status parse(qc_ctx *ctx, char *text, table *out) {
    int64_t line = 1, capacity = 0;
    for (char *p = text; *p;) {
        if (*p == '\n') line++;
        if (isspace((unsigned char)*p) || *p == ',') {
            p++;
        } else if (*p == '#') {
            p += strcspn(p, "\n");
        } else {
            char *end;
            const double x = qc__parse_double(p, &end);
            if (end == p || !isfinite(x)) return not_positive(ctx, out->path, line, p);
            if (!qc__reserve(ctx, (void **)&out->number, &capacity, out->n + 1, sizeof(number)))
                return QC_ERR_NOMEM;
            out->number[out->n++] = (number){x, line};
            p = end;
        }
    }
    return QC_OK;
}

/* Whether the numbers are so many for each vertex, or for each face. */
static bool fits(table *f, int columns, int32_t n_vertices, int32_t n_faces) {
    f->columns = columns;
    f->of_faces = f->n != columns * (int64_t)n_vertices;
    f->n_rows = f->of_faces ? n_faces : n_vertices;
    return f->n == columns * (int64_t)f->n_rows;
}

static qc_status check_lengths(qc_ctx *ctx, const table *f) {
    for (int64_t i = 0; i < f->n; i++) {
        char text[40];
        if (i % f->columns > 1 || f->number[i].x > 0) continue;
        qc__print_double(text, sizeof text, f->number[i].x);
        return not_positive(ctx, f->path, f->number[i].line, text);
    }
    for (int64_t i = 2; f->columns == DIRECTED && i < f->n; i += DIRECTED)
        if (f->number[i].x == 0 && f->number[i + 1].x == 0 && f->number[i + 2].x == 0)
            return qc__fail(ctx, QC_ERR_INPUT, f->number[i].line,
                            "%s:%lld: the direction of the first length is zero", f->path,
                            (long long)f->number[i].line);
    return QC_OK;
}

static qc_status check(qc_ctx *ctx, table *f, int32_t n_vertices, int32_t n_faces) {
    const bool good = fits(f, 1, n_vertices, n_faces) || fits(f, DIRECTED, n_vertices, n_faces);
    if (!good) f->columns = 1;
    const qc_status status = check_lengths(ctx, f);
    if (status != QC_OK || good) return status;
    return qc__fail(ctx, QC_ERR_INPUT, f->n,
                    "%s: %lld lengths for a mesh of %d vertices and %d faces; give one for "
                    "each vertex or for each face, or five numbers: a length along a direction, "
                    "that across, the direction",
                    f->path, (long long)f->n, (int)n_vertices, (int)n_faces);
}

/* --- on the faces of the mesh ----------------------------------------------------------------- */

static int32_t input_vertex(const qc_mesh *mesh, int32_t t, int k) {
    const int32_t v = mesh->face_vertex[3 * (int64_t)t + k];
    return mesh->source_vertex ? mesh->source_vertex[v] : v;
}

double qc__corner_mean(const qc_mesh *mesh, int32_t t, const double *value, int64_t n) {
    double sum = 0;
    int found = 0;
    for (int k = 0; k < 3; k++) {
        const int32_t i = input_vertex(mesh, t, k);
        if (i < 0 || i >= n) continue;
        sum += value[i];
        found++;
    }
    return found ? sum / found : -1;
}

/* 1/2 log(a/b) d^2 of a row, d the direction of its projection into the face with the given axes; 0
 * where that is a point. */
static qc__cplx row_stretch(const table *f, int32_t row, const double *real, const double *imag) {
    const number *a = f->number + DIRECTED * (int64_t)row;
    const double d[3] = {a[2].x, a[3].x, a[4].x}, size = qc__norm3(d);
    const qc__cplx z = qc__dot3(d, real) / size + I * (qc__dot3(d, imag) / size);
    if (!(cabs(z) > 1e-6)) return 0;
    return 0.5 * log(a[0].x / a[1].x) * qc__unit(z) * qc__unit(z);
}

/* The stretch of face t: that of its row, or the mean of those of its corners. */
static qc__cplx face_stretch(const table *f, const qc_mesh *mesh, int32_t t, const double *real,
                             const double *imag) {
    if (f->of_faces)
        return row_stretch(f, mesh->source_face ? mesh->source_face[t] : t, real, imag);
    qc__cplx sum = 0;
    int found = 0;
    for (int k = 0; k < 3; k++) {
        const int32_t i = input_vertex(mesh, t, k);
        if (i < 0 || i >= f->n_rows) continue;
        sum += row_stretch(f, i, real, imag);
        found++;
    }
    return found ? sum / found : 0;
}

static qc_status fill_lengths(qc_ctx *ctx, const qc_mesh *mesh, table *f, double *length) {
    f->value = QC__NEW(ctx, double, f->n_rows);
    if (!f->value) return QC_ERR_NOMEM;
    for (int64_t i = 0; i < f->n_rows; i++) {
        const number *a = f->number + f->columns * i;
        f->value[i] = f->columns == 1 ? a[0].x : sqrt(a[0].x) * sqrt(a[1].x);
    }
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        const int32_t s = mesh->source_face ? mesh->source_face[t] : t;
        const double x = !f->of_faces ? qc__corner_mean(mesh, t, f->value, f->n_rows)
                         : s >= 0     ? f->value[s]
                                      : -1;
        if (x > 0) length[t] = x;
    }
    return QC_OK;
}

static qc_status fill_stretch(qc_ctx *ctx, const qc_mesh *mesh, const table *f,
                              qc_complex *stretch) {
    const size_t n = 3 * (size_t)mesh->n_faces;
    double *axes = QC__NEW(ctx, double, 2 * n);
    const qc_status status = axes ? qc_tangent_frames(ctx, mesh, axes, axes + n) : QC_ERR_NOMEM;
    for (int32_t t = 0; status == QC_OK && t < mesh->n_faces; t++) {
        const size_t at = 3 * (size_t)t;
        if (f->of_faces && mesh->source_face && mesh->source_face[t] < 0) continue;
        stretch[t] = qc__z(face_stretch(f, mesh, t, axes + at, axes + n + at));
    }
    qc__free(axes);
    return status;
}

qc_status qc__size_file(qc_ctx *ctx, const qc_mesh *mesh, const qc_size_options *o, double *length,
                        qc_complex *stretch, bool *directed) {
    table f = {.path = o->path};
    char *text = NULL;
    size_t size;
    qc_status status = qc__read_file(ctx, o->path, &text, &size);
    if (status == QC_OK) status = parse(ctx, text, &f);
    if (status == QC_OK)
        status = check(ctx, &f, o->input ? o->input->n_vertices : mesh->n_vertices,
                       o->input ? o->input->n_faces : mesh->n_faces);
    if (status == QC_OK) status = fill_lengths(ctx, mesh, &f, length);
    if (status == QC_OK && f.columns == DIRECTED) {
        status = fill_stretch(ctx, mesh, &f, stretch);
        *directed = true;
    }
    qc__free(text);
    qc__free(f.number);
    qc__free(f.value);
    return status;
}
