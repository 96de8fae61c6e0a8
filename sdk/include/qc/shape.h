/* qc/shape.h - the procedural surfaces of the papers: exact genus and boundary count. */
#ifndef QC_SHAPE_H
#define QC_SHAPE_H

#include <qc/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct qc_shape_options {
    uint32_t struct_size;
    int32_t resolution; /* about this many faces; 0 = the shape's default (about 8000) */
    double noise; /* normal displacement, standard deviation in mean edge lengths            */
    int32_t retriangulate; /* 1 = random edge flips and tangential jitter (Fig. 2 b of the 2007
                              paper) */
    int32_t genus; /* for "genus": 0..50                                                      */
    uint64_t seed;
} qc_shape_options;
#define QC_SHAPE_OPTIONS_INIT                                                                      \
    { sizeof(qc_shape_options), 0, 0.0, 0, 2, 1 }

typedef struct qc_shape_info {
    const char *name, *doc;
    int32_t genus, boundary_loops; /* of the result; genus -1 = given by the option */
} qc_shape_info;

/* All shapes, n in *count; static lifetime. */
QC_API const qc_shape_info *qc_shape_list(size_t *count);
/* Errors: NOT_FOUND (with the closest name), ARGUMENT (option out of range). */
QC_API qc_status qc_shape_create(qc_ctx *ctx, const char *name, const qc_shape_options *options,
                                 qc_mesh **out);

#ifdef __cplusplus
}
#endif
#endif
