// A pipeline of one's own, in C++17: built-in stages in another order, and between qc.hodge and
// qc.round a stage which is part of this program. It turns all quads by an angle.
//
//     stage IN.obj OUT.obj [DEGREES]
//
// The crosses x of a field, turned by one angle all over the surface, differ over edges by the same
// quarter turns as before, so that the matching stays. The map which follows them is the old one
// times exp(-i angle): still locally integrable, with other translations, which are then rounded.
#include <qc/qc.h>

#include <complex>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace {

using cplx = std::complex<double>; // same layout as qc_complex

// Owners of what the C interface hands out.
template <auto release> struct Release {
    template <class T> void operator()(T *p) const { release(p); }
};
template <class T, auto release = qc_object_release>
using Owner = std::unique_ptr<T, Release<release>>;

struct Failure {}; // the context has the text
void check(qc_status status) {
    if (status != QC_OK) throw Failure{};
}

// --- the stage: tables and one function, as in a plugin (docs/plugins.md) -----------------------

struct Options { // filled and range-checked by the host
    double angle;
};
const qc_param params[] = {
    QC_PARAM_REAL(Options, angle, 45, -360, 360, "deg", "by how much the quads are turned"),
};
const qc_port in[] = {{"map", QC_TYPE_SEAMLESS_MAP, 0, "seamless map of a cross field"}};
const qc_port out[] = {{"map", QC_TYPE_SEAMLESS_MAP, 0, "the map of the turned field"}};

// A published object starts with a qc_object; what follows is the business of who made it. This one
// shares the cut, the combing and the weights of its source.
struct Turned : qc_seamless_map {
    Owner<const qc_seamless_map> source;
    Owner<const qc_matching> turned;
    std::vector<qc_complex> new_z, new_f;
};
void destroy(qc_object *object) {
    delete static_cast<Turned *>(reinterpret_cast<qc_seamless_map *>(object));
}

std::vector<qc_complex> product(const qc_complex *a, std::size_t n, cplx c) {
    std::vector<qc_complex> ac(n);
    for (std::size_t i = 0; i < n; i++) {
        const cplx p = c * cplx(a[i].re, a[i].im);
        ac[i] = {p.real(), p.imag()};
    }
    return ac;
}

// The matching of the turned field: same quarter turns, hence the same indices.
Owner<const qc_matching> turn(qc_ctx *ctx, const qc_matching *old, cplx c) {
    const qc_face_field *f = old->field;
    const auto x = product(f->x, static_cast<std::size_t>(f->mesh->n_faces), c);
    qc_face_field *field = nullptr;
    qc_matching *matching = nullptr;
    check(qc_face_field_create(ctx, f->mesh, x.data(), f->weight, nullptr, &field));
    const Owner<qc_face_field> owner(field); // the matching keeps a reference of its own
    check(qc_matching_create(ctx, field, old->m, &matching));
    return Owner<const qc_matching>(matching);
}

std::unique_ptr<Turned> turn(qc_ctx *ctx, const qc_seamless_map *map, double angle) {
    const cplx c = std::polar(1.0, angle);
    const auto n = 3 * static_cast<std::size_t>(map->matching->field->mesh->n_faces);
    auto t = std::make_unique<Turned>();
    static_cast<qc_seamless_map &>(*t) = *map; // sizes and energies stay as they are
    qc_object_init(&t->object, QC_TYPE_SEAMLESS_MAP, destroy);
    t->source.reset(static_cast<const qc_seamless_map *>(qc_object_retain(map)));
    t->turned = turn(ctx, map->matching, c);
    t->matching = t->turned.get();
    t->new_z = product(map->z, n, std::conj(c)); // z(e) = conj(x) e
    t->new_f = product(map->f, n, std::conj(c));
    t->z = t->new_z.data();
    t->f = t->new_f.data();
    return t;
}

