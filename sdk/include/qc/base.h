/* qc/base.h - status codes, contexts, callbacks and shared objects.
 *
 * Everything else in the SDK builds on this header; it needs only the C standard headers. A context
 * (`qc_ctx`) belongs to one thread of control at a time and carries the allocator, the worker pool,
 * the callbacks and the last error. Objects (`qc_object`) are immutable once published and may be
 * shared by any number of threads and contexts. */
#ifndef QC_BASE_H
#define QC_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define QC_EXPORT __declspec(dllexport)
#else
#define QC_EXPORT __attribute__((visibility("default")))
#endif
#ifndef QC_API
#define QC_API QC_EXPORT
#endif

#define QC_VERSION_MAJOR  0
#define QC_VERSION_MINOR  1
#define QC_VERSION_PATCH  0
#define QC_VERSION_STRING "0.1.0"

/* --- status ----------------------------------------------------------------------------------- */

typedef int32_t qc_status; /* fixed width: crosses the plugin ABI; append, never renumber */
enum {
    QC_OK = 0,
    QC_ERR_ARGUMENT = -1,     /* the caller broke a documented precondition                       */
    QC_ERR_NOMEM = -2,        /* the context's allocator returned NULL                            */
    QC_ERR_CANCELLED = -3,    /* the progress callback said stop                                  */
    QC_ERR_NOT_POSDEF = -4,   /* where = failing pivot in the caller's numbering                  */
    QC_ERR_NON_MANIFOLD = -5, /* where = offending edge or vertex                                 */
    QC_ERR_ABI = -6,          /* plugin or struct from an incompatible version                    */
    QC_ERR_INPUT = -7,        /* unusable input data; where = line, byte or element               */
    QC_ERR_IO = -8,           /* a file could not be read or written                              */
    QC_ERR_NOT_FOUND = -9,    /* unknown name; the text offers the closest one                    */
    QC_ERR_WIRING = -10,      /* the ports of a pipeline do not fit; where = step                 */
    QC_ERR_FAILED = -11,      /* the computation has no valid result; where = face, vertex, ...   */
    QC_ERR_UNSUPPORTED = -12  /* a feature this build does not have                               */
};

/* Short lower-case name of a status ("ok", "cancelled", ...); "unknown status" for other values. */
QC_API const char *qc_status_name(qc_status status);

/* "0.1.0": the version of the loaded library (QC_VERSION_STRING is that of the header). */
QC_API const char *qc_version(void);

/* The entry of names[0..n) nearest to `name` by edit distance, also without its prefix up to the
 * last dot; NULL when none is near. For messages about unknown names. Thread: any. */
QC_API const char *qc_closest_name(const char *name, const char *const *names, size_t n);

/* --- context ---------------------------------------------------------------------------------- */

typedef struct qc_ctx qc_ctx;

enum { QC_LOG_DEBUG = 0, QC_LOG_INFO = 1, QC_LOG_WARNING = 2, QC_LOG_ERROR = 3 };

typedef struct qc_ctx_options {
    uint32_t struct_size; /* = sizeof, set by QC_CTX_OPTIONS_INIT */
    uint32_t threads; /* 0 = all cores; never changes a result, only its time                  */
    /* One allocator callback: p NULL allocates, new_size 0 frees (returns NULL), else resizes.
     * Returned blocks need alignof(max_align_t). Called from any thread of the pool. NULL =
     * realloc. */
    void *(*resize)(void *user, void *p, size_t old_size, size_t new_size);
    /* One line of text without newline; stage may be "". NULL = discard. Calling thread only. */
    void (*log)(void *user, int32_t level, const char *stage, const char *text);
    /* fraction in [0,1] of the whole run; false cancels. Calling thread only. NULL = never cancel.
     */
    bool (*progress)(void *user, const char *stage, double fraction);
    void *user;
    /* Vector instructions of the numerical kernels: "avx512", "avx2" or "portable"; NULL = the best
     * the processor has. Results are bit for bit repeatable for each; they round differently. */
    const char *instructions;
    /* One point of a curve which a stage draws while it works, such as "E_D_rel" (percent) and
     * "branch_points" over the evaluations x of an optimisation; x never falls within a stage. NULL
     * = discard. Calling thread only. */
    void (*sample)(void *user, const char *stage, const char *curve, double x, double y);
} qc_ctx_options;
#define QC_CTX_OPTIONS_INIT                                                                        \
    { sizeof(qc_ctx_options), 0, NULL, NULL, NULL, NULL, NULL, NULL }

