/* Stage qc.round: global continuity by rounding the periods (thesis 4.2, 6.3). */
#include <qc/map.h>
#include <qc/stages.h>

typedef struct params {
    int32_t lattice, start;
    int64_t radius;
    double tolerance;
    const char *solver;
    int64_t seed;
    double refine;
    int32_t quantize;
} params;
static const char *const solvers[] = {QC_SOLVER_ID, NULL};

static const char *const lattices[] = {"quads", "integer", "even", NULL};
static const char *const quantize[] = {"never", "needed", "always", NULL};
static const char *const starts[] = {"direct", "greedy", NULL};

static const qc_port in[] = {
    {"map", QC_TYPE_SEAMLESS_MAP, 0, "seamless map with real translations"},
};
static const qc_port out[] = {
    {"map", QC_TYPE_CORNER_MAP, 0, "integer-seamless map"},
};
static const qc_param table[] = {
    QC_PARAM_ENUM(params, lattice, QC_LATTICE_QUADS, lattices,
                  "where periods may fall: quads = cones on lattice points (only quads), integer = "
                  "integer translations (cones may end in the middle of a cell), even = even "
                  "translations (thesis 4.2.2, Figure 4.4)"),
    QC_PARAM_ENUM(params, start, QC_ROUND_GREEDY, starts,
                  "first rounding: all at once, or one at a time with the others re-optimised"),
    QC_PARAM_INT(params, radius, 3, 0, 3, "",
                 "then change up to this many integers at a time while the energy falls"),
    QC_PARAM_REAL(params, tolerance, 0.02, 0.001, 1, "",
                  "accepted relative deviation from the target number of quads"),
    QC_PARAM_INTERFACE(params, solver, solvers,
                       "factorises L; builtin unless a plugin or the program offers another"),
    QC_PARAM_INT(params, seed, 0, 0, 9007199254740992.0, "",
                 "of the search for integers; another one may give other integers"),
    QC_PARAM_REAL(
        params, refine, 1, 0.01, 100, "",
        "quads wanted, in units of what the sizing asks for; raised by the program where no "
        "map is found"),
    QC_PARAM_ENUM(
        params, quantize, QC_QUANTIZE_WHERE_NEEDED, quantize,
        "take integers for which an injective map is sure to exist: never, where rounding "
        "cannot keep singularities and features apart or folds over, or always"),
};

static qc_status run(const qc_run *r, const void *raw) {
    const params *p = raw;
    qc_round_options options = QC_ROUND_OPTIONS_INIT;
    options.lattice = p->lattice;
    options.start = p->start;
    options.radius = (int32_t)p->radius;
    options.tolerance = p->tolerance;
    options.seed = (uint64_t)p->seed;
    options.refine = p->refine;
    options.quantize = p->quantize;
    options.solver = (const qc_solver *)r->find(r, QC_SOLVER_ID, p->solver);
    if (!options.solver) return QC_ERR_NOT_FOUND;
    qc_corner_map *map = NULL;
    const qc_status status = qc_map_round(r->ctx, r->input(r, "map"), &options, &map);
    return status == QC_OK ? r->output(r, "map", map) : status;
}

const qc_stage qc_stage_round = {
    QC_STAGE_SIZES,
    .id = "qc.round",
    .version = "1.0",
    .brief = "Rounds the periods to a lattice and closes the map by a harmonic correction.",
    .doc =
        "Cone positions and the translations of the remaining cut paths are the free variables of "
        "the map. Their period matrix P comes from one solve a variable (Sigma trick); integers "
        "z near the optimum of 1/2 (z - t)^T P (z - t) are found by greedy rounding and local "
        "search. The harmonic map with periods z - t is added. With a target number of quads the "
        "map is rescaled and rounded again until its area meets it.",
    .cite = "thesis 4.2.1, 4.2.2, 6.3.1, 6.3.2",
    .in = in,
    .out = out,
    .n_in = 1,
    .n_out = 1,
    .params = table,
    .n_params = sizeof table / sizeof *table,
    .params_size = sizeof(params),
    .run = run,
};
