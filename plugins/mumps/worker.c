/* qc-mumps-worker: the processes after the first one of an MPI run with the plugin qc_mumps.
 *     mpirun -n 1 quadcover remesh ... --plugin qc_mumps.so : -n 7 qc-mumps-worker */
#include "group.h"
#include <stdio.h>
#include <string.h>

int main(int argc, char **argv) {
    if (argc > 1) {
        const bool help = strcmp(argv[1], "--help") == 0;
        fprintf(help ? stdout : stderr,
                "Usage: mpirun -n 1 PROGRAM ... : -n N qc-mumps-worker\n"
                "Does the part of N processes in what the first one solves with qc_mumps.\n");
        return help ? 0 : 2;
    }
    const char *reason =
        qm_has_launcher() ? qm_serve() : "no MPI launcher has started this process";
    if (reason) fprintf(stderr, "qc-mumps-worker: error: %s\n", reason);
    return reason ? 1 : 0;
}
