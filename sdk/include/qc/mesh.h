/* qc/mesh.h - polygon soups as users have them, and the clean triangle mesh everything else uses.
 *
 * qc_polygon_mesh: what files hold, and the type of quad results. qc_mesh: an oriented manifold
 * triangle mesh, possibly with boundary and several components, as compact index arrays.
 *
 * Index conventions (docs/conventions.md). Faces are counter-clockwise. Corner and halfedge k of
 * face t share the number 3 t + k: halfedge 3t+k is OPPOSITE corner k and runs from corner k+1 to
 * corner k+2 (mod 3). An interior edge has faces s (lower index) and t (higher index); its
 * halfedges are edge_halfedge[2e] in s and edge_halfedge[2e+1] in t; for a boundary edge the second
 * is -1. Thread rule: objects are immutable and shared freely; every call uses its context's
 * thread. */
#ifndef QC_MESH_H
#define QC_MESH_H

#include <qc/base.h>

#ifdef __cplusplus
extern "C" {
#endif

#define QC_TYPE_POLYGON_MESH  "qc.polygon_mesh/1"
#define QC_TYPE_MESH          "qc.mesh/1"
#define QC_TYPE_REPAIR_REPORT "qc.repair_report/1"
#define QC_TYPE_FEATURES      "qc.features/1"

/* --- polygon meshes --------------------------------------------------------------------------- */

/* Numbers which vertices, faces or corners carry, by name: colours, normals, weights, anything. */
enum { QC_AT_VERTEX = 0, QC_AT_FACE, QC_AT_CORNER };
enum {
    QC_ATTRIBUTE_LINEAR = 0, /* may be interpolated */
    QC_ATTRIBUTE_DIRECTION,  /* a unit vector: interpolated, then scaled to length 1; 0 = none */
    QC_ATTRIBUTE_LABEL       /* whole numbers, of which one is taken */
};
typedef struct qc_attribute {
    const char *name; /* "colour" (red, green, blue and maybe alpha, 0..1), "normal", "quality" (a
                         painted density) and "joint" with "weight" have a meaning of their own */
    int32_t at, kind; /* QC_AT_..., QC_ATTRIBUTE_... */
    int32_t width;    /* numbers an element has      */
    double *value;    /* width * elements            */
} qc_attribute;

/* All arrays are owned by the object; optional ones are NULL. */
typedef struct qc_polygon_mesh {
    qc_object object;
    int32_t n_vertices, n_faces, n_corners, n_uvs, n_lines;
    double *position; /* 3 n_vertices                                                          */
    int32_t *face_offset; /* n_faces + 1; face f has corners face_offset[f] .. face_offset[f+1]-1 */
    int32_t *face_vertex; /* n_corners, 0-based */
    double *uv;         /* optional, 2 n_uvs                                                     */
    int32_t *corner_uv; /* optional, n_corners; -1 = none                                        */
    int32_t *line;      /* optional, 2 n_lines: OBJ `l` segments as vertex pairs; of quads made from
                           a map: the edges which lie on its features                             */
    int32_t *face_line; /* optional, n_faces: line (text) or 1-based element in the file          */
    int32_t *face_group;  /* optional, n_faces: number of its OBJ o, g and usemtl, 0 = none */
    int32_t *source_face; /* optional, n_vertices: face of the mesh it was made from ...       */
    double *source_barycentric; /* ... and 3 n_vertices barycentric coordinates in it */
    int32_t *source_edge; /* optional, n_lines: edge of that mesh where line[2 i] or its other end
                             begins; -1 = not known, as in a union                              */
    int32_t n_groups;     /* group_name[i] belongs to face_group i + 1 */
    char **group_name;    /* optional, n_groups: the OBJ statements which select it, one a line:
                             "g wheel\nusemtl rubber" */
    char *materials;      /* optional: the OBJ statement "mtllib ..." */
    int32_t n_attributes;
    qc_attribute *attribute; /* optional, n_attributes, no two of one place with one name */
} qc_polygon_mesh;

/* Allocates zeroed arrays for the given sizes (n_uvs > 0 also makes corner_uv, SOURCE with
 * n_lines > 0 source_edge; flags add optional arrays). The caller fills them before publishing,
 * owns *out, frees with qc_object_release. */
enum { QC_POLYGON_FACE_LINE = 1, QC_POLYGON_FACE_GROUP = 2, QC_POLYGON_SOURCE = 4 };
QC_API qc_status qc_polygon_mesh_create(qc_ctx *ctx, int32_t n_vertices, int32_t n_faces,
                                        int32_t n_corners, int32_t n_uvs, int32_t n_lines,
                                        uint32_t flags, qc_polygon_mesh **out);

/* Adds an attribute of zeros to a mesh which is not yet shared; *value (may be NULL) is its array,
 * to be filled. Errors: ARGUMENT (no name, width < 1, the name is taken there), NOMEM. */
QC_API qc_status qc_polygon_mesh_add_attribute(qc_ctx *ctx, qc_polygon_mesh *mesh, const char *name,
                                               int32_t at, int32_t kind, int32_t width,
                                               double **value);
/* The attribute of that name and place; NULL = none. */
QC_API const qc_attribute *qc_polygon_mesh_attribute(const qc_polygon_mesh *mesh, int32_t at,
                                                     const char *name);
/* Vertices, faces or corners. */
static inline int32_t qc_polygon_mesh_elements(const qc_polygon_mesh *mesh, int32_t at) {
    return at == QC_AT_VERTEX ? mesh->n_vertices
           : at == QC_AT_FACE ? mesh->n_faces
                              : mesh->n_corners;
}

/* Reads OBJ, OFF, PLY (ASCII, binary little and big endian) or STL (ASCII, binary); the format is
 * recognised by content, then by extension. path "-" = stdin. Errors: IO; INPUT with the line
 * (text) or byte/element (binary) in where and in the text: empty, truncated, not a number,
 * non-finite coordinate, index out of range, fewer than 3 corners, no faces. */
QC_API qc_status qc_polygon_mesh_read(qc_ctx *ctx, const char *path, qc_polygon_mesh **out);
/* The same from memory; name is used for messages and for the extension (may be NULL). */
QC_API qc_status qc_polygon_mesh_parse(qc_ctx *ctx, const void *data, size_t size, const char *name,
                                       qc_polygon_mesh **out);

/* Formats of files. AUTO: that of the extension (.obj, .off, .ply: binary), else OBJ. */
enum {
    QC_FORMAT_AUTO = 0,
    QC_FORMAT_OBJ,      /* with vt per corner, vn, colours behind coordinates, groups, lines */
    QC_FORMAT_OFF,      /* vertices and faces only                                           */
    QC_FORMAT_PLY,      /* binary, little endian: everything but sources of vertices         */
    QC_FORMAT_PLY_ASCII /* the same as text                                                  */
};
/* Writes through a temporary and a rename (path "-" = stdout). Numbers round-trip, but for colours
 * of PLY, which are bytes there. comment (may be NULL) becomes comment lines at the top. Errors:
 * ARGUMENT (a number which is not finite, a format which is none), IO, NOMEM, CANCELLED. */
QC_API qc_status qc_polygon_mesh_write_as(qc_ctx *ctx, const qc_polygon_mesh *mesh,
                                          const char *path, int32_t format, const char *comment);
/* The same with QC_FORMAT_AUTO. */
QC_API qc_status qc_polygon_mesh_write(qc_ctx *ctx, const qc_polygon_mesh *mesh, const char *path,
                                       const char *comment);
/* Disjoint union of n meshes. Source faces of mesh i are mapped through source_map[i] (source_map
 * or an entry of it NULL = no change). An optional array exists in the result when some part has
 * it; elsewhere it says "none" (-1 for uvs and source faces, 0 for the others). Attributes are one
 * where name and place are the same, with the largest width and the kind of the first. Groups keep
 * their numbers; their names are those of the first part which has any. */
QC_API qc_status qc_polygon_mesh_merge(qc_ctx *ctx, int32_t n, const qc_polygon_mesh *const *parts,
                                       const int32_t *const *source_map, qc_polygon_mesh **out);

/* Combinatorial check of any polygon mesh. */
typedef struct qc_polygon_topology {
    int32_t components, boundary_loops, euler, non_quads;
    int32_t irregular;          /* interior vertices of valence other than 4                     */
    int32_t non_manifold_edges; /* edges with three or more faces                                */
    int32_t non_manifold_vertices; /* vertices whose faces form more than one fan */
    int32_t inconsistent_edges; /* edges with two faces which run through it in one direction    */
    int32_t duplicate_faces, degenerate_faces, unreferenced_vertices;
    int32_t first_bad_element; /* a vertex or face of the first defect above, -1 = none          */
} qc_polygon_topology;
QC_API qc_status qc_polygon_mesh_topology(qc_ctx *ctx, const qc_polygon_mesh *mesh,
                                          qc_polygon_topology *out);

/* --- triangle meshes -------------------------------------------------------------------------- */

typedef struct qc_mesh {
    qc_object object;
    int32_t n_vertices, n_faces, n_edges, n_boundary_edges;
    int32_t n_components, n_boundary_loops, euler; /* euler = V - E + F of the whole mesh */
    int32_t genus;   /* sum over the components                                       */
    double diagonal; /* of the bounding box                                           */
    double area, mean_edge_length; /* of the surface */
    const double *position;     /* 3 n_vertices                                                  */
    const int32_t *face_vertex; /* 3 n_faces                                                     */
    const int32_t *twin;        /* 3 n_faces: opposite halfedge, -1 on the boundary              */
    const int32_t *halfedge_edge; /* 3 n_faces: edge of a halfedge */
    const int32_t *edge_halfedge; /* 2 n_edges, see above */
    const int32_t *vertex_corner; /* n_vertices: the corner from which qc_corner_ccw visits the
                                     whole fan; on the boundary the clockwise-most one */
    const int32_t *edge_vertex; /* 2 n_edges: start and end of edge_halfedge[2e]                  */
    const int32_t *face_component; /* n_faces */
    const int32_t *source_face,
        *source_vertex; /* optional: numbers in the input the mesh came from  */
    /* Poles: vertices of the surface whose star is cut open, so that each of its faces has a tip of
     * its own at that point (Fig. 8 of the second paper). Each is a boundary loop of this mesh. */
    int32_t n_poles;
    const int32_t *pole_start;  /* n_poles + 1, NULL = no pole */
    const int32_t *pole_corner; /* the tips of a pole: corners, counter-clockwise about it */
} qc_mesh;

/* Builds the connectivity of an oriented manifold triangle list (arrays are copied). Errors:
 * ARGUMENT (index out of range, a vertex twice in a face; where = face; a coordinate which is not
 * finite, where = vertex), NON_MANIFOLD (where = face of
 * an edge with three faces or inconsistent orientation, or a vertex with two fans; the text names
 * it; unreferenced vertices are ARGUMENT with where = vertex), NOMEM, CANCELLED. */
QC_API qc_status qc_mesh_create(qc_ctx *ctx, int32_t n_vertices, const double *position,
                                int32_t n_faces, const int32_t *face_vertex, qc_mesh **out);
/* The same with source numbers attached (either may be NULL; copied). */
QC_API qc_status qc_mesh_create_from(qc_ctx *ctx, int32_t n_vertices, const double *position,
                                     int32_t n_faces, const int32_t *face_vertex,
                                     const int32_t *source_vertex, const int32_t *source_face,
                                     qc_mesh **out);
/* Records the poles of a mesh which is not yet shared. tip: 3 n_faces flags, 1 at the corners whose
 * vertices are tips. Poles are in the order of their lowest tip, which is their first. ARGUMENT
 * with where = corner when the face is not the only one at its tip or the tips form no loop. */
QC_API qc_status qc_mesh_set_poles(qc_ctx *ctx, qc_mesh *mesh, const uint8_t *tip);
/* One connected component as a mesh of its own; source_face/vertex refer to the numbers in `mesh`.
 */
QC_API qc_status qc_mesh_component(qc_ctx *ctx, const qc_mesh *mesh, int32_t component,
                                   qc_mesh **out);

static inline int32_t qc_next(int32_t h) {
    return h % 3 == 2 ? h - 2 : h + 1;
}
static inline int32_t qc_prev(int32_t h) {
    return h % 3 == 0 ? h + 2 : h - 1;
}
static inline int32_t qc_halfedge_start(const qc_mesh *m, int32_t h) {
    return m->face_vertex[qc_next(h)];
}
static inline int32_t qc_halfedge_end(const qc_mesh *m, int32_t h) {
    return m->face_vertex[qc_prev(h)];
}
/* Corner of the same vertex in the next face counter-clockwise (clockwise); -1 across the boundary.
 * The edge crossed is halfedge_edge[qc_next(c)] (halfedge_edge[qc_prev(c)] clockwise). */
static inline int32_t qc_corner_ccw(const qc_mesh *m, int32_t c) {
    int32_t h = m->twin[qc_next(c)];
    return h < 0 ? -1 : qc_next(h);
}
static inline int32_t qc_corner_cw(const qc_mesh *m, int32_t c) {
    int32_t h = m->twin[qc_prev(c)];
    return h < 0 ? -1 : qc_prev(h);
}
/* The next tip of a pole counter-clockwise; they share the vertex of corner qc_prev(tip). */
static inline int32_t qc_next_tip(const qc_mesh *m, int32_t tip) {
    int32_t c = qc_prev(tip);
    for (int32_t d = qc_corner_ccw(m, c); d >= 0; d = qc_corner_ccw(m, c)) c = d;
    return qc_prev(c);
}
static inline bool qc_vertex_on_boundary(const qc_mesh *m, int32_t v) {
    return m->twin[qc_prev(m->vertex_corner[v])] < 0;
}

/* Boundary loops: loop i is vertices loop_vertex[loop_offset[i]] .. [loop_offset[i+1]-1], each loop
 * with the surface on its left, loops ordered by their smallest halfedge. Arrays: n_boundary_loops
 * + 1 and n_boundary_edges entries, caller-allocated. */
QC_API qc_status qc_mesh_boundary_loops(qc_ctx *ctx, const qc_mesh *mesh, int32_t *loop_offset,
                                        int32_t *loop_vertex);

/* --- geometry --------------------------------------------------------------------------------- */

/* Any output may be NULL. length: n_edges; area: n_faces; cotangent, angle: 3 n_faces by corner;
 * normal: 3 n_faces unit vectors; gauss: n_vertices, 2 pi (pi on the boundary) - sum of angles.
 * Cotangents of slivers are finite: areas are floored at 1e-14 of the squared longest edge. */
QC_API qc_status qc_mesh_geometry(qc_ctx *ctx, const qc_mesh *mesh, double *length, double *area,
                                  double *cotangent, double *angle, double *normal, double *gauss);

/* --- shortest paths and cut graphs (thesis 1.3) ----------------------------------------------- */

/* Dijkstra from all vertices with source[v] != 0. weight: n_edges > 0, NULL = Euclidean length.
 * distance: n_vertices (infinity when not reached); predecessor_edge: n_vertices, -1 at sources and
 * where not reached; either may be NULL. Errors: ARGUMENT (weight not positive, where = edge),
 * NOMEM, CANCELLED. */
QC_API qc_status qc_mesh_shortest_paths(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                                        const uint8_t *source, double *distance,
                                        int32_t *predecessor_edge);

/* Shortest cut graph through a set of base vertices (Algorithm 1.16 with the extension to base
 * vertices and boundaries). base: n_vertices flags; boundary vertices are base vertices of their
 * own accord; a closed component without any gets its lowest-numbered vertex. cut: n_edges flags, 1
 * on edges of the graph. Boundary edges are never flagged. Every component minus its cut edges is a
 * topological disk (annuli of a boundary are opened too), and every base vertex is on the graph.
 * The one exception: the graph of a sphere with a single base vertex (or none) is empty, so it
 * stays closed; who needs a disk there gives two base vertices. base NULL = none. weight as above.
 * Errors: ARGUMENT (weight not positive, where = edge), NOMEM, CANCELLED. */
QC_API qc_status qc_mesh_cut_graph(qc_ctx *ctx, const qc_mesh *mesh, const double *weight,
                                   const uint8_t *base, uint8_t *cut);

/* --- features --------------------------------------------------------------------------------- */

enum {
    QC_FEATURE_BOUNDARY = 1,
    QC_FEATURE_CREASE = 2,
    QC_FEATURE_LINE = 4, /* strokes, and lines of the input */
    QC_FEATURE_GROUP = 8 /* between two groups of faces */
};
typedef struct qc_features {
    qc_object object;
    const qc_mesh *mesh; /* retained                                                              */
    int32_t n_feature_edges, n_creases,
        n_corners;         /* corners: feature vertices of feature degree != 2 */
    const uint8_t *edge;   /* n_edges: QC_FEATURE_... flags   */
    const uint8_t *vertex; /* n_vertices: number of feature edges at it, saturated at 255 */
    bool hard;             /* isolines have to follow them; false: they guide the field only */
    double bend; /* hard ones have a corner where they turn within this length (units of the mesh);
                    0: from edge to edge; set it before the features are shared */
} qc_features;
/* Features from their flags (n_edges, copied). */
QC_API qc_status qc_features_create(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge,
                                    bool hard, qc_features **out);
/* The boundary and creases: dihedral angle above `angle` (radians). line: pairs of mesh vertices
 * (may be NULL), strokes as in qc_features_add_strokes. */
QC_API qc_status qc_features_detect(qc_ctx *ctx, const qc_mesh *mesh, double angle, int32_t n_lines,
                                    const int32_t *line, qc_features **out);

/* The following work on flags (n_edges) before they become features. */

/* Edges between faces of different groups (n_faces numbers). */
QC_API void qc_features_add_groups(const qc_mesh *mesh, const int32_t *group, uint8_t *edge);
/* Strokes: segments between points (3 n_points coordinates; segment: 2 n_segments numbers of
 * points) near the surface. Points move to the nearest vertex of the mesh, those farther away than
 * `reach` (units of the mesh) are ignored with their segments; the vertices are joined by the path
 * of edges nearest to the segment. The mesh is not cut. Numbers out of range and segments without a
 * path are ignored; how many is logged. Near-linear for short segments. Errors: NOMEM, CANCELLED.
 */
QC_API qc_status qc_features_add_strokes(qc_ctx *ctx, const qc_mesh *mesh, int32_t n_points,
                                         const double *point, int32_t n_segments,
                                         const int32_t *segment, double reach, uint8_t *edge);
/* The chains of flagged edges (n_edges) between vertices with other than two of them, or two which
 * turn back by more than 120 degrees: chain (n_edges) = number of each, from 0, -1 where there is
 * no flag; *n chains. */
QC_API qc_status qc_features_chains(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge,
                                    int32_t *chain, int32_t *n);
typedef struct qc_feature_chain {
    int32_t end[2];  /* vertices; equal when it is closed */
    int32_t n_edges; /* of the chain */
    uint8_t kinds;   /* QC_FEATURE_... flags of its edges, or-ed */
    double length;   /* units of the mesh */
    double angle;    /* dihedral angle (radians), mean by length */
} qc_feature_chain;
/* The same chains measured: one entry for each of the *n of qc_features_chains. */
QC_API qc_status qc_features_measure_chains(qc_ctx *ctx, const qc_mesh *mesh, const uint8_t *edge,
                                            qc_feature_chain *out);
typedef struct qc_prune_options {
    uint32_t struct_size;
    double weak;  /* radians: dihedral angle above which an edge may close a gap */
    double half;  /* units of the mesh, half a quad: the scale at which bluntness is measured */
    double blunt; /* radians: creases which bend by less there go; 0 = none do */
    double least; /* units of the mesh: shorter creases with a free end go; 0 = none do */
    double sharp; /* radians: of two features which meet in less the weaker goes; 0 = none do */
} qc_prune_options;
#define QC_PRUNE_OPTIONS_INIT                                                                      \
    { sizeof(qc_prune_options), 0.3490658503988659, 0, 0.5235987755982988, 0, 0.5235987755982988 }
/* Closes gaps of creases along edges of dihedral angle above `weak` which lead on from a free end
 * to another feature, lets creases which take two sides of a face at an angle below 75 degrees take
 * the third; then drops chains of creases at which the surface, seen from `half` (three edges at
 * least) on either side, bends by less than `blunt` on average (docs/theory/features.md, K.0),
 * creases with a free end shorter than `least` (closed ones shorter than twice that), then of two
 * features which meet in less than `sharp` the weaker one, each named by a warning with the numbers
 * of the input: creases by their mean angle, then groups and strokes, of equal ones the shorter;
 * the boundary stays. The last two repeat until nothing changes. options NULL: 20 degrees, 30 and
 * 30, no lengths. Errors: NOMEM, CANCELLED. */
QC_API qc_status qc_features_prune(qc_ctx *ctx, const qc_mesh *mesh,
                                   const qc_prune_options *options, uint8_t *edge);

/* --- mirror symmetry -------------------------------------------------------------------------- */

/* The points p with <normal, p> = offset; normal is a unit vector. */
typedef struct qc_plane {
    double normal[3], offset;
} qc_plane;
struct qc_closest_point;
/* The plane about which the surface is symmetric, across a coordinate axis (0, 1, 2) or any (-1).
 * *deviation is the largest distance of a mirrored point to the surface in diagonals of the
 * bounding box; above `tolerance` a plane does not count, and *deviation is infinite and *plane
 * untouched where there is none. Planes across coordinate axes come first; of equally good ones it
 * is the first. closest NULL = builtin. Errors: ARGUMENT, NOMEM, CANCELLED. */
QC_API qc_status qc_mesh_find_symmetry(qc_ctx *ctx, const qc_mesh *mesh, int32_t axis,
                                       double tolerance, const struct qc_closest_point *closest,
                                       qc_plane *plane, double *deviation);
/* The part of the mesh where <normal, p> >= offset. Faces across the plane are cut, vertices nearer
 * to it than a twentieth of their shortest edge are moved onto it, so the new boundary lies exactly
 * in it. Source numbers are those of `mesh`, -1 for vertices on cut edges. Errors: ARGUMENT (no
 * unit vector), FAILED (the plane does not cut the surface),
 * NON_MANIFOLD (the part touches itself), NOMEM. */
QC_API qc_status qc_mesh_half(qc_ctx *ctx, const qc_mesh *mesh, const qc_plane *plane,
                              qc_mesh **out);

/* --- repair ----------------------------------------------------------------------------------- */

/* Kinds of repair, in the order they are made. */
enum {
    QC_REPAIR_TRIANGULATED = 0,  /* polygons with more than 3 corners                             */
    QC_REPAIR_WELDED,            /* vertices with equal coordinates merged                        */
    QC_REPAIR_DEGENERATE,        /* faces with a repeated vertex dropped                          */
    QC_REPAIR_DUPLICATE,         /* faces with the same vertices dropped                          */
    QC_REPAIR_NON_MANIFOLD_EDGE, /* edges with three or more faces cut open                       */
    QC_REPAIR_ORIENTED,          /* faces turned round                                            */
    QC_REPAIR_NON_MANIFOLD_VERTEX, /* vertices split, one per fan */
    QC_REPAIR_ZERO_AREA,       /* needles and caps removed by a collapse or a flip              */
    QC_REPAIR_UNREFERENCED,    /* vertices without faces dropped                                */
    QC_REPAIR_SMALL_COMPONENT, /* components with fewer than 4 faces dropped                    */
    QC_REPAIR_KINDS
};
typedef struct qc_repair_report {
    qc_object object;
    int32_t count[QC_REPAIR_KINDS];
    int32_t first[QC_REPAIR_KINDS][4]; /* first elements (input numbers), -1 = fewer */
} qc_repair_report;
QC_API const char *qc_repair_kind_name(int32_t kind); /* "polygons triangulated", ... */

/* Turns a polygon soup into an oriented manifold mesh, or refuses. Every change is counted in the
 * report. Errors: INPUT (where = face; the text says why and the way out): no face left, not
 * orientable (Moebius strip), fewer than 4 faces. source_face/vertex of *mesh are input numbers. */
QC_API qc_status qc_mesh_repair(qc_ctx *ctx, const qc_polygon_mesh *soup, qc_mesh **mesh,
                                qc_repair_report **report);

#ifdef __cplusplus
}
#endif
#endif
