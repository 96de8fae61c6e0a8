/* The built-in stages as an array; sdk/pipeline reads it through this one symbol. */
#include "sdk/pipeline/builtin.h"
#include <qc/stages.h>

#define QC_STAGE(symbol) &symbol,
const qc_stage *const qc__builtin_stages[] = {
#include "stages/stage_list.h"
    NULL};
#undef QC_STAGE
