/* The topology of a refined cage, from OpenSubdiv's Far layer. */
#include "surface.hpp"

#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using qo::guarded;

namespace {

typedef std::pair<int32_t, int32_t> Edge;

Edge edge(int32_t a, int32_t b) {
    return Edge(std::min(a, b), std::max(a, b));
}

/* The lines of the cage which are edges of it, as pairs of vertices. */
std::vector<int32_t> creases(const qc_polygon_mesh *cage) {
    std::vector<Edge> edges;
    std::vector<int32_t> result;
    if (cage->n_lines == 0) return result;
    for (int32_t f = 0; f < cage->n_faces; f++) {
        const int32_t first = cage->face_offset[f], end = cage->face_offset[f + 1];
        for (int32_t c = first; c < end; c++)
            edges.push_back(
                edge(cage->face_vertex[c], cage->face_vertex[c + 1 < end ? c + 1 : first]));
    }
    std::sort(edges.begin(), edges.end());
    for (int32_t i = 0; i < cage->n_lines; i++) {
        const int32_t *line = cage->line + 2 * i;
        if (std::binary_search(edges.begin(), edges.end(), edge(line[0], line[1])))
            result.insert(result.end(), line, line + 2);
    }
    return result;
}

void make_refiner(const qc_polygon_mesh *cage, qo_surface *s) {
    typedef Far::TopologyRefinerFactory<Far::TopologyDescriptor> Factory;
    std::vector<int> size(static_cast<size_t>(cage->n_faces));
    for (size_t f = 0; f < size.size(); f++)
        size[f] = cage->face_offset[f + 1] - cage->face_offset[f];
    const std::vector<int32_t> crease = creases(cage);
    const std::vector<float> sharp(crease.size() / 2, Sdc::Crease::SHARPNESS_INFINITE);
    Far::TopologyDescriptor d;
    d.numVertices = cage->n_vertices;
    d.numFaces = cage->n_faces;
    d.numVertsPerFace = size.data();
    d.vertIndicesPerFace = cage->face_vertex;
    d.numCreases = s->n_creases = static_cast<int32_t>(sharp.size());
    d.creaseVertexIndexPairs = crease.data();
    d.creaseWeights = sharp.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    s->refiner.reset(Factory::Create(d, Factory::Options(Sdc::SCHEME_CATMARK, options)));
}

} // namespace

qc_status qo_surface_create(qc_ctx *ctx, const qc_polygon_mesh *cage, int32_t levels,
                            qo_surface **out) {
    return guarded(ctx, [=] {
        std::unique_ptr<qo_surface> s(new qo_surface);
        make_refiner(cage, s.get());
        if (!s->refiner)
            return qc_ctx_fail(ctx, QC_ERR_INPUT, -1,
                               "opensubdiv: the faces are not a surface it can refine");
        Far::TopologyRefiner::UniformOptions options(levels);
        options.fullTopologyInLastLevel = true;
        s->refiner->RefineUniform(options);
        *out = s.release();
        return qc_status(QC_OK);
    });
}

void qo_surface_destroy(qo_surface *surface) {
    delete surface;
}

int32_t qo_surface_creases(const qo_surface *surface) {
    return surface->n_creases;
}

int32_t qo_surface_samples(const qo_surface *surface) {
    return surface->last().GetNumVertices();
}

int32_t qo_surface_faces(const qo_surface *surface) {
    return surface->last().GetNumFaces();
}

void qo_surface_quads(const qo_surface *surface, int32_t *vertex) {
    const Far::TopologyLevel &last = surface->last();
    for (int f = 0; f < last.GetNumFaces(); f++)
        for (int k = 0; k < 4; k++) vertex[4 * f + k] = last.GetFaceVertices(f)[k];
}

void qo_surface_valences(const qo_surface *surface, int32_t *valence, uint8_t *boundary) {
    const Far::TopologyLevel &cage = surface->level(0);
    for (int v = 0; v < cage.GetNumVertices(); v++) {
        valence[v] = cage.GetVertexEdges(v).size();
        boundary[v] = cage.IsVertexBoundary(v);
    }
}

int32_t qo_surface_edges(const qo_surface *surface, int32_t *vertex) {
    const Far::TopologyLevel &cage = surface->level(0);
    for (int e = 0; vertex && e < cage.GetNumEdges(); e++)
        for (int k = 0; k < 2; k++) vertex[2 * e + k] = cage.GetEdgeVertices(e)[k];
    return cage.GetNumEdges();
}
