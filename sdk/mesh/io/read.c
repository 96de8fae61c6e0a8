/* Reading a polygon mesh: recognise the format by content, then by extension, and hand over. */
#include "internal.h"

#include <string.h>

typedef qc_status reader(qc__text *t, qc__soup *s);

bool qc__ends_in(const char *name, const char *extension) {
    size_t n = strlen(name), m = strlen(extension);
    if (n < m) return false;
    for (size_t i = 0; i < m; i++) {
        char c = name[n - m + i];
        if (c != extension[i] && !(c >= 'A' && c <= 'Z' && c - 'A' + 'a' == extension[i]))
            return false;
    }
    return true;
}

static bool is_ply(const qc__text *t) {
    return t->end - t->p >= 4 && memcmp(t->p, "ply", 3) == 0 && qc__is_end(t->p[3]);
}

/* "solid" and no zero byte near the begin, as in binary files which abuse the word as a title. */
static bool is_stl_ascii(const qc__text *t) {
    qc__text copy = *t;
    qc__skip_space(&copy);
    size_t n = (size_t)(copy.end - copy.p);
    return qc__take_word(&copy, "solid") && !memchr(t->p, 0, n < 512 ? n : 512);
}

static bool is_obj(const qc__text *t) {
    static const char *const statements[] = {"v", "vt", "vn", "vp",     "f",      "l", "p",
                                             "g", "o",  "s",  "mtllib", "usemtl", "mg"};
    qc__text copy = *t;
    qc__skip_space(&copy);
    for (size_t i = 0; i < sizeof statements / sizeof *statements; i++)
        if (qc__take_word(&copy, statements[i])) return true;
    return false;
}

static reader *recognise(const qc__text *t) {
    if (is_ply(t)) return qc__read_ply;
    if (qc__is_off(t)) return qc__read_off;
    if (qc__is_stl_binary(t->begin, (size_t)(t->end - t->begin))) return qc__read_stl_binary;
    if (is_stl_ascii(t)) return qc__read_stl_ascii;
    if (is_obj(t)) return qc__read_obj;
    if (qc__ends_in(t->name, ".obj")) return qc__read_obj;
    if (qc__ends_in(t->name, ".off")) return qc__read_off;
    if (qc__ends_in(t->name, ".stl")) return qc__read_stl_binary;
    return NULL;
}

static qc_status check_content(qc__text *t) {
    qc__text copy = *t;
    qc__skip_space(&copy);
    if (copy.p < copy.end || qc__is_stl_binary(t->begin, (size_t)(t->end - t->begin))) return QC_OK;
    return qc__text_fail(t, t->begin == t->end ? 1 : copy.line, "%s; choose a file with a mesh",
                         t->begin == t->end ? "the file is empty" : "the file holds only comments");
}

qc_status qc_polygon_mesh_parse(qc_ctx *ctx, const void *data, size_t size, const char *name,
                                qc_polygon_mesh **out) {
    const char *p = size ? data : "";
    qc__text t = {ctx, name ? name : "mesh", p, p, p + size, 1, false};
    if (size >= 3 && memcmp(p, "\xef\xbb\xbf", 3) == 0) t.p += 3; /* byte order mark */
    qc_status status = check_content(&t);
    if (status != QC_OK) return status;
    reader *read = recognise(&t);
    if (!read)
        return qc__fail(
            ctx, QC_ERR_INPUT, 1,
            "%s: the content is not recognised as OBJ, OFF, PLY or STL%s; convert it to "
            "one of these",
            t.name, qc__ends_in(t.name, ".ply") ? " (a PLY file begins with 'ply')" : "");
    qc__soup soup = {.ctx = ctx};
    status = read(&t, &soup);
    if (status == QC_OK) status = qc__soup_finish(&soup, &t, out);
    qc__soup_free(&soup);
    return status;
}

qc_status qc_polygon_mesh_read(qc_ctx *ctx, const char *path, qc_polygon_mesh **out) {
    char *data;
    size_t size;
    qc_status status = qc__read_file(ctx, path, &data, &size);
    if (status != QC_OK) return status;
    status = qc_polygon_mesh_parse(ctx, data, size,
                                   strcmp(path, "-") == 0 ? "standard input" : path, out);
    qc__free(data);
    return status;
}
