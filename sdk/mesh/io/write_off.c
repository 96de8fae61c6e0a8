/* Writing OFF: vertices and faces. */
#include "output.h"

static void put_counts(qc__output *o, const qc_polygon_mesh *m) {
    qc__put_int(o, m->n_vertices);
    qc__put_char(o, ' ');
    qc__put_int(o, m->n_faces);
    qc__put_text(o, " 0\n", 3);
}

static void put_face(qc__output *o, const qc_polygon_mesh *m, int64_t f) {
    qc__put_int(o, m->face_offset[f + 1] - m->face_offset[f]);
    for (int32_t c = m->face_offset[f]; c < m->face_offset[f + 1]; c++) {
        qc__put_char(o, ' ');
        qc__put_int(o, m->face_vertex[c]);
    }
    qc__put_char(o, '\n');
}

static void put_vertex(qc__output *o, const double x[3]) {
    for (int k = 0; k < 3; k++) {
        qc__put_double(o, x[k]);
        qc__put_char(o, k < 2 ? ' ' : '\n');
    }
}

qc_status qc__write_off(qc_ctx *ctx, qc__output *o, const qc_polygon_mesh *m, const char *comment) {
    const int64_t nv = m->n_vertices, n = nv + m->n_faces;
    qc__put_text(o, "OFF\n", 4);
    qc__put_comment(o, "# ", comment);
    put_counts(o, m);
    for (int64_t i = 0; i < n && !o->failed; i++) {
        if (i < nv)
            put_vertex(o, m->position + 3 * i);
        else
            put_face(o, m, i - nv);
        if (i % 16384 == 0 && !qc__progress(ctx, (double)i / (double)n)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}
