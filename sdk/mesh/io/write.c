/* Writing a polygon mesh as OBJ with shortest round-trip numbers, through one text buffer. */
#include "internal.h"

#include <math.h>
#include <string.h>

typedef struct output {
    FILE *file;
    size_t n;
    bool failed;
    char buffer[1 << 15];
} output;

static void flush(output *o) {
    if (o->n && fwrite(o->buffer, 1, o->n, o->file) != o->n) o->failed = true;
    o->n = 0;
}

/* Room for one number or word. */
static void need(output *o, size_t n) {
    if (o->n + n > sizeof o->buffer) flush(o);
}

static void put_text(output *o, const char *text, size_t n) {
    while (n > 0) {
        need(o, 1);
        size_t m = sizeof o->buffer - o->n < n ? sizeof o->buffer - o->n : n;
        memcpy(o->buffer + o->n, text, m);
        o->n += m;
        text += m;
        n -= m;
    }
}

static void put_char(output *o, char c) {
    need(o, 1);
    o->buffer[o->n++] = c;
}

static void put_int(output *o, int32_t i) {
    char digits[12];
    size_t n = sizeof digits;
    uint32_t u = (uint32_t)i;
    do digits[--n] = (char)('0' + u % 10);
    while (u /= 10);
    put_text(o, digits + n, sizeof digits - n);
}

static void put_double(output *o, double value) {
    need(o, 40);
    o->n += qc__put_number(o->buffer + o->n, value);
}

static void put_comment(output *o, const char *comment) {
    while (comment && *comment) {
        size_t n = strcspn(comment, "\r\n");
        put_text(o, "# ", 2);
        put_text(o, comment, n);
        put_char(o, '\n');
        comment += n + (comment[n] != 0);
    }
}

static void put_point(output *o, const char *word, const double *x, int n) {
    put_text(o, word, strlen(word));
    for (int k = 0; k < n; k++) {
        put_char(o, ' ');
        put_double(o, x[k]);
    }
    put_char(o, '\n');
}

static void put_face(output *o, const qc_polygon_mesh *m, int32_t f) {
    put_char(o, 'f');
    for (int32_t c = m->face_offset[f]; c < m->face_offset[f + 1]; c++) {
        put_char(o, ' ');
        put_int(o, m->face_vertex[c] + 1);
        if (!m->corner_uv || m->corner_uv[c] < 0) continue;
        put_char(o, '/');
        put_int(o, m->corner_uv[c] + 1);
    }
    put_char(o, '\n');
}

static void put_group(output *o, const qc_polygon_mesh *m, int32_t f) {
    if (!m->face_group || m->face_group[f] <= 0) return;
    if (f > 0 && m->face_group[f] == m->face_group[f - 1]) return;
    if (m->face_group[f] <= m->n_groups) {
        const char *name = m->group_name[m->face_group[f] - 1];
        put_text(o, name, strlen(name));
    } else {
        put_text(o, "g group", 7);
        put_int(o, m->face_group[f]);
    }
    put_char(o, '\n');
}

static void put_vertex(output *o, const qc_polygon_mesh *m, int64_t v) {
    double x[6];
    memcpy(x, m->position + 3 * v, 3 * sizeof *x);
    if (m->colour) memcpy(x + 3, m->colour + 3 * v, 3 * sizeof *x);
    put_point(o, "v", x, m->colour ? 6 : 3);
}

/* Vertices, texture coordinates, faces and lines are one sequence for progress and cancelling. */
static bool put_mesh(qc_ctx *ctx, output *o, const qc_polygon_mesh *m) {
    int64_t nv = m->n_vertices, nu = m->uv ? m->n_uvs : 0, nf = m->n_faces;
    int64_t n = nv + nu + nf + (m->line ? m->n_lines : 0);
    if (m->materials) {
        put_text(o, m->materials, strlen(m->materials));
        put_char(o, '\n');
    }
    for (int64_t i = 0; i < n && !o->failed; i++) {
        int64_t j = i - nv - nu;
        if (i < nv)
            put_vertex(o, m, i);
        else if (j < 0)
            put_point(o, "vt", m->uv + 2 * (i - nv), 2);
        else if (j < nf) {
            put_group(o, m, (int32_t)j);
            put_face(o, m, (int32_t)j);
        } else {
            put_text(o, "l ", 2);
            put_int(o, m->line[2 * (j - nf)] + 1);
            put_char(o, ' ');
            put_int(o, m->line[2 * (j - nf) + 1] + 1);
            put_char(o, '\n');
        }
        if (i % 16384 == 0 && !qc__progress(ctx, (double)i / (double)n)) return false;
    }
    flush(o);
    return true;
}

static qc_status check_finite(qc_ctx *ctx, const double *x, int64_t n, int dimension,
                              const char *what) {
    for (int64_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return qc__fail(ctx, QC_ERR_ARGUMENT, i / dimension,
                            "%s %lld is not finite and cannot be written", what,
                            (long long)(i / dimension));
    return QC_OK;
}

qc_status qc_polygon_mesh_write(qc_ctx *ctx, const qc_polygon_mesh *mesh, const char *path,
                                const char *comment) {
    qc__writer writer;
    qc_status status =
        check_finite(ctx, mesh->position, 3 * (int64_t)mesh->n_vertices, 3, "vertex");
    if (status == QC_OK && mesh->uv)
        status = check_finite(ctx, mesh->uv, 2 * (int64_t)mesh->n_uvs, 2, "texture coordinate");
    if (status == QC_OK && mesh->colour)
        status = check_finite(ctx, mesh->colour, 3 * (int64_t)mesh->n_vertices, 3, "colour");
    if (status != QC_OK) return status;
    output *o = QC__NEW(ctx, output, 1);
    if (!o) return QC_ERR_NOMEM;
    status = qc__writer_open(ctx, path, &writer);
    if (status == QC_OK) {
        o->file = writer.file;
        o->n = 0;
        o->failed = false;
        put_comment(o, comment);
        if (put_mesh(ctx, o, mesh))
            status = qc__writer_commit(ctx, &writer); /* sees write errors */
        else {
            qc__writer_abort(&writer);
            status = QC_ERR_CANCELLED;
        }
    }
    qc__free(o);
    return status;
}
