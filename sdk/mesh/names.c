/* Names of vertices and faces in messages: their numbers in the input, which is what a user can
 * look up. Parts, halves and refined meshes number their own. */
#include "sdk/mesh/names.h"

#include <stdio.h>

const char *qc__vertex_name(const qc_mesh *mesh, int32_t v, char text[QC__ELEMENT_NAME]) {
    const bool valid = v >= 0 && v < mesh->n_vertices;
    const int32_t number = valid && mesh->source_vertex ? mesh->source_vertex[v] : v;
    if (!valid) {
        snprintf(text, QC__ELEMENT_NAME, "an unknown vertex");
    } else if (number >= 0) {
        snprintf(text, QC__ELEMENT_NAME, "vertex %d", (int)number);
    } else {
        const double *p = mesh->position + 3 * (int64_t)v;
        snprintf(text, QC__ELEMENT_NAME, "the point (%.6g, %.6g, %.6g)", p[0], p[1], p[2]);
    }
    return text;
}

int32_t qc__face_number(const qc_mesh *mesh, int32_t face) {
    return mesh->source_face && face >= 0 && face < mesh->n_faces ? mesh->source_face[face] : face;
}
