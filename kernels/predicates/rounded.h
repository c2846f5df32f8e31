#pragma once

#include "kernels/predicates/orientation.h"

namespace boxwood {

/// Determinants in plain double arithmetic. Exact while the products need at most 53 bits (integers
/// up to 2^16 in size); else wrong signs are possible wherever the determinant is near zero, also
/// by underflow. Overflow to NaN and NaN input are undecided.
struct Rounded {
    static constexpr std::string_view name = "rounded";
    static constexpr std::string_view summary = "determinants in plain double";
    static constexpr Promise promise = Promise::none;
    static constexpr std::uint8_t tier = 0;

    static int orient3d(Vec3<double> a, Vec3<double> b, Vec3<double> c, Vec3<double> d) {
        return sign(dot(d - a, cross(b - a, c - a)));
    }
    static int orient2d(Point2 a, Point2 b, Point2 c) {
        return sign((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }

  private:
    static int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : x == 0 ? 0 : undecided; }
};

} // namespace boxwood
