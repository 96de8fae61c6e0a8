/* The benchmark of qc/sparse.h against its peers: what its files share.
 *
 * A `peer` is one library behind a struct of functions, ours included; a `runner` is a peer with an
 * ordering and a number of threads, at work on one matrix. Failures end the program: bench_die. */
#ifndef QC_BENCH_SPARSE_H
#define QC_BENCH_SPARSE_H

#include "tests/bench/common/common.h"

/* --- peers ------------------------------------------------------------------------------------ */

/* PLACED: dissection which is told where the rows are; ours only. */
enum { ORDER_GIVEN, ORDER_AMD, ORDER_DISSECTION, ORDER_PLACED, ORDER_KINDS };

/* Calls of one peer on its own state; NULL where it has no such operation. */
typedef struct bench_peer {
    const char *name;
    void *(*create)(const bench_matrix *M, int ordering, const int32_t *perm, uint32_t threads);
    void (*analyze)(void *self);
    void (*factor)(void *self); /* a new factor */
    void (*refactor)(void *self);
    void (*forward)(void *self, qc_complex *x); /* |x|^2 becomes b^H A^{-1} b */
    void (*solve)(void *self, int32_t nrhs, qc_complex *x);
    void (*flip)(void *self, const bench_flip *f, int direction); /* +1 applies, -1 undoes */
    void (*undo)(void *self); /* takes the last flip back from records, without computing */
    /* From now on flips keep the forward solution of b, and energy tells |y|^2; b NULL ends it. */
    void (*carry)(void *self, const qc_complex *b);
    double (*energy)(void *self);
    double (*stored)(void *self); /* entries of the factor, with explicit zeros */
    void (*drop)(void *self);     /* the factor, not the analysis */
    void (*destroy)(void *self);
} bench_peer;
extern const bench_peer peer_quadcover, peer_cholmod, peer_cxsparse;
#ifdef BENCH_MUMPS
extern const bench_peer peer_mumps;
#endif

/* Orderings alone: perm of n. */
void order_quadcover(const bench_matrix *M, int ordering, int32_t *perm);
void order_metis(const bench_matrix *M, int32_t *perm);

/* --- measure.c: operations and interleaving -------------------------------------------------- */

enum {
    OP_ANALYZE,
    OP_FACTOR,
    OP_REFACTOR,
    OP_FORWARD,
    OP_SOLVE,
    OP_SOLVE16,
    OP_FLIP,
    OP_UNDO,
    OP_CARRY,
    OP_COUNT
};

typedef struct bench_runner {
    const char *label;
    const bench_peer *peer;
    int ordering;
    const int32_t *perm;
    uint32_t threads;
    void *self;
    bench_samples samples[OP_COUNT];
    bench_duration time[OP_COUNT]; /* medians, 0 = not measured                                  */
    double stored, residual;
    double peak; /* bytes, see memory.c */
} bench_runner;

typedef struct bench_plan {
    bool op[OP_COUNT];
    int32_t repeat;
    double seconds; /* a runner which has used up these gets no further turn */
    double memory;  /* bytes, about what the largest factor takes            */
    bool keep;      /* all factors stay in memory between the rounds         */
} bench_plan;
/* Every round visits all runners in turn, so that a disturbance hits all of them alike. Checks
 * every solution. */
void bench_measure(const bench_matrix *M, int32_t n, bench_runner *runners, const bench_plan *plan);
void bench_runner_clear(bench_runner *r);
/* Peak of the resident memory during analysis and factorisation, in a child of its own. */
double bench_peak_memory(const bench_matrix *M, const bench_runner *r);

/* --- limits.c --------------------------------------------------------------------------------- */

typedef struct bench_limits {
    double fma, fma_avx2; /* flop/s of one core, widest instructions / AVX2; 0 = not there */
    double zgemm[3];      /* n = 8, 32, 128 */
    double l2, l3, memory, memory2; /* bytes/s read and written in place; memory2: by two cores */
    double l2_size, l3_size;        /* bytes, 0 = unknown */
} bench_limits;
extern const int32_t bench_zgemm_size[3];
bench_limits bench_measure_limits(void);

