/* Guide strokes from camera rays, as lines of the input. */
#include "bindings/cli/cli.h"

int cli_add_strokes(cli_session *session, const qc_registry *registry, const char *path,
                    qc_polygon_mesh **mesh) {
    cli_rays r = {0};
    qc_polygon_mesh *strokes = NULL, *both = NULL;
    int status = cli_read_rays(path, &r);
    if (status == EXIT_DONE &&
        (qc_ray_strokes(session->ctx, *mesh, cli_ray_caster(registry), r.n_strokes, r.offset, r.ray,
                        0, &strokes) != QC_OK ||
         qc_polygon_mesh_merge(session->ctx, 2, (const qc_polygon_mesh *[]){*mesh, strokes}, NULL,
                               &both) != QC_OK))
        status = cli_session_error(session, path, EXIT_INPUT);
    if (status == EXIT_DONE) {
        qc_object_release(*mesh);
        *mesh = both;
    }
    qc_object_release(strokes);
    cli_rays_free(&r);
    return status;
}
