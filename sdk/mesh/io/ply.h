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
/* What a list is used for. */
enum {
    QC__PLY_SKIP, /* nothing (scalars are told by their slots) */
    QC__PLY_CORNERS,
    QC__PLY_UVS,          /* two numbers for each corner of the face */
    QC__PLY_CORNER_VALUES /* some numbers for each corner: an attribute */
};
/* Numbers of one element are gathered in slots. The first ones have a meaning. */
enum {
    QC__PLY_X = 0,     /* vertex: x, y, z */
    QC__PLY_U = 3,     /* vertex: u, v    */
    QC__PLY_GROUP = 0, /* face  */
    QC__PLY_ENDS = 0,  /* edge: vertex1, vertex2 */
    QC__PLY_FREE = 5   /* attributes */
};

typedef struct qc__ply_property {
    uint8_t type, count_type; /* count_type QC__PLY_NONE: a scalar */
    uint8_t role;             /* of a list */
    const char *name;         /* in the file */
    size_t length;
    int64_t slot; /* of a scalar, -1 = not used */
    double full;  /* which its value is divided by */
} qc__ply_property;

/* `width` slots which become a value of an attribute of the soup. */
typedef struct qc__ply_value {
    int32_t index, width;
    int64_t slot;
} qc__ply_value;

typedef struct qc__ply_element {
    char name[16]; /* shortened */
    int64_t count, line;
    int64_t property, n_properties; /* range in the table of properties */
    int64_t value, n_values;        /* range in the table of values     */
    int64_t least_bytes;            /* of one element in a binary file, with empty lists */
    bool has_list;
    bool has_uv, has_group, has_ends; /* slots with a meaning which are filled */
} qc__ply_element;

typedef struct qc__ply_header {
    int format;
    qc__ply_element *element;
    qc__ply_property *property;
    qc__ply_value *value;
    int64_t n_elements, n_properties, n_values, c_elements, c_properties, c_values;
    int64_t n_slots;           /* most of an element */
    bool corner_uv, vertex_uv; /* where uvs come from, at most one */
} qc__ply_header;

int qc__ply_size(int type);                                   /* bytes of a scalar */
bool qc__ply_is(const qc__ply_property *p, const char *name); /* in any case */
/* Leaves t at the first byte of the data. The tables are freed by the caller, also on failure. */
qc_status qc__ply_read_header(qc__text *t, qc__soup *s, qc__ply_header *h);
/* What every property is used for; declares the attributes. */
qc_status qc__ply_plan(qc__soup *s, qc__ply_header *h);

#endif
