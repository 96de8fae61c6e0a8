/* The registry's view of the built-in stages and interfaces, defined in stages/stage_list.c: the
 * pipeline layer itself knows none. */
#ifndef QC_PIPELINE_BUILTIN_H
#define QC_PIPELINE_BUILTIN_H

#include <qc/stage.h>

extern const qc_stage *const qc__builtin_stages[]; /* NULL-terminated */

typedef struct qc__offer {
    const char *id;
    const qc_interface *table;
} qc__offer;
extern const qc__offer qc__builtin_interfaces[]; /* the last id is NULL */

#endif
