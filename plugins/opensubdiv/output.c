/* The report as a line of JSON. */
#include "parts.h"

#include <stdio.h>

qc_status qo_append_json(const qc_run *run, const qc_subdivision_report *r, const char *path) {
    FILE *file = fopen(path, "a");
    if (!file)
        return (run->fail)(run, QC_ERR_IO, -1, "json: the file for the report cannot be written");
    fprintf(file, "{\"vertices\": %d, \"faces\": %d, \"non_quads\": %d, \"creases\": %d, ",
            (int)r->n_vertices, (int)r->n_faces, (int)r->n_non_quads, (int)r->n_creases);
    fprintf(file, "\"valences\": [");
    for (int i = 0; i < 9; i++) fprintf(file, i ? ", %d" : "%d", (int)r->valence[i]);
    fprintf(file, "], \"extraordinary\": %d, \"boundary_extraordinary\": %d, ",
            (int)r->n_extraordinary, (int)r->n_boundary_extraordinary);
    fprintf(file, "\"spacing\": %d, \"mean_spacing\": %.9g, \"crowded_faces\": %d, ",
            (int)r->spacing, r->mean_spacing, (int)r->n_crowded);
    fprintf(file, "\"levels\": %d, \"samples\": %d, \"distance\": %.9g, \"mean_distance\": %.9g, ",
            (int)r->levels, (int)r->n_samples, r->distance, r->mean_distance);
    fprintf(file, "\"vertex_distance\": %.9g, \"cage_distance\": %.9g, ", r->vertex_distance,
            r->cage_distance);
    fprintf(file, "\"min_jacobian\": %.9g, \"reversed\": %lld, \"normal_deviation\": %.9g, ",
            r->jacobian, (long long)r->n_reversed, r->normal_deviation);
    fprintf(file, "\"fit_rounds\": %d, \"distance_before\": %.9g, ", (int)r->rounds,
            r->distance_before);
    fprintf(file, "\"mean_distance_before\": %.9g, \"vertex_distance_before\": %.9g}\n",
            r->mean_distance_before, r->vertex_distance_before);
    const bool good = !ferror(file);
    if (fclose(file) == 0 && good) return QC_OK;
    return (run->fail)(run, QC_ERR_IO, -1, "json: the report cannot be written");
}
