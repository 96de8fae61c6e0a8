/* Refinement and limit masks of OpenSubdiv's Far layer, in double precision. Weights are those of
 * Halstead, Kass, DeRose (1993) at smooth vertices, of Biermann, Levin, Zorin (2000) at creases. */
#include "surface.hpp"

#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using qo::guarded;

namespace {

struct Point {
    double x[3];
    void Clear() { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(const Point &p, double weight) {
        for (int k = 0; k < 3; k++) x[k] += weight * p.x[k];
    }
};

/* A linear combination of control points, columns ascending. */
struct Row {
    std::vector<std::pair<int32_t, double>> terms;
    void Clear() { terms.clear(); }
    void AddWithWeight(const Row &other, double weight) {
        if (!(std::fabs(weight) > 0)) return;
        std::vector<std::pair<int32_t, double>> sum;
        sum.reserve(terms.size() + other.terms.size());
        auto a = terms.cbegin();
        for (const auto &term : other.terms) {
            while (a != terms.cend() && a->first < term.first) sum.push_back(*a++);
            const bool both = a != terms.cend() && a->first == term.first;
            sum.emplace_back(term.first, weight * term.second + (both ? a->second : 0));
            if (both) ++a;
        }
        sum.insert(sum.end(), a, terms.cend());
        terms.swap(sum);
    }
};

/* What refinement and limit masks see of an array. */
template <class T> struct View {
    T *data;
    T &operator[](int i) { return data[i]; }
    const T &operator[](int i) const { return data[i]; }
};

/* Values at the vertices of the last level from those at the cage. */
template <class T> std::vector<T> refine(const qo_surface &s, std::vector<T> values) {
    const Far::PrimvarRefinerReal<double> primvar(*s.refiner);
    for (int i = 1; i <= s.refiner->GetMaxLevel(); i++) {
        std::vector<T> finer(static_cast<size_t>(s.level(i).GetNumVertices()));
        const View<T> from = {values.data()};
        View<T> to = {finer.data()};
        primvar.Interpolate(i, from, to);
        values.swap(finer);
    }
    return values;
}

std::vector<Point> refined_points(const qo_surface &s, const double *control) {
    std::vector<Point> p(static_cast<size_t>(s.level(0).GetNumVertices()));
    if (!p.empty()) std::memcpy(p.data(), control, p.size() * sizeof(Point));
    return refine(s, std::move(p));
}

void cross(const double *a, const double *b, double *out) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

double norm(const double *a) {
    return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* Sine of the angle from a to b. */
double sine(const double *a, const double *b) {
    double n[3];
    cross(a, b, n);
    const double lengths = norm(a) * norm(b);
    return lengths > 0 ? norm(n) / lengths : 0;
}

/* The derivatives along the edges of a smooth vertex of valence n are d_i = (sin((1 - i) w) d_0 +
 * sin(i w) d_1) / sin w, w = 2 pi / n: those of the map's eigenspace of second largest eigenvalue.
 */
double least_sine(int n, const double *d0, const double *d1) {
    const double w = 2 * std::acos(-1.0) / n;
    double least = sine(d0, d1), last[3];
    std::memcpy(last, d1, sizeof last);
    for (int i = 2; i <= n; i++) {
        double next[3];
        for (int k = 0; k < 3; k++)
            next[k] = (std::sin((1 - i) * w) * d0[k] + std::sin(i * w) * d1[k]) / std::sin(w);
        least = std::min(least, sine(last, next));
        std::memcpy(last, next, sizeof last);
    }
    return least;
}

void copy_tangents(const qo_surface &s, const std::vector<Point> &t1, const std::vector<Point> &t2,
                   double *normal, double *jacobian) {
    const Far::TopologyLevel &last = s.last();
    for (int v = 0; v < last.GetNumVertices(); v++) {
        const double *a = t1[static_cast<size_t>(v)].x, *b = t2[static_cast<size_t>(v)].x;
        const int n = last.GetVertexEdges(v).size();
        const bool smooth = last.GetVertexRule(v) <= Sdc::Crease::RULE_DART && n > 2;
        if (jacobian) jacobian[v] = smooth && n != 4 ? least_sine(n, a, b) : sine(a, b);
        if (!normal) continue;
        cross(a, b, normal + 3 * v);
        const bool planes =
            last.GetVertexRule(v) > Sdc::Crease::RULE_DART && !last.IsVertexBoundary(v);
        const double length = planes ? 0 : norm(normal + 3 * v);
        for (int k = 0; k < 3; k++) normal[3 * v + k] = length > 0 ? normal[3 * v + k] / length : 0;
    }
}

template <class T> T *allocate(size_t n) {
    T *p = static_cast<T *>(std::malloc((n + 1) * sizeof(T)));
    if (!p) throw std::bad_alloc();
    return p;
}

std::vector<Row> limit_rows(const qo_surface &s) {
    std::vector<Row> rows(static_cast<size_t>(s.level(0).GetNumVertices()));
    for (size_t i = 0; i < rows.size(); i++)
        rows[i].terms.emplace_back(static_cast<int32_t>(i), 1.0);
    rows = refine(s, std::move(rows));
    std::vector<Row> limit(rows.size());
    const View<Row> from = {rows.data()};
    View<Row> to = {limit.data()};
    Far::PrimvarRefinerReal<double>(*s.refiner).Limit(from, to);
    return limit;
}

} // namespace

qc_status qo_surface_refine(qc_ctx *ctx, const qo_surface *surface, const double *control,
                            double *position) {
    return guarded(ctx, [=] {
        const std::vector<Point> p = refined_points(*surface, control);
        if (!p.empty()) std::memcpy(position, p.data(), p.size() * sizeof(Point));
        return qc_status(QC_OK);
    });
}

qc_status qo_surface_midpoints(qc_ctx *ctx, const qo_surface *surface, const double *control,
                               double *position) {
    return guarded(ctx, [=] {
        std::vector<Point> p(static_cast<size_t>(surface->level(0).GetNumVertices()));
        std::vector<Point> finer(static_cast<size_t>(surface->level(1).GetNumVertices()));
        if (!p.empty()) std::memcpy(p.data(), control, p.size() * sizeof(Point));
        const View<const Point> from = {p.data()};
        View<Point> to = {finer.data()};
        Far::PrimvarRefinerReal<double>(*surface->refiner).InterpolateVarying(1, from, to);
        if (!finer.empty()) std::memcpy(position, finer.data(), finer.size() * sizeof(Point));
        return qc_status(QC_OK);
    });
}

qc_status qo_surface_limit(qc_ctx *ctx, const qo_surface *surface, const double *control,
                           double *position, double *normal, double *jacobian) {
    return guarded(ctx, [=] {
        const std::vector<Point> p = refined_points(*surface, control);
        std::vector<Point> limit(p.size()), t1(p.size()), t2(p.size());
        const View<const Point> from = {p.data()};
        View<Point> to = {limit.data()}, to1 = {t1.data()}, to2 = {t2.data()};
        Far::PrimvarRefinerReal<double>(*surface->refiner).Limit(from, to, to1, to2);
        if (!p.empty()) std::memcpy(position, limit.data(), p.size() * sizeof(Point));
        copy_tangents(*surface, t1, t2, normal, jacobian);
        return qc_status(QC_OK);
    });
}

void qo_rows_free(qo_rows *rows) {
    std::free(rows->offset);
    std::free(rows->column);
    std::free(rows->weight);
    std::memset(rows, 0, sizeof *rows);
}

qc_status qo_surface_rows(qc_ctx *ctx, const qo_surface *surface, qo_rows *out) {
    std::memset(out, 0, sizeof *out);
    const qc_status status = guarded(ctx, [=] {
        const std::vector<Row> limit = limit_rows(*surface);
        size_t terms = 0, at = 0;
        for (const Row &row : limit) terms += row.terms.size();
        out->n = static_cast<int32_t>(limit.size());
        out->offset = allocate<int64_t>(limit.size() + 1);
        out->column = allocate<int32_t>(terms);
        out->weight = allocate<double>(terms);
        out->offset[0] = 0;
        for (size_t i = 0; i < limit.size(); i++) {
            for (const auto &term : limit[i].terms) {
                out->column[at] = term.first;
                out->weight[at++] = term.second;
            }
            out->offset[i + 1] = static_cast<int64_t>(at);
        }
        return qc_status(QC_OK);
    });
    if (status != QC_OK) qo_rows_free(out);
    return status;
}
