/* Starting and ending MPI, and handing jobs to the workers. The state below is that of MPI, which a
 * process can start and end only once: it is ended when the process exits. */
#include "group.h"
#include <mpi.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { HOST = 1, WORKER = 2, TAG = 7411, HOST_RANK = 0 };

typedef struct command {
    int job, slot;
} command;

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static MPI_Comm group = MPI_COMM_NULL;
static const char *failure;
static bool started, foreign;    /* foreign: MPI is the program's */
static unsigned char *slot_used; /* numbers of the instances alive */
static int n_slots;

bool qm_has_launcher(void) {
    static const char *const names[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK",
                                        "PMI_SIZE"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (getenv(names[i])) return true;
    return false;
}

static const char *check_roles(int role) {
    int rank, size, hosts = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    int *roles = calloc((size_t)size, sizeof *roles);
    if (!roles) MPI_Abort(MPI_COMM_WORLD, 1);
    MPI_Allgather(&role, 1, MPI_INT, roles, 1, MPI_INT, MPI_COMM_WORLD);
    for (int i = 0; i < size; i++) hosts += roles[i] == HOST;
    const bool host_first = roles[HOST_RANK] == HOST;
    free(roles);
    if (hosts != 1 || !host_first)
        return "the first MPI process must run the program and all others qc-mumps-worker: "
               "mpirun -n 1 PROGRAM ... : -n N qc-mumps-worker";
    return MPI_Comm_dup(MPI_COMM_WORLD, &group) == MPI_SUCCESS ? NULL : "MPI_Comm_dup failed";
}

/* A process without launcher needs no daemon of Open MPI beside it (which would want ssh). */
static void init(void) {
    static const char alone[] = "OMPI_MCA_ess_singleton_isolated";
    int provided;
    const bool set = !qm_has_launcher() && !getenv(alone);
    if (set) setenv(alone, "1", 1);
    MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided);
    if (set) unsetenv(alone);
}

static void send(command c) {
    const int size = qm_size();
    for (int rank = 1; rank < size; rank++) MPI_Send(&c, 2, MPI_INT, rank, TAG, group);
}

static void finish(void) {
    int finalized;
    MPI_Finalized(&finalized);
    if (finalized) return;
    if (group != MPI_COMM_NULL) {
        send((command){JOB_STOP, 0});
        MPI_Comm_free(&group);
    }
    MPI_Finalize();
}

static const char *start(int role) {
    int initialized, finalized;
    MPI_Initialized(&initialized);
    MPI_Finalized(&finalized);
    if (finalized) return "MPI was ended before";
    if (initialized) {
        foreign = true;
        group = MPI_COMM_SELF;
        return NULL;
    }
    init();
    const char *reason = check_roles(role);
    if (role == HOST && atexit(finish) != 0) return "atexit failed";
    return reason;
}

const char *qm_start(void) {
    pthread_mutex_lock(&mutex);
    if (!started) {
        started = true;
        failure = start(HOST);
    }
    pthread_mutex_unlock(&mutex);
    return failure;
}

int qm_size(void) {
    int size = 1;
    if (group != MPI_COMM_NULL) MPI_Comm_size(group, &size);
    return size;
}

/* -1 when memory runs out. */
static int take_slot(void) {
    int slot = 0;
    while (slot < n_slots && slot_used[slot]) slot++;
    if (slot == n_slots) {
        unsigned char *more = realloc(slot_used, (size_t)n_slots + 1);
        if (!more) return -1;
        slot_used = more;
        n_slots++;
    }
    slot_used[slot] = 1;
    return slot;
}

static void begin(ZMUMPS_STRUC_C *id) {
    memset(id, 0, sizeof *id);
    id->comm_fortran = (MUMPS_INT)MPI_Comm_c2f(group);
    id->par = 1; /* the host process computes, too */
    id->sym = 0;
    id->job = JOB_BEGIN;
    zmumps_c(id);
    for (int i = 0; i < 4; i++) id->icntl[i] = 0; /* ICNTL(1..4): nothing is printed */
}

