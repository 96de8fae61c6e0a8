/* The table of procedural surfaces, option checks, and the order of the disturbances: edge flips
 * and jitter first, noise last. */
#include <string.h>

#include "sdk/shape/internal.h"

enum { SHAPES = 15, DEFAULT_FACES = 8000, MAX_FACES = 100000000, MAX_GENUS = 50 };

static const qc_shape_info table[SHAPES] = {
    {"sphere", "unit sphere, a subdivided icosahedron", 0, 0},
    {"ellipsoid", "ellipsoid with half axes 1.5, 1, 0.7", 0, 0},
    {"flat-torus", "embedded polyhedral torus with zero curvature at every vertex (a diplotorus)",
     1, 0},
    {"torus", "torus of revolution with radii 1 and 0.4", 1, 0},
    {"cube", "cube of edge 2", 0, 0},
    {"cylinder", "closed cylinder of radius 1 and height 3", 0, 0},
    {"truncated-cone", "closed truncated cone (thesis, Fig. 6.7)", 0, 0},
    {"knot", "tube round the trefoil knot (2007 paper, Fig. 2)", 1, 0},
    {"trinoid", "minimal surface of Jorge and Meeks with three ends (2007 paper, Fig. 8)", 0, 3},
    {"schwarz-p", "cell of the Schwarz P surface, nodal approximation (2007 paper, Fig. 8)", 0, 6},
    {"hyperboloid", "hyperboloid of one sheet (2007 paper, Fig. 8)", 0, 2},
    {"costa", "Costa's minimal surface with three ends (2007 paper, Fig. 7)", 1, 3},
    {"sin-u-cos-v", "graph of sin u cos v (positive integer index paper, Fig. 10)", 0, 1},
    {"lawson", "3-fold Lawson surface, stereographic (positive integer index paper, Fig. 10)", 2,
     0},
    {"genus", "smooth plate with the given number of holes", -1, 0},
};

static qc__shape_make *const make[SHAPES] = {
    qc__shape_sphere,  qc__shape_ellipsoid, qc__shape_flat_torus,     qc__shape_torus,
    qc__shape_cube,    qc__shape_cylinder,  qc__shape_truncated_cone, qc__shape_knot,
    qc__shape_trinoid, qc__shape_schwarz_p, qc__shape_hyperboloid,    qc__shape_costa,
    qc__shape_graph,   qc__shape_lawson,    qc__shape_genus};

const qc_shape_info *qc_shape_list(size_t *count) {
    *count = SHAPES;
    return table;
}

static qc_status find(qc_ctx *ctx, const char *name, int *shape) {
    const char *names[SHAPES];
    for (int i = 0; i < SHAPES; i++) {
        names[i] = table[i].name;
        if (strcmp(name, names[i]) == 0) {
            *shape = i;
            return QC_OK;
        }
    }
    const char *closest = qc_closest_name(name, names, SHAPES);
    if (closest)
        return qc__fail(ctx, QC_ERR_NOT_FOUND, -1, "no shape \"%s\"; did you mean \"%s\"?", name,
                        closest);
    return qc__fail(ctx, QC_ERR_NOT_FOUND, -1,
                    "no shape \"%s\"; try \"sphere\", \"torus\", \"knot\"", name);
}

/* Callers built with an older header have a shorter struct. */
static qc_status read_options(qc_ctx *ctx, const qc_shape_options *given, qc_shape_options *o) {
    *o = (qc_shape_options)QC_SHAPE_OPTIONS_INIT;
    if (given) memcpy(o, given, given->struct_size < sizeof *o ? given->struct_size : sizeof *o);
    if (o->resolution < 0 || o->resolution > MAX_FACES)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "resolution %d is not in 0 to %d",
                        (int)o->resolution, (int)MAX_FACES);
    if (o->genus < 0 || o->genus > MAX_GENUS)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "genus %d is not in 0 to %d", (int)o->genus,
                        (int)MAX_GENUS);
    if (!(o->noise >= 0) || o->noise > 10)
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "noise %g is not in 0 to 10 edge lengths",
                        o->noise);
    if (o->resolution == 0) o->resolution = DEFAULT_FACES;
    return QC_OK;
}

static void replace(qc_mesh **mesh, qc_mesh *by) {
    qc_object_release(*mesh);
    *mesh = by;
}

static qc_status disturb(qc_ctx *ctx, const qc_shape_options *o, qc_mesh **mesh) {
    qc_mesh *next = NULL;
    qc_status status = QC_OK;
    if (o->retriangulate) {
        status = qc__shape_flip(ctx, *mesh, o->seed, &next);
        if (status == QC_OK) replace(mesh, next);
        if (status == QC_OK) status = qc__shape_jitter(ctx, *mesh, o->seed, &next);
        if (status == QC_OK) replace(mesh, next);
    }
    if (status == QC_OK && o->noise > 0) {
        status = qc__shape_noise(ctx, *mesh, o->noise, o->seed, &next);
        if (status == QC_OK) replace(mesh, next);
    }
    return status;
}

qc_status qc_shape_create(qc_ctx *ctx, const char *name, const qc_shape_options *options,
                          qc_mesh **out) {
    qc_shape_options o;
    int shape = 0;
    qc_status status = find(ctx, name, &shape);
    if (status == QC_OK) status = read_options(ctx, options, &o);
    if (status != QC_OK) return status;
    qc__soup soup = {.ctx = ctx};
    qc_mesh *mesh = NULL;
    make[shape](&soup, &o);
    status = qc__soup_mesh(&soup, &mesh);
    if (status == QC_OK && make[shape] == qc__shape_genus)
        status = qc__shape_round_off(ctx, &o, &mesh);
    if (status == QC_OK) status = disturb(ctx, &o, &mesh);
    if (status != QC_OK) {
        qc_object_release(mesh);
        return status;
    }
    *out = mesh;
    return QC_OK;
}