typedef struct qc_error {
    qc_status status;
    int64_t where; /* element the error is about (see status); -1 = none                          */
    const char *stage, *text; /* never NULL; text is one line */
} qc_error;

/* options NULL = defaults. The caller owns *out. Errors: ARGUMENT (also: unknown instructions),
 * NOMEM, UNSUPPORTED (instructions which the processor lacks). Thread: any. */
QC_API qc_status qc_ctx_create(const qc_ctx_options *options, qc_ctx **out);
/* NULL is fine; cannot fail. Objects made through the context may outlive it as long as the
 * allocator's user data does. */
QC_API void qc_ctx_free(qc_ctx *ctx);
/* Detail of the last failed call through ctx; borrowed, valid until the next call through ctx. */
QC_API const qc_error *qc_ctx_error(const qc_ctx *ctx);
/* Number of threads the context may use (>= 1). */
QC_API uint32_t qc_ctx_threads(const qc_ctx *ctx);
/* Name of the vector instructions in use: "avx512", "avx2" or "portable". Static text. */
QC_API const char *qc_ctx_instructions(const qc_ctx *ctx);

/* For code outside the library that is called with a context: records an error (one line of text,
 * copied) and returns its status, FAILED when that is QC_OK. */
QC_API qc_status qc_ctx_fail(qc_ctx *ctx, qc_status status, int64_t where, const char *text);
/* Reports the fraction done of the call under way; false: clean up and return QC_ERR_CANCELLED,
 * which is recorded. */
QC_API bool qc_ctx_progress(qc_ctx *ctx, double fraction);
/* Passes a point to qc_ctx_options.sample. */
QC_API void qc_ctx_sample(qc_ctx *ctx, const char *curve, double x, double y);
/* What the step under way says about itself, such as "E_D 0.93 %, 64 branch points, ..."; "" when
 * nothing. Borrowed, for use within the progress callback. */
QC_API const char *qc_ctx_progress_detail(const qc_ctx *ctx);

/* A time which what follows through ctx aims at, in seconds from now; negative = none (default).
 * Loops which improve a result that is valid already (the optimisation of branch points, the search
 * for integers) then end early with what they have, and log a warning; what must be done is done,
 * however long it takes. 0 = improve nothing. Results then depend on the speed of the machine. */
QC_API void qc_ctx_set_time_budget(qc_ctx *ctx, double seconds);
/* For such loops, in stages of others, too: whether the step under way has used up its part. Always
 * false outside steps of a pipeline. */
QC_API bool qc_ctx_out_of_time(qc_ctx *ctx);

/* --- objects ---------------------------------------------------------------------------------- */

/* First member of everything that travels through a pipeline port. `type` is the port's type id
 * ("qc.mesh/1"): a string with static lifetime which carries its version. Published objects are
 * immutable; retain/release are thread-safe. Third parties define types of their own by starting
 * their struct with a qc_object and calling qc_object_init. */
typedef struct qc_object {
    const char *type;
    void (*destroy)(struct qc_object *); /* frees the whole object; called by the last release */
    int32_t references; /* access through retain/release only                     */
    int32_t reserved;
} qc_object;

/* Sets type and destroy, reference count 1 (owned by the caller). */
QC_API void qc_object_init(qc_object *object, const char *type, void (*destroy)(qc_object *));
/* Adds a reference; returns its argument. NULL is fine. Thread: any. */
QC_API void *qc_object_retain(const void *object);
/* Drops a reference, destroying at zero. NULL is fine. Thread: any. */
QC_API void qc_object_release(const void *object);

/* --- interfaces ------------------------------------------------------------------------------- */

/* First member of every table that is offered by id and name, such as a qc_solver ("qc.solver/1").
 * The id, which carries its version, says what follows; struct_size, which members exist. */
typedef struct qc_interface {
    uint32_t struct_size; /* of the whole table  */
    uint32_t flags;       /* defined by the id   */
    const char *name;     /* "builtin", "mumps"  */
    const char *doc;      /* one line, or NULL   */
} qc_interface;

/* --- numbers ---------------------------------------------------------------------------------- */

typedef struct qc_complex {
    double re, im;
} qc_complex; /* layout of C99 double _Complex and numpy complex128 */

#ifdef __cplusplus
}
#endif
#endif
