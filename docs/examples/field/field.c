/* The cross field alone: a triangle mesh in, its smoothest field and singularities out.
 *
 *     field IN.obj [OUT.rawfield] */
#include <qc/field.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv) {
    qc_ctx *ctx = NULL;
    qc_polygon_mesh *soup = NULL;
    qc_mesh *mesh = NULL;
    qc_repair_report *repairs = NULL;
    qc_face_field *field = NULL;
    qc_matching *matching = NULL;
    qc_complex *x = NULL;
    if (argc < 2) return fprintf(stderr, "usage: field IN.obj [OUT.rawfield]\n"), 2;
    if (qc_ctx_create(NULL, &ctx) != QC_OK) return 1;

    /* Files hold anything; repair makes an oriented manifold of it or says why not. A host which
     * has clean arrays in memory calls qc_mesh_create(ctx, V, position, F, face_vertex, &mesh). */
    qc_status status = qc_polygon_mesh_read(ctx, argv[1], &soup);
    if (status == QC_OK) status = qc_mesh_repair(ctx, soup, &mesh, &repairs);

    /* One unit complex number per face, in the frame of that face (docs/conventions.md). */
    if (status == QC_OK && !(x = calloc((size_t)mesh->n_faces, sizeof *x)))
        status = qc_ctx_fail(ctx, QC_ERR_NOMEM, -1, "out of memory");
    if (status == QC_OK) status = qc_field_smoothest(ctx, mesh, NULL, NULL, 0, 0, x);
    if (status == QC_OK) status = qc_face_field_create(ctx, mesh, x, NULL, NULL, &field);

    /* The matching says by how many quarter turns crosses differ over an edge, and with that the
     * index of every vertex in quarters. */
    if (status == QC_OK) status = qc_matching_create(ctx, field, NULL, &matching);
    if (status == QC_OK && argc > 2) status = qc_face_field_write(ctx, field, argv[2]);

    if (status == QC_OK) {
        printf("%d singularities, indices sum to %d/4, Euler characteristic %d\n",
               matching->n_singular, matching->index4_sum, mesh->euler);
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            if (matching->index4[v] != 0)
                printf("vertex %d has index %d/4\n", v, matching->index4[v]);
    } else {
        fprintf(stderr, "field: %s\n", qc_ctx_error(ctx)->text);
    }
    free(x);
    qc_object_release(matching); /* NULL is fine everywhere */
    qc_object_release(field);
    qc_object_release(repairs);
    qc_object_release(mesh);
    qc_object_release(soup);
    qc_ctx_free(ctx);
    return status == QC_OK ? 0 : 1;
}
