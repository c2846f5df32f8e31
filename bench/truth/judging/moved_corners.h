#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"

#include <array>
#include <optional>

namespace boxwood::bench {

/// What a never-leaks kernel may say of one triangle: its answer is that to a triangle whose
/// corners, seen from the origin, are moved as far as watertight.h says, in [t_min, t_max], with t,
/// u and v rounded once. In doubles, whose own rounding is 2^-29 of what is allowed.
class MovedCorners {
  public:
    MovedCorners(const Ray<float>& ray, const Triangle<float>& triangle);

    /// Whether a kernel may say `hit`. With weights w of the corners p moved by at most m, sum w (p
    /// + m) is on the ray: across it |sum w p| <= max m, along it t d is off by u max|Z|; each
    /// weight and t are off by u more.
    bool allow(const RayHit& hit) const;
    /// Whether it may say that there is a hit.
    bool allow_a_hit() const;
    /// An upper bound of t if however the corners move the triangle is hit: no edge function, which
    /// is a sum of two products of coordinates, can change its sign.
    std::optional<double> surely_hit_by() const;

  private:
    struct Corner {
        double x, y, z;        ///< in ray space: across the ray, and along it
        double move_x, move_y; ///< at most
    };
    /// Twice the area facing a corner, and how far moved corners may change it.
    struct Edge {
        double area, error;
    };
    static Edge edge(const Corner& p, const Corner& q);

    Ray<float> ray_;
    double direction_z_ = 0, max_z_ = 0;
    std::array<Corner, 3> corners_{};
    std::array<Edge, 3> edges_{};
    bool is_finite_, is_in_range_ = false; ///< beyond its range nothing is promised
};

} // namespace boxwood::bench
