/* A buffer in front of the file a mesh is written to, and the formats. */
#ifndef QC_MESH_IO_OUTPUT_H
#define QC_MESH_IO_OUTPUT_H

#include "internal.h"

typedef struct qc__output {
    FILE *file;
    size_t n;
    bool failed;
    char buffer[1 << 15];
} qc__output;

void qc__flush(qc__output *o);
void qc__put_text(qc__output *o, const char *text, size_t n);
void qc__put_char(qc__output *o, char c);
void qc__put_int(qc__output *o, int32_t i);
void qc__put_double(qc__output *o, double value); /* the shortest text which reads back the same */
/* A line: the word, then n numbers. */
void qc__put_point(qc__output *o, const char *word, const double *x, int n);
/* Every line of the comment behind the prefix. */
void qc__put_comment(qc__output *o, const char *prefix, const char *comment);

/* Each writes a whole file; CANCELLED or NOMEM when it could not. */
qc_status qc__write_obj(qc_ctx *ctx, qc__output *o, const qc_polygon_mesh *mesh,
                        const char *comment);
qc_status qc__write_off(qc_ctx *ctx, qc__output *o, const qc_polygon_mesh *mesh,
                        const char *comment);
qc_status qc__write_ply(qc_ctx *ctx, qc__output *o, const qc_polygon_mesh *mesh, bool ascii,
                        const char *comment);

#endif
