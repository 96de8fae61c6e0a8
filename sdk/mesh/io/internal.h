/* Shared by the mesh readers: a bounded cursor over text and a growing polygon mesh.
 *
 * Every reader works from memory, never trusts a count of a header for an allocation, and reports
 * errors as "name:line: reason; way out" (text) or "name: byte b: ..." (binary). */
#ifndef QC_MESH_IO_INTERNAL_H
#define QC_MESH_IO_INTERNAL_H

#include <qc/mesh.h>

#include "sdk/base/internal.h"

/* --- text cursor ------------------------------------------------------------------------------ */

typedef struct qc__text {
    qc_ctx *ctx;
    const char *name; /* for messages */
    const char *begin, *p, *end;
    int64_t line;   /* 1-based line of p */
    bool continued; /* a backslash before the end of a line joins it with the next (OBJ) */
} qc__text;

/* Fails with INPUT, where = line, text = "name:line: ...". */
qc_status qc__text_fail(qc__text *t, int64_t line, const char *format, ...) QC__PRINTF(3, 4);
/* Fails with INPUT, where = byte, text = "name: byte b: ...". */
qc_status qc__byte_fail(qc__text *t, const char *at, const char *format, ...) QC__PRINTF(3, 4);
/* Fails with CANCELLED when the user asked to stop; call once in some thousand lines. */
bool qc__text_progress(qc__text *t);

void qc__skip_blanks(qc__text *t); /* spaces and tabs, joined lines; stays on the line */
void qc__skip_line(qc__text *t);   /* to the begin of the next line */
void qc__skip_space(qc__text *t);  /* blanks, ends of lines and # comments */
bool qc__at_line_end(const qc__text *t);
/* Length of the word at the cursor (up to a blank or the end of the line); does not advance. */
size_t qc__word_length(const qc__text *t);
/* True when the word at the cursor is `word`, ignoring case; then advances behind it. */
bool qc__take_word(qc__text *t, const char *word);
/* A printable copy of the word at the cursor, shortened, for messages. */
#define QC__EXCERPT 32
const char *qc__excerpt(const qc__text *t, char buffer[QC__EXCERPT]);

/* Reads a number which ends at a blank, the end of the line or '/'. Exactly rounded, locale
 * independent. False: not a number, cursor unmoved. "nan" and "inf" are numbers here. */
bool qc__take_double(qc__text *t, double *out);
bool qc__take_int(qc__text *t, int64_t *out);
/* w 10^e, exactly rounded; false when that is not known without more effort (w < 10^19). */
bool qc__decimal(uint64_t w, int64_t e, double *out);
/* Writes the shortest number which reads back the same (as qc__print_double); returns its length.
 */
size_t qc__put_number(char *out, double value);

static inline bool qc__is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
static inline bool qc__is_end(char c) {
    return c == '\n' || c == '\r';
}

/* Reads exactly three finite numbers from the rest of the line, or fails naming the vertex. */
qc_status qc__take_point(qc__text *t, const char *what, int64_t number, double xyz[3]);

/* --- growing polygon mesh --------------------------------------------------------------------- */

typedef struct qc__soup_attribute {
    const char *name; /* in the file, not terminated */
    size_t length;
    int32_t at, kind, width;
    double *value; /* as far as elements have one */
    int64_t n, capacity;
} qc__soup_attribute;

typedef struct qc__soup {
    qc_ctx *ctx;
    double *position, *uv;
    int32_t *corner_vertex, *corner_uv, *line;    /* corner_uv only when has_corner_uv */
    int32_t *face_begin, *face_line, *face_group; /* first corner; line or element; group */
    int64_t n_position, n_uv, n_corner, n_corner_uv, n_line, n_face; /* in array entries */
    int64_t c_position, c_uv, c_corner, c_corner_uv, c_line, c_face_begin, c_face_line,
        c_face_group;
    double *normal;         /* OBJ vn, and what the corners refer to, -1 = none */
    int32_t *corner_normal; /* as far as corners have one */
    int64_t n_normal, n_corner_normal, c_normal, c_corner_normal;
    qc__soup_attribute *attribute;
    int64_t n_attribute, c_attribute;
    bool uv_by_corner; /* every corner has a uv of its own: equal ones at a vertex are to be one */
    char *group_name;  /* texts one after the other, each with its NUL, of groups 1, 2, ... */
    int64_t n_group_name, c_group_name;
    int32_t n_groups;
    char *materials; /* or NULL */
    bool has_groups;
    bool binary; /* face_line holds element numbers, not lines */
} qc__soup;

void qc__soup_free(qc__soup *s);
bool qc__soup_vertex(qc__soup *s, const double xyz[3]);
bool qc__soup_normal(qc__soup *s, const double xyz[3]);
/* An attribute: the number of the one with this name and place, or of a new one; *index = -1 when
 * it has another width. name is borrowed. */
bool qc__soup_attribute_add(qc__soup *s, const char *name, size_t length, int32_t at, int32_t kind,
                            int32_t width, int32_t *index);
/* Its value at the last vertex, face or corner; 0 at earlier ones without a value. */
bool qc__soup_set(qc__soup *s, int32_t index, const double *x);
/* The text of the next group. */
bool qc__soup_group(qc__soup *s, const char *text, size_t n);
bool qc__soup_group_more(qc__soup *s, const char *text, size_t n); /* a line more of the last one */
qc_status qc__soup_materials(qc__soup *s, const char *text, size_t n); /* the first one counts */
bool qc__soup_uv(qc__soup *s, double u, double v);
/* A face is opened, then gets corners. vertex and uv are 0-based, uv = -1: none. */
bool qc__soup_face(qc__soup *s, int64_t line, int32_t group);
bool qc__soup_corner(qc__soup *s, int64_t vertex, int64_t uv);
bool qc__soup_corner_normal(qc__soup *s, int64_t normal); /* of the last corner */
bool qc__soup_line(qc__soup *s, int64_t a, int64_t b);
/* Checks indices and counts and makes the mesh; t is for messages. */
qc_status qc__soup_finish(qc__soup *s, qc__text *t, qc_polygon_mesh **out);

/* --- formats ---------------------------------------------------------------------------------- */

qc_status qc__read_obj(qc__text *t, qc__soup *s);
qc_status qc__read_off(qc__text *t, qc__soup *s);
qc_status qc__read_ply(qc__text *t, qc__soup *s);
qc_status qc__read_stl_ascii(qc__text *t, qc__soup *s);
qc_status qc__read_stl_binary(qc__text *t, qc__soup *s);
bool qc__is_stl_binary(const char *data, size_t size); /* 84 + 50 n bytes */
bool qc__is_off(const qc__text *t);
bool qc__ends_in(const char *name, const char *extension); /* ".ply", in any case */

#endif
