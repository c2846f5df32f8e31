#include "kernels/triangle_distance/detail/refined_bounds.h"

#include "kernels/arithmetic/detail/double_double.h"
#include "kernels/features/segment_segment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace boxwood::detail {
namespace {

using Real = DoubleDouble;
using Vector = std::array<Real, 3>;

constexpr Real zero{0, 0}, one{1, 0};

Vector operator+(const Vector& a, const Vector& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator-(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector operator*(Real s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// Exact.
Vector difference(Vec3<double> a, Vec3<double> b) {
    return {Real::difference(a.x, b.x), Real::difference(a.y, b.y), Real::difference(a.z, b.z)};
}
Vec3<double> rounded(const Vector& a) { return {a[0].hi, a[1].hi, a[2].hi}; }

bool positive(Real x) { return zero < x; }
Real in_unit(Real x) { return !positive(x) ? zero : one < x ? one : x; }
/// 0 where the divisor is 0.
Real ratio(Real x, Real y) { return y.hi == 0 ? zero : x / y; }

/// Errors, absolute, where every difference of coordinates is below 1 and each operation is within
/// 8u^2, u = 2^-53:
///   offset   r + s a - t b of weights taken as exact: per component 8u^2 (1 + 1 + 2 + 3) (two
///            products, two sums of numbers below 2 and 3), so 8u^2 * 7 sqrt(3) < 2^-99; a foot
///            r + u a + v b the same, and 2^-101 for u + v being above 1 by rounding
///   gap      n.(y - x) for differences x, y from one corner: 6 products and their 5 sums, on at
///            most 7 levels: 8u^2 * 4 * 2 |n|_1 <= 64 sqrt(3) u^2 |n| < 2^-99 |n|
/// The rest of 2^-98 is for coordinates off by 2^-1070 and for underflow.
constexpr double error = 0x1p-98;

/// What plain arithmetic is trusted to, of distances at this size.
constexpr double rough = 0x1p-38;

/// A pair of points, one on each: `offset` from b's to a's.
struct Candidate {
    Vector offset, on_a, on_b; ///< on_*: from the triangle's first corner
    double squared;
    int edge_a, edge_b; ///< of a pair of edges; -1: the other's corner and the face's inside
};

struct Shape {
    std::array<Vec3<double>, 3> corner;
    std::array<Vector, 3> edge; ///< 0 to 1, 0 to 2, 1 to 2
    static constexpr std::array<std::size_t, 3> start{0, 0, 1};

    explicit Shape(const Triangle<double>& t)
        : corner{t.a, t.b, t.c}, edge{difference(t.b, t.a), difference(t.c, t.a),
                                      difference(t.c, t.b)} {}
    Segment<double> segment(std::size_t k) const {
        return {corner[start[k]], corner[k == 0 ? 1 : 2]};
    }
};

class Search {
  public:
    Search(const Triangle<double>& a, const Triangle<double>& b) : a_(a), b_(b) {
        // In plain arithmetic first, to leave out what is not nearly the least: only how tight the
        // bounds are depends on it.
        std::array<double, 9> roughly;
        for (std::size_t k = 0; k < 9; ++k)
            roughly[k] =
                length(nearest_on_segments<true>(a_.segment(k / 3), b_.segment(k % 3)).offset);
        const double min_distance = *std::min_element(roughly.begin(), roughly.end());
        for (std::size_t k = 0; k < 9; ++k)
            if (roughly[k] <= min_distance + rough)
                add_edges(k / 3, k % 3);
        add_feet(a_, b_, min_distance, false);
        add_feet(b_, a_, min_distance, true);
        const auto shorter = [](const Candidate& p, const Candidate& q) {
            return p.squared < q.squared;
        };
        std::sort(found_.begin(), found_.begin() + count_, shorter);
    }

    DistanceBounds bounds() {
        const Candidate& best = found_[0];
        const double distance = std::sqrt(best.squared);
        hi_ = distance * (1 + 0x1p-50) + error;
        // Of features that tie but for rounding any may be the right one.
        const double tie = best.squared * (1 + 0x1p-30) + 0x1p-180;
        for (std::size_t i = 0; i < count_ && !tight() && found_[i].squared <= tie; ++i)
            try_normals_of(found_[i]);
        return {lo_, hi_, distance, a_.corner[0] + rounded(best.on_a),
                b_.corner[0] + rounded(best.on_b)};
    }

  private:
    bool tight() const { return lo_ >= hi_ * (1 - 0x1p-40); }

    void add(const Candidate& c) {
        found_[count_] = c;
        // No square underflows: offsets below 2^-98 mean nothing.
        found_[count_++].squared = dot(c.offset, c.offset).hi;
    }

    /// As nearest_on_segments, by the cross product.
    void add_edges(std::size_t i, std::size_t j) {
        const Vector &ea = a_.edge[i], &eb = b_.edge[j];
        const Vec3<double>&a = a_.corner[Shape::start[i]], &b = b_.corner[Shape::start[j]];
        const Vector r = difference(a, b), n = cross(ea, eb);
        const Real aa = dot(ea, ea), bb = dot(eb, eb), ab = dot(ea, eb);
        const Real first = in_unit(ratio(dot(cross(eb, r), n), dot(n, n)));
        const Real t = in_unit(ratio(ab * first + dot(eb, r), bb));
        const Real s = in_unit(ratio(ab * t - dot(ea, r), aa));
        add({(r + s * ea) - t * eb, difference(a, a_.corner[0]) + s * ea,
             difference(b, b_.corner[0]) + t * eb, 0, static_cast<int>(i), static_cast<int>(j)});
    }

    /// Of a face, those corners of the other that are nearest to its plane, and not farther than
    /// `min_distance`.
    void add_feet(const Shape& face, const Shape& other, double min_distance, bool face_is_b) {
        const Vec3<double> e1 = rounded(face.edge[0]), e2 = rounded(face.edge[1]);
        const Vec3<double> n = cross(e1, e2);
        std::array<double, 3> heights;
        for (std::size_t k = 0; k < 3; ++k)
            heights[k] = std::abs(dot(n, other.corner[k] - face.corner[0]));
        const double noise = rough * length(e1) * length(e2);
        const double max_height =
            std::min(*std::min_element(heights.begin(), heights.end()), min_distance * length(n)) +
            noise;
        for (std::size_t k = 0; k < 3; ++k)
            if (heights[k] <= max_height)
                add_foot(face, other, k, face_is_b);
    }

    /// Corner k of the other and its foot in the face, if that is inside.
    void add_foot(const Shape& face, const Shape& other, std::size_t k, bool face_is_b) {
        const Vector &e1 = face.edge[0], &e2 = face.edge[1], n = cross(e1, e2);
        const Vector x = difference(other.corner[k], face.corner[0]);
        const Real nn = dot(n, n);
        const Real u = ratio(dot(cross(x, e2), n), nn), v = ratio(dot(cross(e1, x), n), nn);
        if (!(nn.hi > 0) || u < zero || v < zero || one < u + v)
            return;
        const Vector foot = u * e1 + v * e2, offset = (x - u * e1) - v * e2;
        const Vector corner = difference(other.corner[k], other.corner[0]);
        if (face_is_b)
            add({offset, corner, foot, 0, -1, 0});
        else
            add({Vector{} - offset, foot, corner, 0, 0, -1});
    }

    /// Directions that are normal to what the candidate's points may move along, as exactly as can
    /// be: the offset is, but only within rounding by its length.
    void try_normals_of(const Candidate& c) {
        if (c.edge_a < 0 || c.edge_b < 0) {
            const Shape& face = c.edge_b < 0 ? a_ : b_;
            if (!try_normal(along(c.offset, cross(face.edge[0], face.edge[1]))))
                try_normal(c.offset);
            return;
        }
        const Vector& a = a_.edge[static_cast<std::size_t>(c.edge_a)];
        const Vector& b = b_.edge[static_cast<std::size_t>(c.edge_b)];
        try_normal(c.offset) || try_normal(off(c.offset, a)) || try_normal(off(c.offset, b)) ||
            try_normal(along(c.offset, cross(a, b)));
    }
    /// v without its part along e.
    static Vector off(const Vector& v, const Vector& e) {
        return v - ratio(dot(v, e), dot(e, e)) * e;
    }
    /// n, on v's side.
    static Vector along(const Vector& v, const Vector& n) {
        return dot(v, n) < zero ? Vector{} - n : n;
    }

    /// Raises lo_ to what the planes normal to n (towards a) prove; true if it is tight then.
    bool try_normal(const Vector& n) {
        const double length = std::sqrt(dot(n, n).hi);
        if (!(length > 0x1p-300))
            return false;
        Real min_a = zero, max_b = dot(n, difference(b_.corner[0], a_.corner[0]));
        for (std::size_t k = 1; k < 3; ++k) {
            const Real on_a = dot(n, difference(a_.corner[k], a_.corner[0]));
            const Real on_b = dot(n, difference(b_.corner[k], a_.corner[0]));
            min_a = on_a < min_a ? on_a : min_a;
            max_b = max_b < on_b ? on_b : max_b;
        }
        const double gap = (min_a - max_b).hi;
        lo_ = std::max(lo_, gap / length * (1 - 0x1p-50) - error);
        return tight();
    }

    Shape a_, b_;
    std::array<Candidate, 15> found_;
    std::size_t count_ = 0;
    double lo_ = 0, hi_ = 0;
};

} // namespace

DistanceBounds refined_bounds(const Triangle<double>& a, const Triangle<double>& b) {
    return Search(a, b).bounds();
}

} // namespace boxwood::detail
