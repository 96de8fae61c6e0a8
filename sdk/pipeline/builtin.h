/* The registry's view of the built-in stages, defined in stages/stage_list.c: the pipeline layer
 * itself knows no stage. */
#ifndef QC_PIPELINE_BUILTIN_H
#define QC_PIPELINE_BUILTIN_H

#include <qc/stage.h>

extern const qc_stage *const qc__builtin_stages[]; /* NULL-terminated */

#endif
