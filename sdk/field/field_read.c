/* Reads cross fields: .rawfield (`N F`, then N vectors a face) and .rosy (F, N, then one vector a
 * face). */
#include "internal.h"

#include <string.h>

typedef struct scanner {
    qc_ctx *ctx;
    const char *path;
    char *text;   /* position */
    int64_t line; /* of the position, from 1 */
} scanner;

static void skip_space(scanner *s) {
    for (;; s->text++) {
        if (*s->text == '\n')
            s->line++;
        else if (*s->text == '#')
            s->text += strcspn(s->text, "\n") - 1;
        else if (*s->text != ' ' && *s->text != '\t' && *s->text != '\r')
            return;
    }
}

static qc_status next_number(scanner *s, double *out) {
    skip_space(s);
    char *end = s->text;
    double value = *s->text ? qc__parse_double(s->text, &end) : 0;
    if (*s->text == 0)
        return qc__fail(s->ctx, QC_ERR_INPUT, s->line,
                        "%s, line %lld: the file ends too early; is it truncated?", s->path,
                        (long long)s->line);
    if (end == s->text || !isfinite(value) || !strchr(" \t\r\n#", *end))
        return qc__fail(s->ctx, QC_ERR_INPUT, s->line, "%s, line %lld: '%.*s' is not a number",
                        s->path, (long long)s->line,
                        (int)(strcspn(s->text, " \t\r\n") < 24 ? strcspn(s->text, " \t\r\n") : 24),
                        s->text);
    s->text = end;
    *out = value;
    return QC_OK;
}

static qc_status next_count(scanner *s, int32_t *out) {
    double value;
    qc_status status = next_number(s, &value);
    if (status) return status;
    if (!(value >= 1 && value <= INT32_MAX && value == floor(value)))
        return qc__fail(
            s->ctx, QC_ERR_INPUT, s->line,
            "%s, line %lld: the counts `N F` (.rawfield) or F, N (.rosy) must come first", s->path,
            (long long)s->line);
    *out = (int32_t)value;
    return QC_OK;
}

typedef struct layout {
    int32_t degree, faces, vectors; /* N, F, vectors per face in the file */
} layout;

/* Number of faces in the file the mesh came from, as far as known; *exact: it is. */
static int32_t source_faces(const qc_mesh *mesh, bool *exact) {
    int32_t n = 0;
    *exact = !mesh->source_face;
    if (!mesh->source_face) return mesh->n_faces;
    for (int32_t t = 0; t < mesh->n_faces; t++)
        if (mesh->source_face[t] >= n) n = mesh->source_face[t] + 1;
    return n;
}

static bool is_degree(int32_t n) {
    return n == 1 || n == 2 || n == 4;
}

/* `N F` is a .rawfield and F, N a .rosy; where both would fit the mesh (four faces), a .rawfield
 * has them on one line. */
static qc_status read_header(scanner *s, const qc_mesh *mesh, layout *out) {
    int32_t a = 0, b = 0;
    qc_status status = next_count(s, &a);
    int64_t line = s->line;
    if (!status) status = next_count(s, &b);
    if (status) return status;
    bool exact;
    int32_t faces = source_faces(mesh, &exact);
    bool raw = is_degree(a) && (exact ? b == faces : b >= faces);
    bool rosy = is_degree(b) && (exact ? a == faces : a >= faces);
    if (raw == rosy) raw = raw ? s->line == line : a <= b;
    *out = raw ? (layout){a, b, a} : (layout){b, a, 1};
    if (!is_degree(out->degree))
        return qc__fail(s->ctx, QC_ERR_INPUT, line,
                        "%s, line %lld: N = %d directions a face; a cross field needs N = 4",
                        s->path, (long long)line, (int)out->degree);
    if (exact ? out->faces != faces : out->faces < faces)
        return qc__fail(
            s->ctx, QC_ERR_INPUT, line,
            "%s, line %lld: the field has %d faces but the mesh has %d; is it the field of "
            "another mesh?",
            s->path, (long long)line, (int)out->faces, (int)faces);
    return QC_OK;
}