void qm_run(int job, int *slot, ZMUMPS_STRUC_C *id) {
    pthread_mutex_lock(&mutex);
    if (job == JOB_BEGIN) *slot = take_slot();
    if (*slot < 0) {
        memset(id, 0, sizeof *id);
        id->infog[0] = -13; /* as when MUMPS cannot allocate */
    } else {
        send((command){job, *slot});
        if (job == JOB_BEGIN) {
            begin(id);
        } else {
            id->job = job;
            zmumps_c(id);
        }
        if (job == JOB_END) slot_used[*slot] = 0;
    }
    pthread_mutex_unlock(&mutex);
}

/* --- worker ----------------------------------------------------------------------------------- */

static command receive(void) {
    const struct timespec pause = {0, 500000};
    command c = {JOB_STOP, 0};
    int there = 0;
    for (;;) {
        MPI_Iprobe(HOST_RANK, TAG, group, &there, MPI_STATUS_IGNORE);
        if (there) break;
        nanosleep(&pause, NULL);
    }
    MPI_Recv(&c, 2, MPI_INT, HOST_RANK, TAG, group, MPI_STATUS_IGNORE);
    return c;
}

static void obey(command c, ZMUMPS_STRUC_C ***table, int *n) {
    if (c.slot >= *n) {
        *table = realloc(*table, ((size_t)c.slot + 1) * sizeof **table);
        if (!*table) MPI_Abort(MPI_COMM_WORLD, 1);
        while (*n <= c.slot) (*table)[(*n)++] = NULL;
    }
    ZMUMPS_STRUC_C **id = &(*table)[c.slot];
    if (c.job == JOB_BEGIN) {
        *id = malloc(sizeof **id);
        if (!*id) MPI_Abort(MPI_COMM_WORLD, 1);
        begin(*id);
        return;
    }
    (*id)->job = c.job;
    zmumps_c(*id);
    if (c.job != JOB_END) return;
    free(*id);
    *id = NULL;
}

static void serve(void) {
    ZMUMPS_STRUC_C **table = NULL;
    int n = 0;
    for (command c = receive(); c.job != JOB_STOP; c = receive()) obey(c, &table, &n);
    free(table);
    MPI_Comm_free(&group);
}

const char *qm_serve(void) {
    const char *reason = start(WORKER);
    if (!reason) serve();
    MPI_Finalize();
    return reason;
}

/* --- programs under MPI ----------------------------------------------------------------------- */

static bool has_states(void) {
    for (int i = 0; i < n_slots; i++)
        if (slot_used[i]) return true;
    return false;
}

static const char *join(int comm, bool first) {
    const MPI_Comm whole = MPI_Comm_f2c((MPI_Fint)comm);
    int rank;
    if (qm_start() || !foreign) return "the program has to start MPI before it loads the plugin";
    if (group != MPI_COMM_SELF) return "a communicator is in use; release it first";
    if (has_states()) return "destroy the solver states first";
    MPI_Comm_rank(whole, &rank);
    if ((rank == HOST_RANK) != first) return "rank 0 calls use, all others serve";
    return MPI_Comm_dup(whole, &group) == MPI_SUCCESS ? NULL : "MPI_Comm_dup failed";
}

const char *qm_join(int comm) {
    return join(comm, true);
}

const char *qm_join_and_serve(int comm) {
    const char *reason = join(comm, false);
    if (reason) return reason;
    serve();
    group = MPI_COMM_SELF;
    return NULL;
}

const char *qm_leave(void) {
    if (!foreign || group == MPI_COMM_SELF) return "no communicator is in use";
    if (has_states()) return "destroy the solver states first";
    send((command){JOB_STOP, 0});
    MPI_Comm_free(&group);
    group = MPI_COMM_SELF;
    return NULL;
}
