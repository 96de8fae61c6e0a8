/* OFF of geomview: [ST][C][N]OFF with the counts on the first line or the next, comments anywhere,
 * colours behind vertices and faces ignored. Binary and higher-dimensional files are refused. */
#include "internal.h"

#include <string.h>

/* Splits a word like "STCNOFF" into its prefix; false when the word is no OFF header. */
static bool off_header(const qc__text *t, size_t *prefix) {
    size_t n = qc__word_length(t);
    if (n < 3 || n > 9 || memcmp(t->p + n - 3, "OFF", 3) != 0) return false;
    for (size_t i = 0; i + 3 < n; i++)
        if (!strchr("STCN4n", t->p[i])) return false;
    *prefix = n - 3;
    return true;
}

bool qc__is_off(const qc__text *t) {
    qc__text copy = *t;
    size_t prefix;
    qc__skip_space(&copy);
    return off_header(&copy, &prefix);
}

static qc_status read_header(qc__text *t) {
    size_t prefix;
    qc__skip_space(t);
    if (!off_header(t, &prefix)) return QC_OK; /* the header word is optional */
    for (size_t i = 0; i < prefix; i++)
        if (t->p[i] == '4' || t->p[i] == 'n')
            return qc__text_fail(t, t->line,
                                 "OFF with more than 3 coordinates is not supported; "
                                 "export a plain OFF file");
    t->p += prefix + 3;
    qc__skip_blanks(t);
    if (qc__take_word(t, "BINARY"))
        return qc__text_fail(t, t->line,
                             "binary OFF is not supported; save it as ASCII OFF, or as "
                             "PLY");
    return QC_OK;
}

static qc_status read_count(qc__text *t, const char *what, int64_t *out) {
    char excerpt[QC__EXCERPT];
    qc__skip_space(t);
    if (!qc__take_int(t, out))
        return qc__text_fail(t, t->line,
                             "the number of %s is expected instead of '%s'; the header "
                             "is damaged, export the file again",
                             what, qc__excerpt(t, excerpt));
    /* the shortest vertex is "0 0 0\n", the shortest face "3 0 1 2\n" */
    if (*out < 0 || *out > (t->end - t->p) / 5 + 1)
        return qc__text_fail(t, t->line,
                             "the header promises %lld %s but the file has only %lld "
                             "bytes; it is cut off or damaged, export it again",
                             (long long)*out, what, (long long)(t->end - t->begin));
    return QC_OK;
}

static qc_status read_face(qc__text *t, qc__soup *s, int64_t face, int64_t n_vertices) {
    char excerpt[QC__EXCERPT];
    int64_t n, v;
    if (!qc__take_int(t, &n))
        return qc__text_fail(t, t->line,
                             "the number of corners of face %lld is expected instead of "
                             "'%s'; the file is damaged, export it again",
                             (long long)face, qc__excerpt(t, excerpt));
    if (n < 3)
        return qc__text_fail(t, t->line,
                             "face %lld has %lld corners, at least 3 are needed; remove "
                             "that face",
                             (long long)face, (long long)n);
    if (!qc__soup_face(s, t->line, 0)) return QC_ERR_NOMEM;
    for (int64_t k = 0; k < n; k++) {
        qc__skip_space(t);
        if (!qc__take_int(t, &v))
            return qc__text_fail(t, t->line,
                                 "corner %lld of %lld of face %lld is no vertex index: "
                                 "'%s'; the file is cut off or damaged, export it again",
                                 (long long)k + 1, (long long)n, (long long)face,
                                 qc__excerpt(t, excerpt));
        if (v < 0 || v >= n_vertices)
            return qc__text_fail(t, t->line,
                                 "vertex index %lld is out of range (%lld vertices); the "
                                 "file is damaged, export it again",
                                 (long long)v, (long long)n_vertices);
        if (!qc__soup_corner(s, v, -1)) return QC_ERR_NOMEM;
    }
    return QC_OK;
}

static qc_status check_end(qc__text *t, const char *what, int64_t i, int64_t n) {
    qc__skip_space(t);
    if (t->p < t->end) return QC_OK;
    return qc__text_fail(t, t->line,
                         "the file ends before %s %lld of %lld; it is cut off, export it "
                         "again",
                         what, (long long)i, (long long)n);
}

/* The number of edges: on the line of the other counts, alone on the next, or missing. */
static void skip_edge_count(qc__text *t) {
    int64_t ignored;
    qc__skip_blanks(t);
    if (t->p < t->end && *t->p != '#' && !qc__is_end(*t->p)) {
        qc__skip_line(t);
        return;
    }
    qc__text copy = *t;
    qc__skip_space(&copy);
    bool alone = qc__take_int(&copy, &ignored);
    qc__skip_blanks(&copy);
    if (alone && qc__at_line_end(&copy)) *t = copy;
    qc__skip_line(t);
}

qc_status qc__read_off(qc__text *t, qc__soup *s) {
    int64_t n_vertices, n_faces;
    double xyz[3];
    qc_status status = read_header(t);
    if (status == QC_OK) status = read_count(t, "vertices", &n_vertices);
    if (status == QC_OK) status = read_count(t, "faces", &n_faces);
    if (status != QC_OK) return status;
    skip_edge_count(t);
    for (int64_t i = 0; i < n_vertices; i++) {
        status = check_end(t, "vertex", i, n_vertices);
        if (status == QC_OK) status = qc__take_point(t, "vertex", i, xyz);
        if (status == QC_OK && !qc__soup_vertex(s, xyz)) status = QC_ERR_NOMEM;
        if (status == QC_OK && i % 16384 == 0 && !qc__text_progress(t)) status = QC_ERR_CANCELLED;
        if (status != QC_OK) return status;
        qc__skip_line(t); /* normals, colours */
    }
    for (int64_t i = 0; i < n_faces; i++) {
        status = check_end(t, "face", i, n_faces);
        if (status == QC_OK) status = read_face(t, s, i, n_vertices);
        if (status == QC_OK && i % 16384 == 0 && !qc__text_progress(t)) status = QC_ERR_CANCELLED;
        if (status != QC_OK) return status;
        qc__skip_line(t); /* colours */
    }
    return QC_OK;
}