/* All vectors, 3 * vectors * faces; line: faces, where each face begins. */
static qc_status read_vectors(scanner *s, const layout *l, double *vector, int64_t *line) {
    size_t per_face = 3 * (size_t)l->vectors;
    for (size_t t = 0; t < (size_t)l->faces; t++) {
        skip_space(s);
        line[t] = s->line;
        for (size_t i = 0; i < per_face; i++) {
            qc_status status = next_number(s, &vector[per_face * t + i]);
            if (status) return status;
        }
        if (t % 65536 == 0 && !qc__progress(s->ctx, (double)t / l->faces)) return QC_ERR_CANCELLED;
    }
    skip_space(s);
    if (*s->text)
        return qc__fail(s->ctx, QC_ERR_INPUT, s->line,
                        "%s, line %lld: more numbers than N F = %d x %d vectors", s->path,
                        (long long)s->line, (int)l->vectors, (int)l->faces);
    return QC_OK;
}

/* The cross nearest to n vectors in the plane (u, v): mean of the fourth powers of their
 * directions, the root which is closest to the first vector. 0 when the first vector has no part in
 * the plane. */
static qc__cplx nearest_cross(const double *vector, int32_t n, const double *u, const double *v) {
    qc__cplx first = 0, sum = 0;
    for (int32_t k = 0; k < n; k++) {
        const double *a = vector + 3 * k;
        double largest = fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
        if (!(largest > 0)) continue;
        double b[3] = {a[0] / largest, a[1] / largest, a[2] / largest};
        qc__cplx x = qc__dot3(b, u) + qc__dot3(b, v) * I;
        if (!(cabs(x) > 1e-6)) continue; /* perpendicular to the face */
        x = qc__unit(x);
        if (k == 0) first = x;
        sum += qc__fourth(x);
    }
    if (n < 4 || cabs(sum) < 1e-3) return first; /* no cross at all: trust the first vector */
    double turn = qc__arg(sum * conj(qc__fourth(first))) / 4;
    return first * (cos(turn) + sin(turn) * I);
}

static qc_status make_crosses(scanner *s, const qc_mesh *mesh, const layout *l,
                              const double *vector, const int64_t *line, qc_complex *x) {
    double *real = QC__NEW(s->ctx, double, 3 * (size_t)mesh->n_faces);
    double *imaginary = QC__NEW(s->ctx, double, 3 * (size_t)mesh->n_faces);
    qc_status status = real && imaginary ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc_tangent_frames(s->ctx, mesh, real, imaginary);
    for (size_t t = 0; !status && t < (size_t)mesh->n_faces; t++) {
        size_t source = mesh->source_face ? (size_t)mesh->source_face[t] : t;
        qc__cplx cross = nearest_cross(vector + 3 * (size_t)l->vectors * source, l->vectors,
                                       real + 3 * t, imaginary + 3 * t);
        x[t] = qc__z(cross);
        if (creal(cross) == 0 && cimag(cross) == 0)
            status =
                qc__fail(s->ctx, QC_ERR_INPUT, line[source],
                         "%s, line %lld: the vector of face %zu is zero or perpendicular to the "
                         "face",
                         s->path, (long long)line[source], source);
    }
    qc__free(real);
    qc__free(imaginary);
    return status;
}

static qc_status read_crosses(scanner *s, const qc_mesh *mesh, size_t size, qc_complex *x) {
    layout l;
    qc_status status = read_header(s, mesh, &l);
    if (status) return status;
    if ((size_t)l.faces > size / 2) /* each face takes more than two bytes: a count which lies */
        return qc__fail(s->ctx, QC_ERR_INPUT, 1, "%s, line 1: the file is too short for %d faces",
                        s->path, (int)l.faces);
    double *vector = QC__NEW(s->ctx, double, 3 * (size_t)l.vectors * (size_t)l.faces);
    int64_t *line = QC__NEW(s->ctx, int64_t, l.faces);
    status = vector && line ? read_vectors(s, &l, vector, line) : QC_ERR_NOMEM;
    if (!status) status = make_crosses(s, mesh, &l, vector, line, x);
    qc__free(vector);
    qc__free(line);
    return status;
}

qc_status qc_face_field_read(qc_ctx *ctx, const qc_mesh *mesh, const char *path,
                             qc_face_field **out) {
    char *data = NULL;
    size_t size = 0;
    qc_status status = qc__read_file(ctx, path, &data, &size);
    if (status) return status;
    scanner s = {ctx, path, data, 1};
    qc_complex *x = QC__NEW(ctx, qc_complex, mesh->n_faces);
    status = x ? read_crosses(&s, mesh, size, x) : QC_ERR_NOMEM;
    if (!status) status = qc_face_field_create(ctx, mesh, x, NULL, NULL, out);
    qc__free(x);
    qc__free(data);
    return status;
}
