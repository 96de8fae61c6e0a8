/* Cross fields, covers, seams and seamless maps on the shapes of qc/shape.h, for the tests of
 * rounding. */
#ifndef QC_TESTS_SEAMLESS_H
#define QC_TESTS_SEAMLESS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <qc/shape.h>

#include "sdk/map/periods/period_matrix.h"
#include "sdk/map/round/separation.h"

typedef double _Complex complex_t;

#define must(ctx, call)                                                                            \
    do {                                                                                           \
        if ((call) != QC_OK) fail_msg("%s", qc_ctx_error(ctx)->text);                              \
    } while (0)

static inline void *zeroed(int64_t count, size_t size) {
    void *p = calloc((size_t)count + 1, size);
    assert_non_null(p);
    return p;
}
#define ARRAY(T, count) ((T *)zeroed((count), sizeof(T)))

static inline double uniform(uint64_t *state) { /* [-1, 1) */
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 4503599627370496.0 - 1;
}
static inline double random_integer(uint64_t *state, double size) {
    return rint(size * uniform(state));
}

static inline qc_ctx *context(uint32_t threads) {
    qc_ctx *ctx = NULL;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.threads = threads;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    return ctx;
}

/* How the crosses and the matching of a case are made. */
typedef enum field_kind {
    SMOOTH,    /* the smoothest field: few cones                                               */
    ROUGH,     /* smoothest, then crosses turned at random by up to 0.6 rad: many cones         */
    ANY_TURNS, /* smoothest, with turns -4..4 added on some edges: all kinds of indices        */
    MERIDIANS  /* along the circles about the z axis: no cone and no holonomy on the torus       */
} field_kind;

typedef struct surface_case {
    const char *shape;
    int32_t resolution, genus;
    double noise;
    field_kind kind;
} surface_case;

static inline qc_mesh *case_mesh(qc_ctx *ctx, const surface_case *c) {
    qc_shape_options options = QC_SHAPE_OPTIONS_INIT;
    options.resolution = c->resolution;
    options.noise = c->noise;
    options.genus = c->genus;
    qc_mesh *mesh = NULL;
    must(ctx, qc_shape_create(ctx, c->shape, &options, &mesh));
    return mesh;
}

/* Crosses along the circles about the z axis. */
static inline void meridians(qc_ctx *ctx, const qc_mesh *mesh, qc_complex *x) {
    double *re = ARRAY(double, 3 * (int64_t)mesh->n_faces),
           *im = ARRAY(double, 3 * (int64_t)mesh->n_faces);
    must(ctx, qc_tangent_frames(ctx, mesh, re, im));
    for (int32_t t = 0; t < mesh->n_faces; t++) {
        double p[2] = {0, 0};
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++)
                p[i] += mesh->position[3 * mesh->face_vertex[3 * t + k] + i];
        const double d[2] = {-p[1], p[0]};
        x[t] = (qc_complex){re[3 * t] * d[0] + re[3 * t + 1] * d[1],
                            im[3 * t] * d[0] + im[3 * t + 1] * d[1]};
    }
    free(re);
    free(im);
}

static inline qc_matching *case_matching(qc_ctx *ctx, const surface_case *c, const qc_mesh *mesh) {
    uint64_t state = 7;
    qc_complex *x = ARRAY(qc_complex, mesh->n_faces);
    for (int32_t t = 0; t < mesh->n_faces; t++) x[t].re = 1;
    if (c->kind == MERIDIANS)
        meridians(ctx, mesh, x);
    else
        must(ctx, qc_field_smoothest(ctx, mesh, NULL, NULL, 0, 0, x));
    if (c->kind == ROUGH)
        for (int32_t t = 0; t < mesh->n_faces; t++) {
            const complex_t z = qc__complex(x[t]) * cexp(0.6 * uniform(&state) * I);
            x[t] = qc__pair(z);
        }
    qc_face_field *field = NULL;
    qc_matching *matching = NULL;
    must(ctx, qc_face_field_create(ctx, mesh, x, NULL, NULL, &field));
    must(ctx, qc_matching_create(ctx, field, NULL, &matching));
    if (c->kind == ANY_TURNS) {
        int8_t *m = ARRAY(int8_t, mesh->n_edges);
        for (int32_t e = 0; e < mesh->n_edges; e++) {
            m[e] = matching->m[e];
            if (mesh->edge_halfedge[2 * e + 1] >= 0 && uniform(&state) > 0.8)
                m[e] = (int8_t)(m[e] + (int8_t)rint(4 * uniform(&state)));
        }
        qc_object_release(matching);
        must(ctx, qc_matching_create(ctx, field, m, &matching));
        free(m);
    }
    free(x);
    qc_object_release(field);
    return matching;
}

