/* What the binding uses of qc/*.h. The C compiler checks every line against the headers: members
 * which are not needed are left out by "...". */
typedef int32_t qc_status;
#define QC_OK 0
#define QC_ERR_CANCELLED ...
#define QC_ERR_ARGUMENT ...
#define QC_ERR_NOMEM ...
#define QC_ERR_NOT_POSDEF ...
#define QC_ERR_IO ...
#define QC_ERR_NOT_FOUND ...
#define QC_BOOL ...
#define QC_INT ...
#define QC_REAL ...
#define QC_ENUM ...
#define QC_TEXT ...
#define QC_PORT_OPTIONAL ...
#define QC_LOG_WARNING ...
#define QC_MODE_FAST ...
#define QC_MODE_RELOCATE ...
#define QC_MODE_BEST ...
#define QC_POLYGON_FACE_LINE ...
#define QC_POLYGON_FACE_GROUP ...
#define QC_POLYGON_SOURCE ...
#define QC_REPAIR_KINDS ...

const char *qc_status_name(qc_status status);
const char *qc_version(void);

typedef ... qc_ctx;
typedef struct qc_ctx_options {
    uint32_t struct_size;
    uint32_t threads;
    void (*log)(void *user, int32_t level, const char *stage, const char *text);
    bool (*progress)(void *user, const char *stage, double fraction);
    void *user;
    const char *instructions;
    ...;
} qc_ctx_options;
typedef struct qc_error {
    qc_status status;
    int64_t where;
    const char *stage, *text;
    ...;
} qc_error;
qc_status qc_ctx_create(const qc_ctx_options *options, qc_ctx **out);
void qc_ctx_free(qc_ctx *ctx);
const qc_error *qc_ctx_error(const qc_ctx *ctx);
uint32_t qc_ctx_threads(const qc_ctx *ctx);
const char *qc_ctx_instructions(const qc_ctx *ctx);

typedef struct qc_object {
    const char *type;
    ...;
} qc_object;
void *qc_object_retain(const void *object);
void qc_object_release(const void *object);
typedef struct qc_complex {
    double re, im;
} qc_complex;

/* meshes */
typedef struct qc_polygon_mesh {
    qc_object object;
    int32_t n_vertices, n_faces, n_corners, n_uvs, n_lines;
    double *position;
    int32_t *face_offset, *face_vertex;
    double *uv;
    int32_t *corner_uv, *line, *face_line, *face_group, *source_face;
    double *source_barycentric;
    ...;
} qc_polygon_mesh;
qc_status qc_polygon_mesh_create(qc_ctx *ctx, int32_t n_vertices, int32_t n_faces,
                                 int32_t n_corners, int32_t n_uvs, int32_t n_lines, uint32_t flags,
                                 qc_polygon_mesh **out);
qc_status qc_polygon_mesh_read(qc_ctx *ctx, const char *path, qc_polygon_mesh **out);
qc_status qc_polygon_mesh_write(qc_ctx *ctx, const qc_polygon_mesh *mesh, const char *path,
                                const char *comment);

typedef struct qc_mesh {
    qc_object object;
    int32_t n_vertices, n_faces, n_edges, n_boundary_edges;
    int32_t n_components, n_boundary_loops, euler, genus;
    double diagonal, area, mean_edge_length;
    const double *position;
    const int32_t *face_vertex, *twin, *halfedge_edge, *edge_halfedge, *vertex_corner, *edge_vertex,
        *face_component, *source_face, *source_vertex;
    ...;
} qc_mesh;
qc_status qc_mesh_create(qc_ctx *ctx, int32_t n_vertices, const double *position, int32_t n_faces,
                         const int32_t *face_vertex, qc_mesh **out);

typedef struct qc_features {
    qc_object object;
    const qc_mesh *mesh;
    int32_t n_feature_edges, n_creases, n_corners;
    const uint8_t *edge, *vertex;
    ...;
} qc_features;
typedef struct qc_repair_report {
    qc_object object;
    int32_t count[...];
    ...;
} qc_repair_report;
const char *qc_repair_kind_name(int32_t kind);

/* fields and maps */
typedef struct qc_sizing {
    qc_object object;
    const qc_mesh *mesh;
    double edge_length, target_quads;
    const double *length;
    ...;
} qc_sizing;
qc_status qc_sizing_create(qc_ctx *ctx, const qc_mesh *mesh, double edge_length,
                           double target_quads, const double *length, qc_sizing **out);
typedef struct qc_face_field {
    qc_object object;
    const qc_mesh *mesh;
    const qc_complex *x;
    const double *weight;
    const uint8_t *trusted;
    ...;
} qc_face_field;
qc_status qc_face_field_create(qc_ctx *ctx, const qc_mesh *mesh, const qc_complex *x,
                               const double *weight, const uint8_t *trusted, qc_face_field **out);