qc_status run(const qc_run *r, const void *raw) try {
    const auto *map = static_cast<const qc_seamless_map *>(r->input(r, "map"));
    if (map->matching->field->aligned)
        return r->fail(r, QC_ERR_ARGUMENT, -1, "the field follows hard features, which stay");
    const double angle = static_cast<const Options *>(raw)->angle * std::acos(-1.0) / 180;
    return r->output(r, "map", turn(r->ctx, map, angle).release()); // moves the reference
} catch (const Failure &) {
    return qc_ctx_error(r->ctx)->status;
} catch (const std::bad_alloc &) { // no exception may cross the C interface
    return r->fail(r, QC_ERR_NOMEM, -1, "out of memory");
}

const qc_stage turn_stage = {
    QC_STAGE_SIZES,
    "org.example.turn",
    "1.0",
    "Turns all quads by an angle",
    "Multiplies a seamless map by a complex number of absolute value 1.",
    "thesis 3.2.3",
    in,
    out,
    1,
    1,
    params,
    1,
    sizeof(Options),
    run,
};

// --- the pipeline -------------------------------------------------------------------------------

// Ports find each other by type: size, which the default pipeline runs second, may as well come
// after the field, and round takes the map of the latest stage which makes one.
const char *const steps = R"({ "qc_pipeline": 1, "stages": [
    { "stage": "qc.repair" },
    { "stage": "qc.field.curvature" },
    { "stage": "qc.matching" },
    { "stage": "qc.size", "params": { "quads": 1000 } },
    { "stage": "qc.hodge" },
    { "stage": "org.example.turn", "as": "turn" },
    { "stage": "qc.round" },
    { "stage": "qc.untangle" },
    { "stage": "qc.extract" },
    { "stage": "qc.finish" } ] })";

void remesh(qc_ctx *ctx, const char *input, const char *output, const char *degrees) {
    qc_registry *registry = nullptr;
    check(qc_registry_create(ctx, &registry));
    const Owner<qc_registry, qc_registry_free> registry_owner(registry);
    check(qc_registry_add(registry, &turn_stage));

    qc_pipeline *pipeline = nullptr;
    check(qc_pipeline_parse(registry, steps, &pipeline));
    const Owner<qc_pipeline, qc_pipeline_free> pipeline_owner(pipeline);
    check(qc_pipeline_set(pipeline, "turn", "angle", degrees));

    qc_polygon_mesh *soup = nullptr;
    check(qc_polygon_mesh_read(ctx, input, &soup));
    const Owner<qc_polygon_mesh> soup_owner(soup);
    qc_bag *bag = nullptr;
    check(qc_bag_create(ctx, &bag));
    const Owner<qc_bag, qc_bag_free> bag_owner(bag);
    check(qc_bag_put(bag, "input", soup));
    check(qc_pipeline_run(pipeline, bag));

    const auto *quads = static_cast<const qc_polygon_mesh *>(qc_bag_get(bag, "finish.quads"));
    check(qc_polygon_mesh_write(ctx, quads, output, nullptr));
    for (std::uint32_t i = 0; i < qc_pipeline_count(pipeline); i++)
        std::printf("%s%s", i > 0 ? " -> " : "", qc_pipeline_step_name(pipeline, i));
    std::printf("\n%d quads, turned by %s degrees\n", quads->n_faces,
                qc_pipeline_get(pipeline, "turn", "angle"));
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 3) return std::fprintf(stderr, "usage: stage IN.obj OUT.obj [DEGREES]\n"), 2;
    qc_ctx *ctx = nullptr;
    if (qc_ctx_create(nullptr, &ctx) != QC_OK) return 1;
    const Owner<qc_ctx, qc_ctx_free> owner(ctx);
    try {
        remesh(ctx, argv[1], argv[2], argc > 3 ? argv[3] : "45");
    } catch (const Failure &) {
        const qc_error *error = qc_ctx_error(ctx);
        return std::fprintf(stderr, "%s: %s\n", *error->stage ? error->stage : "stage",
                            error->text),
               1;
    }
    return 0;
}
