#pragma once

#include "kernels/convex/signed_distance.h"
#include "kernels/testing/poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

/// Convex shapes at random, and what judges bounds of their signed distance: support values in long
/// double from formulas of their own, and a search of directions.
namespace boxwood::convex {

using Wide = long double;
using WideVec = std::array<Wide, 3>;

inline WideVec wide(const Vec3<double>& v) { return {v.x, v.y, v.z}; }
inline Wide dot(const WideVec& a, const WideVec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline WideVec normalized(WideVec v) {
    const Wide size = std::sqrt(dot(v, v));
    for (Wide& x : v)
        x /= size;
    return v;
}

/// The greatest d . p of the shape's points: the support value.
inline Wide farthest(const Sphere& s, const WideVec& d) { return s.radius * std::sqrt(dot(d, d)); }
inline Wide farthest(const Box& s, const WideVec& d) {
    return s.half.x * std::abs(d[0]) + s.half.y * std::abs(d[1]) + s.half.z * std::abs(d[2]);
}
inline Wide farthest(const Capsule& s, const WideVec& d) {
    return s.half_length * std::abs(d[2]) + s.radius * std::sqrt(dot(d, d));
}
inline Wide farthest(const Cylinder& s, const WideVec& d) {
    return s.half_length * std::abs(d[2]) + s.radius * std::hypot(d[0], d[1]);
}
inline Wide farthest(const Cone& s, const WideVec& d) {
    return std::max(s.half_length * d[2], s.radius * std::hypot(d[0], d[1]) - s.half_length * d[2]);
}
inline Wide farthest(const Ellipsoid& s, const WideVec& d) {
    const WideVec e{s.radii.x * d[0], s.radii.y * d[1], s.radii.z * d[2]};
    return std::sqrt(dot(e, e));
}
inline Wide farthest(const Hull& s, const WideVec& d) {
    Wide most = -std::numeric_limits<Wide>::infinity();
    for (const Vec3<double>& p : s.points())
        most = std::max(most, dot(wide(p), d));
    return most;
}
inline Wide farthest(const Triangle& s, const WideVec& d) {
    return std::max({dot(wide(s.a), d), dot(wide(s.b), d), dot(wide(s.c), d)});
}

/// A shape and where it is; the points of a hull are its own.
struct PosedShape {
    Shape shape;
    Pose pose;
};

/// The greatest d . p of the posed shape's points; the radius of balls and capsules stays as it is.
inline Wide farthest(const PosedShape& s, const WideVec& d) {
    const auto& m = s.pose.rotation;
    WideVec local{};
    for (std::size_t k = 0; k < 3; ++k)
        local[k] = m[0][static_cast<int>(k)] * d[0] + m[1][static_cast<int>(k)] * d[1] +
                   m[2][static_cast<int>(k)] * d[2];
    const Wide size = std::sqrt(dot(d, d));
    return dot(wide(s.pose.translation), d) + s.shape.visit([&]<class S>(const S& shape) -> Wide {
        if constexpr (std::is_same_v<S, Sphere>)
            return shape.radius * size;
        else if constexpr (std::is_same_v<S, Capsule>)
            return shape.half_length * std::abs(local[2]) + shape.radius * size;
        else if constexpr (BoundedShape<S>)
            return farthest(shape, local);
        else
            return std::numeric_limits<Wide>::infinity();
    });
}

/// How far b is beyond a along d: a lower bound of the signed distance, and the greatest over all d
/// is the signed distance.
inline Wide gap(const PosedShape& a, const PosedShape& b, const WideVec& direction) {
    const WideVec d = normalized(direction);
    return -farthest(b, {-d[0], -d[1], -d[2]}) - farthest(a, d);
}

/// The greatest gap that a search finds: from the direction given and `tries` random ones, the best
/// `climbs` of them improved by steps that are halved `halvings` times.
inline Wide greatest_gap(RandomPoses& random, const PosedShape& a, const PosedShape& b,
                         const WideVec& first, int tries, int climbs, int halvings) {
    std::vector<std::pair<Wide, WideVec>> found{{gap(a, b, first), normalized(first)}};
    for (int i = 0; i < tries; ++i) {
        const WideVec d = normalized(wide(random.unit_vector()));
        found.push_back({gap(a, b, d), d});
    }
    std::sort(found.begin(), found.end(), [](auto& x, auto& y) { return x.first > y.first; });
    Wide most = found.front().first;
    for (int i = 0; i < climbs && i < static_cast<int>(found.size()); ++i) {
        auto [value, d] = found[static_cast<std::size_t>(i)];
        Wide step = 0.3L;
        for (int halving = 0; halving < halvings; step /= 2, ++halving)
            for (int turn = 0; turn < 6; ++turn) {
                const WideVec way = wide(random.unit_vector());
                for (const Wide sign : {step, -step}) {
                    const WideVec e = normalized(
                        {d[0] + sign * way[0], d[1] + sign * way[1], d[2] + sign * way[2]});
                    if (const Wide g = gap(a, b, e); g > value)
                        value = g, d = e;
                }
            }
        most = std::max(most, value);
    }
    return most;
}

/// Shapes of every kind; hulls are of points that are kept as long as this is.
class RandomShapes {
  public:
    explicit RandomShapes(std::uint64_t seed) : random(seed) {
        for (int i = 0; i < 24; ++i) {
            std::vector<Vec3<double>>& points = clouds_.emplace_back();
            const int n = random.whole(4, 40);
            for (int k = 0; k < n; ++k)
                points.push_back(i % 2 ? random.unit_vector() : random.vector(1));
        }
    }

    /// Lengths of 2^low to 2^high.
    Shape shape(ShapeKind kind, double low = -2, double high = 0) {
        const auto size = [&] { return std::exp2(random.real(low, high)); };
        switch (kind) {
        case ShapeKind::sphere:
            return Sphere{size()};
        case ShapeKind::box:
            return Box{{size(), size(), size()}};
        case ShapeKind::capsule:
            return Capsule{size(), size()};
        case ShapeKind::cylinder:
            return Cylinder{size(), size()};
        case ShapeKind::cone:
            return Cone{size(), size()};
        case ShapeKind::ellipsoid:
            return Ellipsoid{{size(), size(), size()}};
        case ShapeKind::half_space:
            return HalfSpace{random.unit_vector(), random.real(-1, 1)};
        case ShapeKind::plane:
            return Plane{random.unit_vector(), random.real(-1, 1)};
        case ShapeKind::hull: {
            auto& cloud = clouds_[static_cast<std::size_t>(random.whole(0, 23))];
            std::vector<Vec3<double>>& points = scaled_[next_++ % scaled_.size()];
            points = cloud;
            const double s = size();
            for (auto& p : points)
                p = p * s;
            return Hull(points);
        }
        case ShapeKind::triangle:
            return Triangle{random.vector(size()), random.vector(size()), random.vector(size())};
        }
        return Sphere{};
    }
    PosedShape posed(ShapeKind kind, double spread, double low = -2, double high = 0) {
        return {shape(kind, low, high), {random.rotation(), random.vector(spread)}};
    }

    RandomPoses random;

  private:
    std::vector<std::vector<Vec3<double>>> clouds_;
    std::array<std::vector<Vec3<double>>, 64> scaled_; ///< the last 64 hulls are valid
    std::size_t next_ = 0;
};

} // namespace boxwood::convex
