/* How messages name vertices and faces: as the input which the mesh came from numbers them. */
#ifndef QC_MESH_NAMES_H
#define QC_MESH_NAMES_H

#include "sdk/mesh/internal.h"

enum { QC__ELEMENT_NAME = 72 };

/* "vertex 12", or "the point (1, 2, 3)" where the input has none; returns text. */
const char *qc__vertex_name(const qc_mesh *mesh, int32_t v, char text[QC__ELEMENT_NAME]);
int32_t qc__face_number(const qc_mesh *mesh, int32_t face);

#endif
