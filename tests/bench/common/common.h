/* What the benchmarks share: failures end the program, surfaces with the field of the default
 * pipeline, and the matrix of qc.hodge with the cost of its ordering. */
#ifndef QC_BENCH_COMMON_H
#define QC_BENCH_COMMON_H

#include <qc/cover.h>
#include <qc/field.h>
#include <qc/sparse.h>

/* --- services.c ------------------------------------------------------------------------------- */

extern const char *const bench_program; /* defined by each program: its name in messages */
#if defined(__GNUC__)
__attribute__((noreturn, format(printf, 1, 2)))
#endif
void bench_die(const char *format, ...);
/* Ends the program with the context's message. */
void bench_check(qc_ctx *ctx, qc_status status);
void *bench_alloc(size_t count, size_t size); /* zeroed */
#define NEW(T, count) ((T *)bench_alloc((size_t)(count), sizeof(T)))
/* Next of a fixed sequence in [0, 1). */
double bench_uniform(uint64_t *state);

/* --- clock.c ---------------------------------------------------------------------------------- */

/* Seconds; cpu is that of the calling thread. */
typedef struct bench_duration {
    double wall, cpu;
} bench_duration;
typedef struct bench_samples {
    int32_t n, capacity;
    bench_duration *value;
} bench_samples;
bench_duration bench_clock(void);
void bench_sample(bench_samples *s, bench_duration d);
bench_duration bench_median(const bench_samples *s);

/* --- surface.c -------------------------------------------------------------------------------- */

/* A surface with a cross field: the steps of the default pipeline up to its matching, then `levels`
 * midpoint subdivisions with the cross of each face handed to its four parts, which lie in its
 * plane. */
typedef struct bench_source {
    const char *path; /* mesh file; NULL: a generated surface of genus 2, about 1000 faces */
    double quads;     /* density the field is made for                                     */
    int32_t levels;
    const char *cache; /* folder where fields are kept between runs, or NULL                */
} bench_source;
/* The mesh alone, before repair. */
qc_polygon_mesh *bench_read(qc_ctx *ctx, const char *path);
qc_matching *bench_surface(qc_ctx *ctx, const bench_source *source);
/* Edge length of so many quads. */
qc_sizing *bench_sizing(qc_ctx *ctx, const qc_mesh *mesh, double quads);
/* "bunny" of "meshes/bunny.off"; "generated" of NULL. */
void bench_stem(const char *path, size_t size, char *out);

/* --- matrix.c --------------------------------------------------------------------------------- */

/* Change of the matrix by one matching flip: D(k,l) += dl, D(k,m) += dm and the conjugates, which
 * is w[0] w[0]^H - w[1] w[1]^H on the rows (k, l, m). */
typedef struct bench_flip {
    int32_t row[3];
    qc_complex dl, dm;
    qc_complex w[2][3];
} bench_flip;

typedef struct bench_matrix {
    char name[64];
    int32_t faces;
    qc_hermitian A; /* borrowed from stiffness */
    qc_stiffness *stiffness;
    int32_t (*path)[3]; /* n x 3: rows of the flip of each edge, row[0] = -1 when it has none */
    double *position;   /* n x 3: midpoints of the edges */
    int32_t n_flips;
    bench_flip *flips;
} bench_matrix;

/* The non-conforming stiffness of qc.hodge and `flips` random flips. */
bench_matrix *bench_make_matrix(qc_ctx *ctx, const char *name, const qc_matching *matching,
                                int32_t flips);
void bench_matrix_free(bench_matrix *M);
/* b - (A + D) x, relative to |A| |x| + |b| (largest entries); f NULL = no D. */
double bench_residual(const bench_matrix *M, const bench_flip *f, const qc_complex *b,
                      const qc_complex *x);
void bench_random_vector(int64_t n, qc_complex *x);

/* --- quality.c: what an ordering costs, without any clock ------------------------------------- */

typedef struct bench_quality {
    double nnz, flops; /* of L; real operations of the complex factorisation                      */
    double touched;    /* entries of L on the path of a flip, mean over all edges */
} bench_quality;
bench_quality bench_order_quality(qc_ctx *ctx, const bench_matrix *M, const int32_t *perm);

#endif
