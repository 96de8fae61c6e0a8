/* Stage qc.hodge: curl removal on the covering, cut graph, integration (thesis 4.1). */
#include <qc/map.h>
#include <qc/stages.h>

static const qc_port in[] = {
    {"matching", QC_TYPE_MATCHING, 0, "cross field with its matching"},
    {"sizing", QC_TYPE_SIZING, 0, "target edge length of the quads"},
};
static const qc_port out[] = {
    {"map", QC_TYPE_SEAMLESS_MAP, 0,
     "locally integrable field and its integral on the cut surface"},
};

typedef struct params {
    int64_t stiffening;
    const char *solver;
} params;
static const char *const solvers[] = {QC_SOLVER_ID, NULL};

static const qc_param table[] = {
    QC_PARAM_INT(params, stiffening, 12, 0, 50, "",
                 "rounds, at most, which raise the weight of folded faces and solve again while a "
                 "cone winds the wrong number of times"),
    QC_PARAM_INTERFACE(params, solver, solvers,
                       "factorises L*; builtin unless a plugin or the program offers another"),
};

static qc_status run(const qc_run *r, const void *raw) {
    const params *p = raw;
    qc_hodge_options options = QC_HODGE_OPTIONS_INIT;
    options.stiffening = (int32_t)p->stiffening;
    options.solver = (const qc_solver *)r->find(r, QC_SOLVER_ID, p->solver);
    if (!options.solver) return QC_ERR_NOT_FOUND;
    qc_seamless_map *map = NULL;
    const qc_status status = qc_seamless_map_create(r->ctx, r->input(r, "matching"),
                                                    r->input(r, "sizing"), &options, &map);
    return status == QC_OK ? r->output(r, "map", map) : status;
}

const qc_stage qc_stage_hodge = {
    QC_STAGE_SIZES,
    .id = "qc.hodge",
    .version = "1.0",
    .brief = "Removes the curl of the frame field and integrates it on the cut surface.",
    .doc = "The frame field X = x / length is lifted to the four-sheeted covering. The complex "
           "non-conforming stiffness matrix L* is factored and its co-potential v, L* v = r, "
           "subtracted, which leaves the closest locally integrable field; the energy removed is "
           "E_D = 1/2 v^H L* v. The surface is cut by the shortest system of paths based at the "
           "branch points and boundaries, the field combed and integrated.",
    .cite = "thesis 1.3, 3.2.3, 4.1, eq. (6.1); 2007 paper eq. (9)",
    .in = in,
    .out = out,
    .n_in = 2,
    .n_out = 1,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = run,
};