/* A case with its seamless map; the target edge length is that of `quads` quads. */
typedef struct setting {
    qc_ctx *ctx;
    qc_mesh *mesh;
    qc_matching *matching;
    qc_sizing *sizing;
    qc_seamless_map *map;
    qc_cover cover;
    double *cotangent, *stiffness; /* 3 n_faces: plain, and times the weights of the Hodge step */
} setting;

static inline setting *setting_of(qc_ctx *ctx, qc_mesh *mesh, qc_matching *matching, double quads) {
    setting *s = ARRAY(setting, 1);
    s->ctx = ctx;
    s->mesh = mesh;
    s->matching = matching;
    must(ctx, qc_sizing_create(ctx, mesh, sqrt(mesh->area / quads), quads, NULL, &s->sizing));
    must(ctx, qc_seamless_map_create(ctx, matching, s->sizing, NULL, &s->map));
    s->cover = (qc_cover){mesh, matching->m};
    s->cotangent = ARRAY(double, 3 * (int64_t)mesh->n_faces);
    s->stiffness = ARRAY(double, 3 * (int64_t)mesh->n_faces);
    must(ctx, qc_mesh_geometry(ctx, mesh, NULL, NULL, s->cotangent, NULL, NULL, NULL));
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++)
        s->stiffness[c] = s->cotangent[c] * (s->map->weight ? s->map->weight[c / 3] : 1);
    return s;
}
static inline setting *setting_create(qc_ctx *ctx, const surface_case *c, double quads) {
    qc_mesh *mesh = case_mesh(ctx, c);
    return setting_of(ctx, mesh, case_matching(ctx, c, mesh), quads);
}
static inline void setting_free(setting *s) {
    qc_object_release(s->map);
    qc_object_release(s->sizing);
    qc_object_release(s->matching);
    qc_object_release(s->mesh);
    free(s->cotangent);
    free(s->stiffness);
    free(s);
}

static inline qc__seams *setting_seams(const setting *s, int32_t lattice) {
    qc__seams *seams = NULL;
    must(s->ctx, qc__seams_create(s->ctx, &s->cover, s->map->cut, s->map->face_turn,
                                  s->matching->index4, s->matching->axis, &seams));
    must(s->ctx, qc__seams_solve(s->ctx, seams, lattice));
    return seams;
}

/* Values of all symbols for the free variables y, as complex numbers: translations, then positions
 * of cones. */
static inline complex_t *symbol_values(const qc__seams *s, const double *y) {
    double *value = ARRAY(double, qc__seams_symbols(s) + 1);
    complex_t *symbol = ARRAY(complex_t, s->n_segments + s->n_cones);
    qc__seams_symbol_values(s, y, value);
    for (int32_t j = 0; j < s->n_segments + s->n_cones; j++)
        symbol[j] = value[2 * j] + value[2 * j + 1] * I;
    free(value);
    return symbol;
}
/* The translations and positions of a seamless map. */
static inline complex_t *measured_symbols(const qc__seams *q, const qc_complex *f) {
    const qc_mesh *mesh = q->mesh;
    complex_t *symbol = ARRAY(complex_t, q->n_segments + q->n_cones);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t k = q->edge_segment[e], left = q->edge_left[e];
        if (k >= 0)
            symbol[k] = qc__complex(f[qc_prev(mesh->twin[left])]) -
                        qc__turn(qc__complex(f[qc_next(left)]), q->segment_turn[k]);
    }
    for (int32_t c = 0; c < 3 * mesh->n_faces; c++) {
        const int32_t v = mesh->face_vertex[c], cone = q->vertex_cone[v];
        if (cone >= 0 && q->corner_wedge[c] == q->vertex_wedge[v])
            symbol[q->n_segments + cone] = qc__complex(f[c]);
    }
    return symbol;
}
/* Free and fixed variables of symbols. */
static inline double *free_values(const qc__seams *s, const complex_t *symbol) {
    const qc__rows *rows = &s->free_row;
    double *y = ARRAY(double, s->n_free + s->n_fixed);
    for (int32_t j = 0; j < s->n_free + s->n_fixed; j++)
        for (int64_t i = rows->start[j]; i < rows->start[j + 1]; i++) {
            const complex_t z = symbol[rows->column[i] / 2];
            y[j] += rows->value[i] * (rows->column[i] % 2 ? cimag(z) : creal(z));
        }
    return y;
}
/* The map of least energy with free variables y. */
static inline qc_complex *harmonic_map(qc_ctx *ctx, const qc__periods *p, const double *y) {
    const qc__seams *s = p->seams;
    double *symbol = ARRAY(double, qc__seams_symbols(s));
    complex_t *wedge = ARRAY(complex_t, s->n_wedges), *F = ARRAY(complex_t, s->mesh->n_vertices);
    qc_complex *f = ARRAY(qc_complex, 3 * (int64_t)s->mesh->n_faces);
    qc__seams_symbol_values(s, y, symbol);
    qc__seams_wedge_values(s, symbol, wedge);
    must(ctx, qc__periods_extend(ctx, p, wedge, NULL, F));
    qc__periods_corners(s, wedge, F, f);
    free(symbol);
    free(wedge);
    free(F);
    return f;
}

