#pragma once

#include "kernels/convex/support.h"
#include "kernels/primitives/rotation.h"

#include <array>

namespace boxwood::convex::detail {

using Rows = Rotation;
using boxwood::times, boxwood::transposed_times;

[[gnu::always_inline]] inline Vec3<double> third_column(const Rows& m) {
    return {m[0].z, m[1].z, m[2].z};
}

/// What a matrix lacks of being orthonormal: a bound on the norm of MM' - 1, which is also that of
/// M'M - 1.
[[gnu::always_inline]] inline double defect(const Rows& m) {
    const double xy = std::abs(dot(m[0], m[1])), yz = std::abs(dot(m[1], m[2])),
                 zx = std::abs(dot(m[2], m[0]));
    return std::max({std::abs(dot(m[0], m[0]) - 1) + xy + zx,
                     std::abs(dot(m[1], m[1]) - 1) + xy + yz,
                     std::abs(dot(m[2], m[2]) - 1) + yz + zx}) +
           10 * u;
}
/// A pose whose matrix lacks more than this is none.
inline constexpr double max_defect = 0x1p-10;

/// The second frame seen from the first.
struct RelativePose {
    Rows rotation; ///< rows
    Vec3<double> translation;
    double lack; ///< of the two rotations together

    RelativePose(const Pose& a, const Pose& b)
        : rotation(transposed_product(a.rotation, b.rotation)),
          translation(transposed_times(a.rotation, b.translation - a.translation)),
          lack(defect(a.rotation) + defect(b.rotation)) {}

    Vec3<double> operator()(Vec3<double> p) const { return times(rotation, p) + translation; }
    Vec3<double> rotated(Vec3<double> d) const { return times(rotation, d); }
    Vec3<double> rotated_back(Vec3<double> d) const { return transposed_times(rotation, d); }
};

/// How far a signed distance may be off that is computed in a's frame from support points, by
///   lo = v.w / |v|   (v any direction, w the support point of the difference D = A - B along -v)
///   hi = |v|         (v = sum of weights times points w of D)
/// With S >= |translation| + reach of both, and d the lack of the rotations, bounds of size:
///   a's rotation taken back: the set D is bent by d S and its signed distance scaled by 1 +- d;
///   entries of the relative rotation 3u, of its translation 4u, thus points of b  17u S;
///   R y + t and the difference  8u S; the support points themselves  8u S;
///   v.w, |v| and the quotient  7u S; of hi: weights and their sum  8u S.
/// All less than 48u S + 2d S; the rest is room for the rounding of this bound and for adding radii
/// of no more than S. Shapes are closed; sets that move by e change a signed distance by at most e.
inline double distance_error(double size, double lack) { return (64 * u + 2 * lack) * size; }

/// Sizes for which no product of the kernels leaves the range of doubles.
inline constexpr double smallest_size = 0x1p-100, largest_size = 0x1p100;

} // namespace boxwood::convex::detail
