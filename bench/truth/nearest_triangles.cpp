#include "bench/truth/nearest_triangles.h"

#include "kernels/oracle/nearest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace boxwood::bench {
namespace {

constexpr std::uint32_t max_leaf = 2;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// How far a box reaches along a direction.
struct Reach {
    double least, greatest;
};
Reach reach(const Aabb<double>& box, Vec3<double> d) {
    Reach r{0, 0};
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min[axis] * d[axis], high = box.max[axis] * d[axis];
        r.least += std::min(low, high);
        r.greatest += std::max(low, high);
    }
    return r;
}
Reach reach(const Triangle<double>& t, Vec3<double> d) {
    const double a = dot(t.a, d), b = dot(t.b, d), c = dot(t.c, d);
    return {std::min({a, b, c}), std::max({a, b, c})};
}
double gap(Reach a, Reach b) { return std::max(a.least - b.greatest, b.least - a.greatest); }

double size_of(const Aabb<double>& box) {
    double size = 0;
    for (int axis = 0; axis < 3; ++axis)
        size = std::max({size, std::abs(box.min[axis]), std::abs(box.max[axis])});
    return size;
}

} // namespace

double gap_of(const Aabb<double>& a, const Aabb<double>& b) {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = std::max({0.0, a.min[axis] - b.max[axis], b.min[axis] - a.max[axis]});
        squared += d * d;
    }
    return std::sqrt(squared) * (1 - 0x1p-50);
}

NearestTriangles::NearestTriangles(std::span<const Triangle<double>> triangles)
    : triangles_(triangles.begin(), triangles.end()), order_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty())
        split(0, static_cast<std::uint32_t>(order_.size()));
    fit();
}

void NearestTriangles::move(std::span<const Triangle<double>> triangles) {
    triangles_.assign(triangles.begin(), triangles.end());
    fit();
}

/// Halves at the median along the longest side of the corners' box.
std::uint32_t NearestTriangles::split(std::uint32_t begin, std::uint32_t end) {
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, begin, end});
    if (end - begin <= max_leaf)
        return at;
    Aabb<double> corners;
    for (std::uint32_t i = begin; i < end; ++i)
        corners.extend(triangles_[order_[i]].a);
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (corners.max[k] - corners.min[k] > corners.max[axis] - corners.min[axis])
            axis = k;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return triangles_[a].a[axis] < triangles_[b].a[axis];
                     });
    split(begin, middle);
    nodes_[at].right = split(middle, end);
    return at;
}

void NearestTriangles::fit() {
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        node.box = {};
        if (node.right) {
            node.box = merge(nodes_[i + 1].box, nodes_[node.right].box);
            continue;
        }
        for (std::uint32_t k = node.begin; k < node.end; ++k)
            node.box.extend(triangles_[order_[k]].bounds());
    }
}

/// Depth first, the nearer half first. `direction_` is that of the least distance so far: along it
/// what lies behind is far apart, also where boxes are near.
class NearestTriangles::Search {
  public:
    Search(const NearestTriangles& a, const NearestTriangles& b, double at_most)
        : a_(a), b_(b), least_(at_most) {
        const double size = std::max(size_of(a.nodes_[0].box), size_of(b.nodes_[0].box));
        rounding_ = 0x1p-46 * size;
    }

    Least run() {
        visit(0, 0);
        const double lo = std::min(least_, skipped_);
        return {least_, std::max(lo, 0.0)};
    }

  private:
    /// No pair of the two is nearer.
    template <class A, class B>
    double bound(const A& a, const B& b, const Aabb<double>& box_a,
                 const Aabb<double>& box_b) const {
        return std::max(gap_of(box_a, box_b),
                        gap(reach(a, direction_), reach(b, direction_)) - rounding_);
    }
    double bound(const Node& a, const Node& b) const { return bound(a.box, b.box, a.box, b.box); }

    /// What may only be nearer by 2^-40 is left out, and remembered.
    bool may_be_nearer(double bound) {
        if (bound < least_ * (1 - 0x1p-40))
            return true;
        skipped_ = std::min(skipped_, bound);
        return false;
    }

    void visit(std::uint32_t i, std::uint32_t j) {
        const Node &a = a_.nodes_[i], &b = b_.nodes_[j];
        if (!may_be_nearer(bound(a, b)))
            return;
        if (!a.right && !b.right)
            return decide(a, b);
        const bool open_a = !b.right || (a.right && a.end - a.begin >= b.end - b.begin);
        std::array<std::array<std::uint32_t, 2>, 2> halves{{{i, j}, {i, j}}};
        (open_a ? halves[0][0] : halves[0][1]) = (open_a ? i : j) + 1;
        (open_a ? halves[1][0] : halves[1][1]) = open_a ? a.right : b.right;
        const auto bound_of = [&](const auto& half) {
            return bound(a_.nodes_[half[0]], b_.nodes_[half[1]]);
        };
        if (bound_of(halves[1]) < bound_of(halves[0]))
            std::swap(halves[0], halves[1]);
        for (const auto& half : halves)
            visit(half[0], half[1]);
    }

    void decide(const Node& a, const Node& b) {
        for (std::uint32_t k = a.begin; k < a.end; ++k)
            for (std::uint32_t l = b.begin; l < b.end; ++l) {
                const Triangle<double>& s = a_.triangles_[a_.order_[k]];
                const Triangle<double>& t = b_.triangles_[b_.order_[l]];
                if (may_be_nearer(bound(s, t, s.bounds(), t.bounds())) &&
                    may_be_nearer(gap_along_normals(s, t)))
                    take(oracle::nearest(s, t));
            }
    }

    /// A bound, too: where surfaces are parallel it leaves out what boxes do not.
    double gap_along_normals(const Triangle<double>& s, const Triangle<double>& t) const {
        double greatest = 0;
        for (const Triangle<double>* of : {&s, &t}) {
            const Vec3<double> normal = cross(of->b - of->a, of->c - of->a);
            const double size = length(normal);
            if (!(size > 0x1p-500 && size < 0x1p500))
                continue;
            const Vec3<double> d = normal * ((1 - 0x1p-48) / size);
            greatest = std::max(greatest, gap(reach(s, d), reach(t, d)) - rounding_);
        }
        return greatest;
    }

    void take(const oracle::Nearest& nearest) {
        const double distance = std::sqrt(nearest.squared.get_d());
        if (distance >= least_)
            return;
        least_ = distance;
        const auto way_along = [&](std::size_t axis) {
            return mpq_class(nearest.b[axis] - nearest.a[axis]).get_d();
        };
        const Vec3<double> way{way_along(0), way_along(1), way_along(2)};
        if (distance > 0)
            direction_ = way * ((1 - 0x1p-48) / length(way));
    }

    const NearestTriangles &a_, &b_;
    double rounding_;          ///< of a gap along a direction
    Vec3<double> direction_{}; ///< shorter than 1, so that a gap along it is a bound
    double least_, skipped_ = infinity;
};

NearestTriangles::Least NearestTriangles::to(const NearestTriangles& other, double at_most) const {
    if (order_.empty() || other.order_.empty())
        return {at_most, at_most};
    return Search(*this, other, at_most).run();
}

} // namespace boxwood::bench
