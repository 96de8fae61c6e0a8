/* The plugin: no stage, closest points and rays. */
#include <qc/plugin.h>
#include <string.h>

#include "tables.h"

static const qc_interface *const closest_points[] = {&qe_closest_point.head, NULL};
static const qc_interface *const ray_casters[] = {&qe_ray_caster.head, NULL};

static const void *extension(const char *id) {
    if (strcmp(id, QC_CLOSEST_POINT_ID) == 0) return closest_points;
    return strcmp(id, QC_RAY_CASTER_ID) == 0 ? ray_casters : NULL;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {
    sizeof(qc_plugin),      QC_ABI_MAJOR,     QC_ABI_MINOR,
    .id = "qc.embree",      .version = "1.0", .license = "MIT (Embree: Apache-2.0)",
    .extension = extension,
};
