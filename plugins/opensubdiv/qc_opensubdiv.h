/* qc_opensubdiv.h - the report of stage qc.check.opensubdiv. */
#ifndef QC_OPENSUBDIV_H
#define QC_OPENSUBDIV_H

#include <qc/base.h>

#ifdef __cplusplus
extern "C" {
#endif

#define QC_TYPE_SUBDIVISION_REPORT "qc.subdivision_report/1"

/* Lengths are in the units of the mesh. Distances are from samples of the limit surface to the
 * closest point of the mesh, 0 without a mesh. */
typedef struct qc_subdivision_report {
    qc_object object;
    int32_t n_vertices, n_faces, n_non_quads, n_creases; /* creases: sharp edges inside */
    int32_t valence[9];      /* inner vertices by number of edges, 8 = 8 and more          */
    int32_t n_extraordinary; /* inner vertices of other valence than 4                     */
    int32_t n_boundary_extraordinary; /* boundary vertices with more than 3 edges          */
    int32_t spacing;     /* fewest edges between two extraordinary vertices, 0 = none are
                            connected                                                  */
    double mean_spacing; /* of each to its nearest one                                 */
    int32_t n_crowded;   /* faces with two or more of them                             */
    int32_t levels, n_samples;
    double distance, mean_distance; /* largest, mean over the samples                      */
    double cage_distance;           /* of the cage vertices themselves to the mesh, largest */
    double vertex_distance;         /* largest of a limit position from its place in the input    */
    double jacobian;    /* smallest scaled Jacobian of the limit surface at the samples, < 0
                           where its normal is opposed to that of the mesh            */
    int64_t n_reversed; /* samples with a negative one                                */
    double
        normal_deviation; /* largest angle to the normal of the mesh, radians, where there is one */
    int32_t rounds;       /* of the fit, 0 = none                                       */
    double distance_before, mean_distance_before, vertex_distance_before; /* the fit       */
} qc_subdivision_report;

#ifdef __cplusplus
}
#endif
#endif