/* --- report.c, report_summary.c, report_json.c ------------------------------------------------ */

enum { MOST_COLUMNS = 6, MOST_ROWS = 32 };

/* One comparison. Printed as peer / ours: above 1 ours is better. */
typedef struct bench_row {
    const char *name, *unit;
    double ours, peer[MOST_COLUMNS]; /* 0 = not measured                */
    double reach[MOST_COLUMNS];      /* what peer / ours is to be, 0 = no such figure */
    const char *other;               /* another way of ours, NULL = none                    */
    double other_value, other_reach; /* other_value / ours is to be so much */
    double rate, percent;            /* of work or traffic, and that of the limit; 0 = none */
    const char *rate_unit;
} bench_row;
typedef struct bench_table {
    const char *title;
    int columns, rows;
    const char *column[MOST_COLUMNS];
    bench_row row[MOST_ROWS];
} bench_table;
bench_row *bench_add_row(bench_table *t, const char *name, const char *unit, double ours);

enum { TABLE_ORDER, TABLE_SAME, TABLE_OWN, TABLES };
typedef struct bench_comparison {
    char name[64];
    int32_t faces, n;
    double nnz, residual; /* of A, upper triangle; largest of all libraries */
    bench_table table[TABLES];
} bench_comparison;

enum { FORMAT_TEXT, FORMAT_MARKDOWN };
void bench_print_limits(const bench_limits *l, int format);
void bench_print_comparison(const bench_comparison *c, int format);
/* The ratios to be reached over all meshes. */
void bench_print_summary(int32_t n, const bench_comparison *c, int format);
void bench_write_json(const char *path, const bench_limits *l, int32_t n,
                      const bench_comparison *c);

/* --- compare.c, rows.c ------------------------------------------------------------------------ */

enum { PART_ORDER = 1, PART_FACTOR = 2, PART_SOLVE = 4, PART_UPDATE = 8, PART_MEMORY = 16 };
typedef struct bench_effort {
    unsigned parts; /* PART_... */
    int32_t repeat;
    double seconds;    /* per library and ordering                             */
    bool same, own;    /* which tables                                         */
    const char *peers; /* only those whose name is part of this; NULL = all    */
} bench_effort;
/* Fills the tables of *out. */
void bench_compare(qc_ctx *ctx, const bench_matrix *M, const bench_limits *l,
                   const bench_effort *effort, bench_comparison *out);

/* Positions among the runners: ours by one thread, by two, and by two with AMD (the last one only
 * where each has its own ordering). Columns are those from L->peers on. */
enum { OURS, OURS_2, OURS_AMD_2, MOST_OURS };
typedef struct bench_lineup {
    const bench_matrix *M;
    const bench_limits *limits;
    const bench_effort *effort;
    bool own;              /* each with its own ordering */
    bench_quality quality; /* of our ordering            */
    int n, peers;
    bench_runner runner[MOST_OURS + MOST_COLUMNS];
    bench_table *table;
} bench_lineup;
/* What was measured becomes rows of L->table, with the figures to be reached. */
void bench_memory_row(bench_lineup *L);
void bench_analysis_rows(bench_lineup *L);
void bench_factor_rows(bench_lineup *L);
void bench_solve_rows(bench_lineup *L);
void bench_update_rows(bench_lineup *L);
void bench_order_rows(bench_table *t, int ordering, double seconds, const bench_quality *q,
                      double metis_seconds, const bench_quality *metis);

/* --- arguments.c ------------------------------------------------------------------------------ */

typedef struct bench_arguments {
    char *only, *part, *table, *peers, *json, *cache;
    int repeat, flips, markdown, smoke;
    double seconds;
    const char **mesh; /* path[:levels] ..., NULL = the standard set */
    void *storage;
} bench_arguments;
bench_arguments bench_parse(int argc, char **argv);
void bench_arguments_clear(bench_arguments *a);
bench_effort bench_arguments_effort(const bench_arguments *a);

#endif
