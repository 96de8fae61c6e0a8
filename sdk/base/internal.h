/* Internal services of sdk/base: memory, errors, progress, threads. Not installed.
 *
 * Blocks know their allocator (a header in front of each one), so qc__free needs no context and
 * objects may outlive the context which made them. All blocks are 64-byte aligned. */
#ifndef QC_BASE_INTERNAL_H
#define QC_BASE_INTERNAL_H

#include <qc/base.h>
#include <stdio.h>

#if defined(__GNUC__)
#define QC__PRINTF(fmt, first) __attribute__((format(printf, fmt, first)))
#else
#define QC__PRINTF(fmt, first)
#endif

/* --- memory ----------------------------------------------------------------------------------- */

/* count * size bytes, uninitialised; NULL on overflow or when the allocator refuses (the context's
 * error is then set to NOMEM). A zero-byte request returns a valid pointer. Thread: any. */
void *qc__malloc(qc_ctx *ctx, size_t count, size_t size);
void *qc__calloc(qc_ctx *ctx, size_t count, size_t size);
/* Grows or shrinks; p may be NULL. On failure p is untouched. */
void *qc__realloc(qc_ctx *ctx, void *p, size_t count, size_t size);
void qc__free(void *p); /* NULL is fine */

/* Gives back what an array has beyond `count` elements; returns false, the array untouched, when
 * the allocator refuses. */
bool qc__shrink(qc_ctx *ctx, void **array, int64_t count, size_t size);

#define QC__NEW(ctx, T, count)  ((T *)qc__malloc((ctx), (size_t)(count), sizeof(T)))
#define QC__ZERO(ctx, T, count) ((T *)qc__calloc((ctx), (size_t)(count), sizeof(T)))

/* Makes room for at least `need` elements in a growing array (doubling); returns false on failure.
 */
bool qc__reserve(qc_ctx *ctx, void **array, int64_t *capacity, int64_t need, size_t size);

/* Arena: many small blocks freed together. Blocks are 16-byte aligned. */
typedef struct qc__arena qc__arena;
qc__arena *qc__arena_create(qc_ctx *ctx);
void *qc__arena_alloc(qc__arena *arena, size_t bytes); /* NULL when memory runs out */
void qc__arena_free(qc__arena *arena);                 /* NULL is fine */

/* --- errors, log, progress -------------------------------------------------------------------- */

/* Records the error and returns status, so that `return qc__fail(...)` reads well. */
qc_status qc__fail(qc_ctx *ctx, qc_status status, int64_t where, const char *format, ...)
    QC__PRINTF(4, 5);
qc_status qc__nomem(qc_ctx *ctx);
void qc__clear_error(qc_ctx *ctx);
void qc__log(qc_ctx *ctx, int32_t level, const char *format, ...) QC__PRINTF(3, 4);

/* Reports `fraction` of the innermost range; false means: clean up and return QC_ERR_CANCELLED (the
 * error is already recorded). Calling thread only; cheap enough for every few hundred microseconds
 * of work. Without a callback always true. */
bool qc__progress(qc_ctx *ctx, double fraction);
/* Asks whether to go on: OK or CANCELLED; bars stay where they are (the fraction is 0 again). For
 * steps of a tenth of a second on a million faces between which nothing else asks. */
qc_status qc__poll(qc_ctx *ctx);
/* True once the callback asked to stop; any thread may poll it inside a parallel_for. */
bool qc__cancelled(const qc_ctx *ctx);

/* Nested ranges: inside begin/end a fraction f is reported as lo + f (hi - lo) of the outer range,
 * never less than before within the outermost one: loops which start again do not run a bar back.
 * stage NULL keeps the name of the outer range. */
typedef struct qc__range {
    double lo, hi;
    const char *stage;
    int32_t depth; /* 0: outside of all ranges */
} qc__range;
qc__range qc__range_begin(qc_ctx *ctx, const char *stage, double lo, double hi);
void qc__range_end(qc_ctx *ctx, qc__range outer);

/* What the step under way has to say beside its fraction, until the next step begins. */
void qc__detail(qc_ctx *ctx, const char *format, ...) QC__PRINTF(2, 3);

/* --- time budget ------------------------------------------------------------------------------ */

typedef struct qc__time {
    double end, step_end; /* of the budget, of what the step under way may use; INFINITY = none  */
    double start, fixed;  /* of the step; seconds of those before which never asked              */
    bool asked, late;     /* the step asked whether it is late; it was                           */
} qc__time;
/* Asked by loops which improve a valid result, before each improvement: true when the time of the
 * step is over; they then end as if nothing were left to improve. The first time a warning says so.
 * Calling thread only. */
bool qc__out_of_time(qc_ctx *ctx);
/* Seconds which the step may still use; INFINITY without a budget. */
double qc__time_left(const qc_ctx *ctx);
/* Around a step of a pipeline. */
qc__time qc__time_begin_step(qc_ctx *ctx);
void qc__time_end_step(qc_ctx *ctx, qc__time outer);
/* Around a part of the work, such as a component, which may use that share of what is left. */
qc__time qc__time_share(qc_ctx *ctx, double share);
void qc__time_end_share(qc_ctx *ctx, qc__time outer);

/* --- threads ---------------------------------------------------------------------------------- */

/* Calls body(arg, begin, end, worker) for [0,n) in chunks of `chunk`, on up to qc_ctx_threads
 * threads; worker < qc_ctx_threads. Chunk boundaries do not depend on the number of threads, so a
 * body which writes per-index or per-chunk results gives the same bits on any machine. Bodies must
 * not call qc__fail, qc__progress or qc__log. Nested calls run serially. */
typedef void qc__body(void *arg, int64_t begin, int64_t end, uint32_t worker);
void qc__parallel_for(qc_ctx *ctx, int64_t n, int64_t chunk, qc__body *body, void *arg);

/* --- vector instructions ---------------------------------------------------------------------- */

/* Order matters: a processor with one set has those before it. */
typedef enum qc__isa { QC__PORTABLE, QC__AVX2, QC__AVX512, QC__ISAS } qc__isa;
qc__isa qc__ctx_isa(const qc_ctx *ctx);
/* The set with this name (NULL = the best one) if the processor has it. */
qc_status qc__isa_select(const char *name, qc__isa *out);
const char *qc__isa_name(qc__isa isa);

/* --- text and files --------------------------------------------------------------------------- */

/* Writing so that no partial file is ever left: a temporary beside the target, renamed on success.
 * "-" writes to stdout. commit returns IO when anything failed and removes the temporary. */
typedef struct qc__writer {
    FILE *file;
    char *path, *temporary; /* NULL for stdout */
} qc__writer;
qc_status qc__writer_open(qc_ctx *ctx, const char *path, qc__writer *out);
qc_status qc__writer_commit(qc_ctx *ctx, qc__writer *writer);
void qc__writer_abort(qc__writer *writer);

/* Reads a whole file ("-" = stdin) into a NUL-terminated block; caller frees with qc__free. Errors:
 * IO (missing, directory, unreadable), NOMEM. */
qc_status qc__read_file(qc_ctx *ctx, const char *path, char **data, size_t *size);

/* Locale-independent strtod / "%.17g": the host may have set a locale with a decimal comma. */
double qc__parse_double(const char *text, char **end);
/* The shortest which round-trips, cut to `size` with its end; returns its whole length. */
int qc__print_double(char *buffer, size_t size, double value);

double qc__now(void); /* monotonic seconds, for reports only */

#endif