/* Turns of the combed map across interior edge e from its left to its right face, from the matching
 * alone. */
static inline int32_t combed_turn(const setting *s, int32_t left) {
    const int32_t right = s->mesh->twin[left];
    return (s->map->face_turn[right / 3] - qc_cover_turn(&s->cover, left) -
            s->map->face_turn[left / 3]) &
           3;
}

/* Largest deviation of corner values f from f_right = i^rho f_left + tau at both ends of every
 * interior edge, with the translation of the segment, and of cones from their position. */
static inline double seam_deviation(const setting *s, const qc__seams *seams,
                                    const complex_t *symbol, const qc_complex *f) {
    double worst = 0;
    for (int32_t e = 0; e < s->mesh->n_edges; e++) {
        const int32_t k = seams->edge_segment[e];
        const int32_t left = k >= 0 ? seams->edge_left[e] : s->mesh->edge_halfedge[2 * e];
        const int32_t right = s->mesh->twin[left];
        if (right < 0) continue;
        const int32_t rho = combed_turn(s, left);
        assert_int_equal(rho, k >= 0 ? seams->segment_turn[k] & 3 : 0);
        const complex_t tau = k >= 0 ? symbol[k] : 0;
        const int32_t from[2] = {qc_next(left), qc_prev(left)},
                      to[2] = {qc_prev(right), qc_next(right)};
        for (int i = 0; i < 2; i++) {
            const complex_t wanted = qc__turn(qc__complex(f[from[i]]), rho) + tau;
            worst = fmax(worst, cabs(qc__complex(f[to[i]]) - wanted));
        }
    }
    for (int32_t c = 0; c < 3 * s->mesh->n_faces; c++) {
        const int32_t v = s->mesh->face_vertex[c], cone = seams->vertex_cone[v];
        if (cone < 0 || seams->corner_wedge[c] != seams->vertex_wedge[v]) continue;
        worst = fmax(worst, cabs(qc__complex(f[c]) - symbol[seams->n_segments + cone]));
    }
    return worst;
}

/* 1/2 int w |df - z|^2 with the cotangents of setting (times w); z NULL = 0. */
static inline double energy_of(const setting *s, const double *cotangent, const qc_complex *f,
                               const qc_complex *z) {
    double energy = 0;
    for (int32_t c = 0; c < 3 * s->mesh->n_faces; c++) {
        complex_t d = qc__complex(f[qc_prev(c)]) - qc__complex(f[qc_next(c)]);
        if (z) d -= qc__complex(z[c]);
        energy += 0.25 * cotangent[c] * (creal(d) * creal(d) + cimag(d) * cimag(d));
    }
    return energy;
}

/* The form of the cross field in the combed gauge, in parameter units. */
static inline qc_complex *combed_form(const setting *s) {
    const int64_t n = 3 * (int64_t)s->mesh->n_faces;
    qc_complex *edge = ARRAY(qc_complex, n), *z = ARRAY(qc_complex, n);
    must(s->ctx, qc_tangent_edges(s->ctx, s->mesh, edge));
    must(s->ctx, qc_form_from_cross(s->ctx, s->mesh, edge, s->matching->field->x, NULL, z));
    for (int64_t c = 0; c < n; c++) {
        z[c] = qc_quarter_turn(z[c], s->map->face_turn[c / 3]);
        z[c].re /= s->sizing->edge_length;
        z[c].im /= s->sizing->edge_length;
    }
    free(edge);
    return z;
}

/* Unit squares which the map covers: quads. */
static inline double map_area(const qc_corner_map *map) {
    double area = 0;
    for (int32_t t = 0; t < map->mesh->n_faces; t++) {
        const double *p = map->uv + 6 * (int64_t)t;
        area += 0.5 * ((p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1]));
    }
    return area;
}

#endif
