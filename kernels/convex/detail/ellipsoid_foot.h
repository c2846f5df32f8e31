#pragma once

#include "kernels/convex/detail/foot.h"

/// The point of an ellipsoid's surface that is nearest to a point, by the multiplier lambda of
/// Lagrange: x_i = a_i t_i with t_i = a_i p_i / d_i, d_i = a_i^2 + lambda, and t of unit length.
namespace boxwood::convex::detail {

struct EllipsoidFoot {
    Vec3<double> radii, point, products{}; ///< products: a_i p_i
    Vec3<double> beyond{};                 ///< a_i^2 - a_k^2, of the least radius a_k
    int least = 0;                         ///< k
    /// lambda + a_k^2 >= 0, with which the d_i do not cancel; first where one t_i is 1 and none is
    /// more, left of the root.
    double shift = 0;

    /// Radii below 2^-60 of the greatest count as 0, and so does a coordinate whose product with
    /// its radius is next to nothing: both are less than rounding.
    EllipsoidFoot(Vec3<double> p, Vec3<double> a);

    /// Goes to the root, in some five turns.
    void solve();

    /// Bounds that hold for any shift, and meet at the root.
    Foot foot() const;

  private:
    double divisor(int i) const { return beyond[i] + shift; }
    Vec3<double> divided(Vec3<double> v) const;
    bool is_inside() const;
};

} // namespace boxwood::convex::detail