qc_status qc_face_field_write(qc_ctx *ctx, const qc_face_field *field, const char *path);
typedef struct qc_matching {
    qc_object object;
    const qc_face_field *field;
    const int8_t *m;
    const double *theta;
    const int32_t *index4;
    int32_t n_singular, index4_sum;
    ...;
} qc_matching;
typedef struct qc_seamless_map {
    qc_object object;
    const qc_matching *matching;
    const qc_sizing *sizing;
    const qc_complex *z;
    const uint8_t *cut;
    const int8_t *face_turn;
    const qc_complex *f;
    double field_energy, curl_energy;
    ...;
} qc_seamless_map;
typedef struct qc_corner_map {
    qc_object object;
    const qc_mesh *mesh;
    const double *uv;
    double edge_length, field_energy, curl_energy, harmonic_energy, harmonic_energy_direct;
    ...;
} qc_corner_map;
qc_status qc_corner_map_create(qc_ctx *ctx, const qc_mesh *mesh, const double *uv,
                               double edge_length, const qc_complex *cross, qc_corner_map **out);
typedef struct qc_report {
    qc_object object;
    ...;
} qc_report;

/* stages and pipelines */
typedef struct qc_port {
    const char *name, *type;
    uint32_t flags;
    const char *doc;
    ...;
} qc_port;
typedef struct qc_param {
    const char *name;
    int32_t type;
    double def, min, max;
    const char *const *choices;
    const char *unit, *doc;
    ...;
} qc_param;
typedef struct qc_stage {
    const char *id, *version, *brief, *doc, *cite;
    uint32_t n_in, n_out, n_params;
    ...;
} qc_stage;
typedef ... qc_registry;
qc_status qc_registry_create(qc_ctx *ctx, qc_registry **out);
void qc_registry_free(qc_registry *registry);
qc_status qc_registry_load(qc_registry *registry, const char *plugin_path);
uint32_t qc_registry_count(const qc_registry *registry);
const qc_stage *qc_registry_stage(const qc_registry *registry, uint32_t i);
const qc_port *qc_stage_in(const qc_stage *stage, uint32_t i);
const qc_port *qc_stage_out(const qc_stage *stage, uint32_t i);
const qc_param *qc_stage_param(const qc_stage *stage, uint32_t i);
typedef ... qc_bag;
qc_status qc_bag_create(qc_ctx *ctx, qc_bag **out);
void qc_bag_free(qc_bag *bag);
qc_status qc_bag_put(qc_bag *bag, const char *name, const void *object);
const void *qc_bag_get(const qc_bag *bag, const char *name);
uint32_t qc_bag_count(const qc_bag *bag);
const char *qc_bag_name(const qc_bag *bag, uint32_t i);
typedef ... qc_pipeline;
qc_status qc_pipeline_create(qc_registry *registry, qc_pipeline **out);
qc_status qc_pipeline_parse(qc_registry *registry, const char *json, qc_pipeline **out);
void qc_pipeline_free(qc_pipeline *pipeline);
qc_status qc_pipeline_insert(qc_pipeline *pipeline, uint32_t at, const char *step,
                             const char *stage_id);
qc_status qc_pipeline_remove(qc_pipeline *pipeline, uint32_t at);
qc_status qc_pipeline_set(qc_pipeline *pipeline, const char *step, const char *param,
                          const char *text);
qc_status qc_pipeline_wire(qc_pipeline *pipeline, const char *step, const char *port,
                           const char *source);
uint32_t qc_pipeline_count(const qc_pipeline *pipeline);
const char *qc_pipeline_step_name(const qc_pipeline *pipeline, uint32_t i);
const qc_stage *qc_pipeline_step_stage(const qc_pipeline *pipeline, uint32_t i);
qc_status qc_pipeline_print(const qc_pipeline *pipeline, char **json);
void qc_text_free(char *text);
qc_status qc_pipeline_run(qc_pipeline *pipeline, qc_bag *io);
double qc_pipeline_seconds(const qc_pipeline *pipeline, uint32_t i);

typedef struct qc_default_pipeline_options {
    uint32_t struct_size;
    double quads, edge_length, edge_length_rel, crease_angle;
    const char *field_path;
    uint64_t seed;
    int32_t mode;
    ...;
} qc_default_pipeline_options;
qc_status qc_default_pipeline(qc_ctx *ctx, qc_registry *registry,
                              const qc_default_pipeline_options *options, qc_pipeline **out);
typedef struct qc_remesh_options {
    uint32_t struct_size;
    int32_t strict;
    ...;
} qc_remesh_options;
typedef struct qc_remesh_result {
    qc_mesh *mesh;
    qc_repair_report *repairs;
    qc_polygon_mesh *quads, *uv;
    qc_face_field *field;
    qc_report *report;
    int32_t n_failed, n_warnings;
    char **warning;
    ...;
} qc_remesh_result;
qc_status qc_remesh(qc_ctx *ctx, qc_pipeline *pipeline, const qc_polygon_mesh *input,
                    const qc_remesh_options *options, qc_remesh_result *result);
