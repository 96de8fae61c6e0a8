/* Camera rays from a file: { "strokes": [ [ [ox, oy, oz, dx, dy, dz], ... ], ... ] }, origin and
 * direction of each ray. */
#include "bindings/cli/cli.h"
#include <jansson.h>
#include <stdlib.h>

static bool read_ray(const json_t *numbers, double *ray) {
    if (json_array_size(numbers) != 6) return false;
    for (size_t k = 0; k < 6; k++) {
        if (!json_is_number(json_array_get(numbers, k))) return false;
        ray[k] = json_number_value(json_array_get(numbers, k));
    }
    return true;
}

static int read_stroke(const char *path, const json_t *stroke, size_t i, cli_rays *out) {
    if (!json_is_array(stroke))
        return cli_error(EXIT_INPUT, "%s: stroke %zu is not a list of rays", path, i);
    for (size_t j = 0; j < json_array_size(stroke); j++)
        if (!read_ray(json_array_get(stroke, j), out->ray + 6 * (size_t)out->n_rays++))
            return cli_error(EXIT_INPUT,
                             "%s: ray %zu of stroke %zu: use 6 numbers, origin and direction", path,
                             j, i);
    out->offset[i + 1] = out->n_rays;
    return EXIT_DONE;
}

static int read_strokes(const char *path, const json_t *root, cli_rays *out) {
    const json_t *strokes = json_object_get(root, "strokes");
    const size_t n = json_array_size(strokes);
    size_t total = 0;
    for (size_t i = 0; i < n; i++) total += json_array_size(json_array_get(strokes, i));
    if (total < 2 || total > INT32_MAX / 8)
        return cli_error(EXIT_INPUT,
                         "%s: no strokes; write {\"strokes\": [[[ox, oy, oz, dx, dy, dz], ...]]}",
                         path);
    out->n_strokes = (int32_t)n;
    out->offset = calloc(n + 1, sizeof *out->offset);
    out->ray = malloc(6 * total * sizeof *out->ray);
    int status =
        out->offset && out->ray ? EXIT_DONE : cli_error(EXIT_FAILED, "%s: out of memory", path);
    for (size_t i = 0; i < n && status == EXIT_DONE; i++)
        status = read_stroke(path, json_array_get(strokes, i), i, out);
    return status;
}

int cli_read_rays(const char *path, cli_rays *out) {
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error);
    const int status = root
                           ? read_strokes(path, root, out)
                           : cli_error(EXIT_INPUT, "%s: line %d: %s", path, error.line, error.text);
    json_decref(root);
    return status;
}

void cli_rays_free(cli_rays *rays) {
    free(rays->offset);
    free(rays->ray);
}

const qc_ray_caster *cli_ray_caster(const qc_registry *registry) {
    const qc_interface *latest = NULL, *next;
    for (uint32_t i = 0; (next = qc_registry_interface(registry, QC_RAY_CASTER_ID, i)) != NULL; i++)
        latest = next;
    return (const qc_ray_caster *)latest;
}
