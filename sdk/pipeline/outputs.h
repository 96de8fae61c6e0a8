/* Publishing what a stage made. */
#ifndef QC_PIPELINE_OUTPUTS_H
#define QC_PIPELINE_OUTPUTS_H

#include <qc/stage.h>

typedef struct qc__output {
    const char *port;
    void *object; /* NULL = an optional output which is absent */
} qc__output;

/* Moves the caller's references to n outputs; after a failure the rest is released. */
static inline qc_status qc__publish(const qc_run *run, int n, const qc__output *output) {
    qc_status status = QC_OK;
    for (int i = 0; i < n; i++)
        if (status != QC_OK)
            qc_object_release(output[i].object);
        else if (output[i].object)
            status = run->output(run, output[i].port, output[i].object);
    return status;
}

#endif
