/* The processes of an MPI run as one solver: rank 0 runs the host program with the plugin, all
 * others run qc-mumps-worker and do what rank 0 says. Everything of MPI is behind this header.
 *
 * MUMPS wants every process to call it with the same job. Rank 0 sends each job to the workers
 * before it calls MUMPS itself; workers look for the next one every half millisecond, so that they
 * use no processor time while the host does other work. */
#ifndef QC_MUMPS_GROUP_H
#define QC_MUMPS_GROUP_H

#include <stdbool.h>
#include <stdint.h>
#include <zmumps_c.h>

enum {
    JOB_STOP = 0, /* leave qm_serve */
    JOB_BEGIN = -1,
    JOB_END = -2,
    JOB_ANALYZE = 1,
    JOB_FACTORIZE = 2,
    JOB_SOLVE = 3
};

/* Whether an MPI launcher has started this process: the others wait for it then. */
bool qm_has_launcher(void);

/* Starts MPI unless the host program has done so. NULL on success, else why there is no group (a
 * static text); the answer stays the same for the life of the process. In a host program which
 * started MPI itself the group is this process alone. Thread: any. */
const char *qm_start(void);
int qm_size(void); /* processes of the group, after qm_start */

/* Runs a job on all processes. JOB_BEGIN fills *id and takes a slot, its number on the workers;
 * JOB_END frees it. One job runs at a time, whatever the thread. */
void qm_run(int job, int *slot, ZMUMPS_STRUC_C *id);

/* The life of a worker: starts MPI, serves rank 0, ends MPI. NULL, or why it cannot. */
const char *qm_serve(void);

/* What qc_mumps.h says of use, serve and release. NULL, or what is wrong. */
const char *qm_join(int comm);
const char *qm_join_and_serve(int comm);
const char *qm_leave(void);

#endif
