#pragma once

#include "kernels/predicates/orientation.h"

#include <cmath>
#include <limits>

namespace boxwood {

/// Error bounds of determinants of coordinate differences in double arithmetic, u = 2^-53.
/// Let each computed difference X have |x - X| <= u |X| + f, f = 3 * 2^-1022: the flushing of two
/// operands and a result by DAZ and FTZ, or nothing if denormals are kept. A triple product of the
/// 3 x 3 determinant passes 3 differences and at most 5 further roundings (product, minor, product,
/// two sums): 8 in all. So if S >= sum |X Y Z| over the six products,
///   |computed - exact| <= ((1 + u)^8 - 1) S + flushing < (8 + 2^-40) u S + flushing.
/// With all |X| <= 2^200 nothing overflows, and flushing <= 6 * 3 * f * 2^400 for the differences
/// plus fewer than 30 * 2^-1022 * 2^200 for what follows: less than 2^-600. The 2 x 2 determinant
/// passes 2 differences and 2 roundings: 4 u S + 6 f * 2^200 + ... .
/// S is itself computed with at most 6 roundings, from differences rounded monotonically: 8 -> 9
/// and 4 -> 5 leave room for that and for the last rounding of the bound.
namespace filter_bound {

inline constexpr double u = std::numeric_limits<double>::epsilon() / 2;
inline constexpr double orient3d = 9 * u; ///< times S, plus `flushing`
inline constexpr double orient2d = 5 * u; ///< times S, plus `flushing`
inline constexpr double flushing = 0x1p-600;
inline constexpr double largest = 0x1p200; ///< differences beyond it are not judged

} // namespace filter_bound

/// The determinants in plain double arithmetic, and their sign only where the error cannot change
/// it: undecided near zero, beyond differences of 2^200, and for NaN. Never says 0. The bound is
/// semi-static: S = 6 mx my mz, or 2 mx my, of the largest |difference| per axis. Right whether
/// denormals are flushed or not. Bound: filter_bound.
struct Filtered {
    using Real = double;
    static constexpr std::string_view name = "filtered";
    static constexpr std::string_view summary =
        "determinants in double where their error bound decides";
    static constexpr std::string_view bound =
        "9u * (sum of |triple products|) + 2^-600 per sign, else maybe; derived in "
        "predicates/filtered.h";
    static constexpr std::string_view cost = "1.4 times f64";
    static constexpr Promise promise = Promise::certified;
    static constexpr std::uint8_t tier = 0;

    static int orient3d(Vec3<double> a, Vec3<double> b, Vec3<double> c, Vec3<double> d) {
        const Vec3<double> ab = b - a, ac = c - a, ad = d - a;
        const Vec3<double> max_edge = max(max(abs(ab), abs(ac)), abs(ad));
        if (!(std::max(std::max(max_edge.x, max_edge.y), max_edge.z) < filter_bound::largest))
            return undecided;
        return sign(dot(ad, cross(ab, ac)),
                    6 * filter_bound::orient3d * max_edge.x * max_edge.y * max_edge.z +
                        filter_bound::flushing);
    }
    static int orient2d(Point2<double> a, Point2<double> b, Point2<double> c) {
        const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
        const double x = std::max(std::abs(bx), std::abs(cx));
        const double y = std::max(std::abs(by), std::abs(cy));
        if (!(std::max(x, y) < filter_bound::largest))
            return undecided;
        return sign(bx * cy - by * cx, 2 * filter_bound::orient2d * x * y + filter_bound::flushing);
    }

  private:
    static Vec3<double> abs(Vec3<double> v) {
        return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
    }
    static int sign(double det, double error) {
        return det > error ? 1 : det < -error ? -1 : undecided;
    }
};

} // namespace boxwood