void qc_remesh_result_clear(qc_remesh_result *result);

/* shapes */
typedef struct qc_shape_options {
    uint32_t struct_size;
    int32_t resolution;
    double noise;
    int32_t retriangulate, genus;
    uint64_t seed;
    ...;
} qc_shape_options;
typedef struct qc_shape_info {
    const char *name, *doc;
    int32_t genus, boundary_loops;
    ...;
} qc_shape_info;
const qc_shape_info *qc_shape_list(size_t *count);
qc_status qc_shape_create(qc_ctx *ctx, const char *name, const qc_shape_options *options,
                          qc_mesh **out);

/* sparse matrices */
typedef struct qc_hermitian {
    int32_t n;
    const int64_t *colptr;
    const int32_t *row;
    const qc_complex *val;
    ...;
} qc_hermitian;
typedef struct qc_symmetric {
    int32_t n;
    const int64_t *colptr;
    const int32_t *row;
    const double *val;
    ...;
} qc_symmetric;
typedef ... qc_symbolic;
typedef ... qc_factor;
typedef struct qc_analyze_options {
    uint32_t struct_size;
    int32_t ordering;
    const int32_t *permutation, *group;
    const double *position;
    ...;
} qc_analyze_options;
typedef struct qc_symbolic_info {
    uint32_t struct_size;
    int32_t n, supernodes, largest_front;
    int64_t nnz_l, stored;
    double flops;
    int64_t bytes_complex, bytes_real;
    ...;
} qc_symbolic_info;
#define QC_ORDER_AUTO ...
#define QC_ORDER_NATURAL ...
#define QC_ORDER_GIVEN ...
#define QC_ORDER_AMD ...
#define QC_ORDER_QUOTIENT ...
#define QC_ORDER_DISSECTION ...
qc_status qc_analyze(qc_ctx *ctx, const qc_hermitian *A, const qc_analyze_options *options,
                     qc_symbolic **out);
qc_status qc_analyze_real(qc_ctx *ctx, const qc_symmetric *A, const qc_analyze_options *options,
                          qc_symbolic **out);
void qc_symbolic_free(qc_symbolic *S);
void qc_symbolic_get_info(const qc_symbolic *S, qc_symbolic_info *info);
void qc_symbolic_get_permutation(const qc_symbolic *S, int32_t *permutation);
qc_status qc_factorize(qc_ctx *ctx, const qc_symbolic *S, const qc_hermitian *A, qc_factor **out);
qc_status qc_factorize_real(qc_ctx *ctx, const qc_symbolic *S, const qc_symmetric *A,
                            qc_factor **out);
qc_status qc_refactorize(qc_ctx *ctx, qc_factor *F, const qc_hermitian *A);
qc_status qc_refactorize_real(qc_ctx *ctx, qc_factor *F, const qc_symmetric *A);
void qc_factor_free(qc_factor *F);
qc_status qc_solve(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, qc_complex *x);
qc_status qc_solve_real(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, double *x);
qc_status qc_solve_forward(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, qc_complex *x);
qc_status qc_solve_forward_real(qc_ctx *ctx, const qc_factor *F, int32_t nrhs, double *x);
qc_status qc_updown_many(qc_ctx *ctx, qc_factor *F, int32_t k, const int *sigma,
                         const int32_t *start, const int32_t *row, const qc_complex *w);
qc_status qc_updown_many_real(qc_ctx *ctx, qc_factor *F, int32_t k, const int *sigma,
                              const int32_t *start, const int32_t *row, const double *w);
qc_status qc_flip(qc_ctx *ctx, qc_factor *F, int32_t k, int32_t l, qc_complex dl, int32_t m,
                  qc_complex dm);
qc_status qc_factor_begin(qc_ctx *ctx, qc_factor *F);
qc_status qc_factor_commit(qc_ctx *ctx, qc_factor *F);
qc_status qc_factor_rollback(qc_ctx *ctx, qc_factor *F);
double qc_factor_logdet(const qc_factor *F);
qc_status qc_condition(qc_ctx *ctx, const qc_factor *F, const qc_hermitian *A, double *condition);
qc_status qc_condition_real(qc_ctx *ctx, const qc_factor *F, const qc_symmetric *A,
                            double *condition);
typedef struct qc_lattice_options {
    uint32_t struct_size;
    int32_t start, radius;
    int64_t budget;
    uint64_t seed;
    ...;
} qc_lattice_options;
typedef struct qc_lattice_result {
    double energy, energy_direct;
    ...;
} qc_lattice_result;
qc_status qc_lattice_round(qc_ctx *ctx, int32_t n, const double *P, const double *t,
                           const qc_lattice_options *options, double *z, qc_lattice_result *result);

extern "Python" void qc_python_log(void *user, int32_t level, const char *stage, const char *text);
extern "Python" bool qc_python_progress(void *user, const char *stage, double fraction);
