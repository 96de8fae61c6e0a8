/* The header of a PLY file as tables of elements and properties. */
#ifndef QC_MESH_IO_PLY_H
#define QC_MESH_IO_PLY_H

#include "internal.h"

enum { QC__PLY_ASCII, QC__PLY_LITTLE, QC__PLY_BIG };
enum {
    QC__PLY_NONE,
    QC__PLY_I8,
    QC__PLY_U8,
    QC__PLY_I16,
    QC__PLY_U16,
    QC__PLY_I32,
    QC__PLY_U32,
    QC__PLY_F32,
    QC__PLY_F64
};
/* What a property is used for: coordinates 0, 1, 2, colours 3, 4, 5, quality, the corners of a
 * face, or nothing. */
enum {
    QC__PLY_X,
    QC__PLY_Y,
    QC__PLY_Z,
    QC__PLY_RED,
    QC__PLY_GREEN,
    QC__PLY_BLUE,
    QC__PLY_QUALITY,
    QC__PLY_CORNERS,
    QC__PLY_SKIP
};

typedef struct qc__ply_property {
    uint8_t type, count_type; /* count_type QC__PLY_NONE: a scalar */
    uint8_t role;
} qc__ply_property;

typedef struct qc__ply_element {
    char name[16]; /* shortened */
    int64_t count, line;
    int64_t property, n_properties; /* range in the table of properties */
    int64_t least_bytes;            /* of one element in a binary file, with empty lists */
    bool has_list;
} qc__ply_element;

typedef struct qc__ply_header {
    int format;
    qc__ply_element *element;
    qc__ply_property *property;
    int64_t n_elements, n_properties, c_elements, c_properties;
} qc__ply_header;

int qc__ply_size(int type); /* bytes of a scalar */
/* Leaves t at the first byte of the data. The tables are freed by the caller, also on failure. */
qc_status qc__ply_read_header(qc__text *t, qc__ply_header *h);

#endif
