/* Shared by the parts of the PLY writer. */
#ifndef QC_MESH_IO_WRITE_PLY_H
#define QC_MESH_IO_WRITE_PLY_H

#include <string.h>

#include "output.h"

typedef struct qc__ply_writer {
    qc__output *o;
    const qc_polygon_mesh *m;
    bool ascii, begun;  /* begun: a number stands on this line of text */
    const char *count;  /* type of the lengths of lists */
    int32_t *vertex_uv; /* n_vertices, -1 = none: when no vertex has two uvs; else NULL */
} qc__ply_writer;

static inline bool qc__ply_is_colour(const qc_attribute *a) {
    return strcmp(a->name, "colour") == 0 && (a->width == 3 || a->width == 4);
}

/* Everything up to end_header. types: that of each attribute, "uchar", "int" or "double". */
void qc__ply_write_header(qc__ply_writer *w, const char *const *types, const char *comment);

#endif
