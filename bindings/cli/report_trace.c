/* What stages sampled while they worked, as JSON: the curves of Figure 6.1 of the thesis. */
#include "bindings/cli/report.h"
#include <string.h>

/* A step begins anew, too, where x falls: the next component. */
static bool begins(const cli_sample *before, const cli_sample *now) {
    return strcmp(before->step, now->step) != 0 ||
           (strcmp(before->curve, now->curve) == 0 && now->x < before->x);
}

static const cli_sample *last_of_curve(const cli_sample *sample, size_t i, size_t first) {
    for (size_t k = i; k-- > first;)
        if (strcmp(sample[k].curve, sample[i].curve) == 0) return &sample[k];
    return i > first ? &sample[i - 1] : NULL;
}

json_t *cli_report_trace(const cli_sample *sample, size_t n) {
    json_t *parts = json_array(), *curves = NULL;
    size_t first = 0;
    for (size_t i = 0; i < n; i++) {
        const cli_sample *before = last_of_curve(sample, i, first);
        if (!before || begins(before, &sample[i])) {
            curves = json_object();
            json_array_append_new(parts,
                                  json_pack("{s:s,s:o}", "step", sample[i].step, "curves", curves));
            first = i;
        }
        json_t *curve = json_object_get(curves, sample[i].curve);
        if (!curve) json_object_set_new(curves, sample[i].curve, curve = json_array());
        json_array_append_new(curve, json_pack("[f,f]", sample[i].x, sample[i].y));
    }
    return parts;
}
