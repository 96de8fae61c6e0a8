/* Disjoint union of polygon meshes. An optional array exists in the result when one part has it;
 * parts without it contribute "none" (-1 for uv and source indices, 0 for lines and groups). */
#include <string.h>

#include "sdk/mesh/internal.h"

typedef struct sizes {
    int64_t vertices, faces, corners, uvs, lines;
    uint32_t flags;
} sizes;

static sizes add_up(int32_t n, const qc_polygon_mesh *const *parts) {
    sizes s = {0};
    for (int32_t i = 0; i < n; i++) {
        const qc_polygon_mesh *p = parts[i];
        s.vertices += p->n_vertices;
        s.faces += p->n_faces;
        s.corners += p->n_corners;
        s.uvs += p->n_uvs;
        s.lines += p->n_lines;
        if (p->face_line) s.flags |= QC_POLYGON_FACE_LINE;
        if (p->face_group) s.flags |= QC_POLYGON_FACE_GROUP;
        if (p->source_face) s.flags |= QC_POLYGON_SOURCE;
    }
    return s;
}

static void copy_ints(int32_t *to, const int32_t *from, int32_t n, int32_t shift) {
    for (int32_t i = 0; i < n; i++) to[i] = from[i] < 0 ? from[i] : from[i] + shift;
}

static void copy_doubles(double *to, const double *from, size_t n) {
    if (n > 0) memcpy(to, from, n * sizeof *to);
}

static void copy_source(qc_polygon_mesh *out, const qc_polygon_mesh *p, const int32_t *map,
                        int32_t vertex) {
    for (int32_t v = 0; v < p->n_vertices; v++) {
        int32_t f = p->source_face ? p->source_face[v] : -1;
        out->source_face[vertex + v] = map && f >= 0 ? map[f] : f;
    }
    if (p->source_barycentric)
        copy_doubles(out->source_barycentric + 3 * (size_t)vertex, p->source_barycentric,
                     3 * (size_t)p->n_vertices);
}

static void copy_attribute(const qc_attribute *to, const qc_attribute *from, int32_t n,
                           int32_t begin) {
    for (int64_t i = 0; i < n; i++)
        memcpy(to->value + to->width * (begin + i), from->value + from->width * i,
               (size_t)from->width * sizeof(double));
}

/* The attributes of all parts, each as wide as its widest. */
static qc_status add_attributes(qc_ctx *ctx, int32_t n, const qc_polygon_mesh *const *parts,
                                qc_polygon_mesh *out) {
    qc_status status = QC_OK;
    for (int32_t i = 0; i < n; i++)
        for (int32_t k = 0; k < parts[i]->n_attributes && status == QC_OK; k++) {
            const qc_attribute *a = &parts[i]->attribute[k], *b;
            int32_t width = a->width;
            if (qc_polygon_mesh_attribute(out, a->at, a->name)) continue;
            for (int32_t j = i + 1; j < n; j++)
                if ((b = qc_polygon_mesh_attribute(parts[j], a->at, a->name)) && b->width > width)
                    width = b->width;
            status = qc_polygon_mesh_add_attribute(ctx, out, a->name, a->at, a->kind, width, NULL);
        }
    return status;
}

/* Appends part p at the counts reached so far. */
static void append(qc_polygon_mesh *out, const qc_polygon_mesh *p, const int32_t *map,
                   const sizes *at) {
    int32_t vertex = (int32_t)at->vertices, face = (int32_t)at->faces;
    int32_t corner = (int32_t)at->corners, uv = (int32_t)at->uvs, line = (int32_t)at->lines;
    copy_doubles(out->position + 3 * (size_t)vertex, p->position, 3 * (size_t)p->n_vertices);
    copy_ints(out->face_offset + face, p->face_offset, p->n_faces + 1, corner);
    copy_ints(out->face_vertex + corner, p->face_vertex, p->n_corners, vertex);
    if (out->uv) {
        copy_doubles(out->uv + 2 * (size_t)uv, p->uv, 2 * (size_t)p->n_uvs);
        for (int32_t c = 0; c < p->n_corners; c++) out->corner_uv[corner + c] = -1;
        if (p->corner_uv) copy_ints(out->corner_uv + corner, p->corner_uv, p->n_corners, uv);
    }
    if (p->n_lines > 0) copy_ints(out->line + 2 * (size_t)line, p->line, 2 * p->n_lines, vertex);
    if (p->face_line) copy_ints(out->face_line + face, p->face_line, p->n_faces, 0);
    if (p->face_group) copy_ints(out->face_group + face, p->face_group, p->n_faces, 0);
    for (int32_t i = 0; i < p->n_attributes; i++) {
        const qc_attribute *a = &p->attribute[i];
        const int32_t begin[] = {vertex, face, corner};
        copy_attribute(qc_polygon_mesh_attribute(out, a->at, a->name), a,
                       qc_polygon_mesh_elements(p, a->at), begin[a->at]);
    }
    if (out->source_face) copy_source(out, p, map, vertex);
    for (int32_t i = 0; out->source_edge && i < p->n_lines; i++) out->source_edge[line + i] = -1;
}

qc_status qc_polygon_mesh_merge(qc_ctx *ctx, int32_t n, const qc_polygon_mesh *const *parts,
                                const int32_t *const *source_map, qc_polygon_mesh **out) {
    sizes total = add_up(n, parts), at = {0};
    const int64_t limit = INT32_MAX / 3;
    if (total.vertices > limit || total.corners > limit || total.uvs > limit || total.lines > limit)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "the union has more than %d vertices or corners",
                        (int)limit);
    qc_polygon_mesh *merged = NULL;
    qc_status status = qc_polygon_mesh_create(ctx, (int32_t)total.vertices, (int32_t)total.faces,
                                              (int32_t)total.corners, (int32_t)total.uvs,
                                              (int32_t)total.lines, total.flags, &merged);
    if (status == QC_OK) status = add_attributes(ctx, n, parts, merged);
    if (status != QC_OK) {
        qc_object_release(merged);
        return status;
    }
    for (int32_t i = 0; i < n; i++) {
        append(merged, parts[i], source_map ? source_map[i] : NULL, &at);
        sizes part = add_up(1, parts + i);
        at.vertices += part.vertices;
        at.faces += part.faces;
        at.corners += part.corners;
        at.uvs += part.uvs;
        at.lines += part.lines;
    }
    for (int32_t i = 0; i < n && status == QC_OK && !merged->group_name; i++)
        if (parts[i]->group_name)
            status = qc__polygon_name_groups(ctx, merged, parts[i]->n_groups,
                                             (const char *const *)parts[i]->group_name,
                                             parts[i]->materials);
    if (status == QC_OK)
        *out = merged;
    else
        qc_object_release(merged);
    return status;
}
