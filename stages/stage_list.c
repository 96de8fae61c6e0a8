/* The built-in stages as an array; sdk/pipeline reads it through this one symbol. */
#include "sdk/pipeline/builtin.h"

#define QC_STAGE(symbol) extern const qc_stage symbol;
#include "stages/stage_list.h"
#undef QC_STAGE

#define QC_STAGE(symbol) &symbol,
const qc_stage *const qc__builtin_stages[] = {
#include "stages/stage_list.h"
    NULL};
#undef QC_STAGE
