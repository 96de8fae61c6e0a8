/* qc_mumps.h - the plugin qc_mumps in a program which runs under MPI itself: "qc.mumps/1".
 *
 * The program starts MPI (MPI_THREAD_SERIALIZED if several threads solve) and loads the plugin on
 * each process of a communicator. Rank 0 of it calls use, solves, destroys its solver states and
 * calls release; the others call serve, which returns after release. The program ends MPI.
 *     qc_registry_find_interface(registry, QC_MUMPS_ID, NULL, &found)
 * comm is MPI_Comm_c2f of the communicator, which is duplicated. Error: ARGUMENT (MPI was not
 * started by the program before it loaded the plugin; wrong rank; use twice without release; solver
 * states which are not destroyed).
 * Thread rule: one thread at a time. */
#ifndef QC_MUMPS_H
#define QC_MUMPS_H

#include <qc/base.h>

#define QC_MUMPS_ID "qc.mumps/1"

typedef struct qc_mumps {
    qc_interface head;
    qc_status (*use)(qc_ctx *ctx, int comm);
    qc_status (*serve)(qc_ctx *ctx, int comm);
    qc_status (*release)(qc_ctx *ctx);
} qc_mumps;

#endif
