/* qc/stages.h - the built-in stages as tables, for programs that embed one of them without a
 * registry:
 *
 *     qc_stage_run(ctx, &qc_stage_hodge, NULL, bag);
 *
 * `quadcover stages NAME` prints ports and parameters of each. */
#ifndef QC_STAGES_H
#define QC_STAGES_H

#include <qc/stage.h>

#ifdef __cplusplus
extern "C" {
#endif

QC_API extern const qc_stage qc_stage_repair;           /* qc.repair          */
QC_API extern const qc_stage qc_stage_features;         /* qc.features        */
QC_API extern const qc_stage qc_stage_size;             /* qc.size            */
QC_API extern const qc_stage qc_stage_split_features;   /* qc.split.features  */
QC_API extern const qc_stage qc_stage_field_curvature;  /* qc.field.curvature */
QC_API extern const qc_stage qc_stage_field_smooth;     /* qc.field.smooth    */
QC_API extern const qc_stage qc_stage_field_cosine;     /* qc.field.cosine    */
QC_API extern const qc_stage qc_stage_field_smoothest;  /* qc.field.smoothest */
QC_API extern const qc_stage qc_stage_field_import;     /* qc.field.import    */
QC_API extern const qc_stage qc_stage_field_scalar;     /* qc.field.scalar   */
QC_API extern const qc_stage qc_stage_matching;         /* qc.matching        */
QC_API extern const qc_stage qc_stage_optimize_merge;   /* qc.optimize.merge */
QC_API extern const qc_stage qc_stage_optimize_cancel;  /* qc.optimize.cancel */
QC_API extern const qc_stage qc_stage_optimize_curl;    /* qc.optimize.curl */
QC_API extern const qc_stage qc_stage_optimize_balance; /* qc.optimize.balance */
QC_API extern const qc_stage qc_stage_split;            /* qc.split           */
QC_API extern const qc_stage qc_stage_open;             /* qc.open           */
QC_API extern const qc_stage qc_stage_hodge;            /* qc.hodge           */
QC_API extern const qc_stage qc_stage_round;            /* qc.round           */
QC_API extern const qc_stage qc_stage_untangle;         /* qc.untangle        */
QC_API extern const qc_stage qc_stage_extract;          /* qc.extract         */
QC_API extern const qc_stage qc_stage_finish;           /* qc.finish          */
QC_API extern const qc_stage qc_stage_measure;          /* qc.measure         */

#ifdef __cplusplus
}
#endif
#endif
