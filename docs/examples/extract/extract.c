/* The extraction alone: quads of a parameterization which was made elsewhere, an OBJ file of
 * triangles with a texture coordinate at every corner. Across edges the coordinates differ by
 * quarter turns and integers; the quads are the cells of the integer grid.
 *
 *     extract UV.obj OUT.obj */
#include <qc/map.h>
#include <stdio.h>

int main(int argc, char **argv) {
    qc_ctx *ctx = NULL;
    qc_polygon_mesh *soup = NULL, *quads = NULL;
    qc_corner_map *map = NULL;
    qc_grid_map *grid = NULL;
    qc_polygon_topology of_quads;
    if (argc != 3) return fprintf(stderr, "usage: extract UV.obj OUT.obj\n"), 2;
    if (qc_ctx_create(NULL, &ctx) != QC_OK) return 1;

    /* A host with arrays calls qc_mesh_create and qc_corner_map_create (6 doubles a face). */
    qc_status status = qc_polygon_mesh_read(ctx, argv[1], &soup);
    if (status == QC_OK) status = qc_corner_map_from_polygons(ctx, soup, &map);

    /* Onto a grid of fixed-point numbers: transitions and orientations are exact from here on. An
     * edge whose two sides do not differ by a quarter turn and integers is an error naming it. */
    if (status == QC_OK) status = qc_grid_map_create(ctx, map, 0, &grid);

    /* A manifold of quads with the topology of the input, or an error naming the place. */
    if (status == QC_OK) status = qc_map_extract(ctx, grid, &quads);
    if (status == QC_OK) status = qc_polygon_mesh_topology(ctx, quads, &of_quads);
    if (status == QC_OK) status = qc_polygon_mesh_write(ctx, quads, argv[2], NULL);

    if (status == QC_OK) {
        printf("%d triangles, %d of them not positive\n", grid->mesh->n_faces,
               grid->n_flipped + grid->n_degenerate);
        printf("%d quads, %d irregular vertices\n", quads->n_faces, of_quads.irregular);
        printf("Euler characteristic %d, that of the input %d\n", of_quads.euler,
               grid->mesh->euler);
        /* Where vertex 0 lies: enough to carry any attribute over. */
        const double *b = quads->source_barycentric;
        printf("vertex 0 is in face %d at %.3f %.3f %.3f\n", quads->source_face[0], b[0], b[1],
               b[2]);
    } else {
        fprintf(stderr, "extract: %s\n", qc_ctx_error(ctx)->text);
    }
    qc_object_release(quads);
    qc_object_release(grid);
    qc_object_release(map);
    qc_object_release(soup);
    qc_ctx_free(ctx);
    return status == QC_OK ? 0 : 1;
}
