/// The distance of two convex sets that do not touch is the greatest gap between two parallel
/// planes that separate them. Their nearest points lie inside two features (corner, edge, face) and
/// there are such of dimensions 0-0, 0-1, 1-1 (not parallel) or 0-2; the planes there are normal to
/// both features. So the distance is the greatest of gap / |n| over 38 directions n, and no gap of
/// another direction is greater. Directions and gaps are whole numbers; what rounds is the
/// quotient.

#include "kernels/triangle_distance/detail/exact_distance.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

namespace boxwood::detail {
namespace {

using LongVector = std::array<LongInteger, 3>;

LongVector operator-(const LongVector& a, const LongVector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
LongInteger dot(const LongVector& a, const LongVector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
LongVector cross(const LongVector& a, const LongVector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// sqrt(n.n), within 2^-52 of the parts and 2.5u of the sum and root: 2^-51. Parts 2^-500 as large
/// as the largest do not matter.
Scaled length_of(const LongVector& n) {
    const std::array<Scaled, 3> part{n[0].rounded(), n[1].rounded(), n[2].rounded()};
    int largest = std::numeric_limits<int>::min();
    for (const Scaled& p : part)
        if (p.m != 0)
            largest = std::max(largest, p.exponent);
    double sum = 0;
    for (const Scaled& p : part)
        if (p.m != 0 && p.exponent > largest - 500) {
            const double x = std::ldexp(p.m, p.exponent - largest);
            sum += x * x;
        }
    return {std::sqrt(sum), largest};
}

/// The largest power of two of which all coordinates are whole multiples.
int grid_of(const std::array<Vec3<double>, 6>& points) {
    int grid = 1024;
    for (const Vec3<double>& p : points)
        for (int k = 0; k < 3; ++k)
            if (const Binary64 x(p[k]); x.mantissa != 0)
                grid = std::min(grid, x.weight + std::countr_zero(x.mantissa));
    return grid;
}

class GreatestGap {
  public:
    GreatestGap(const Triangle<double>& a, const Triangle<double>& b) {
        const std::array<Vec3<double>, 6> points{a.a, a.b, a.c, b.a, b.b, b.c};
        grid_ = grid_of(points);
        std::array<LongVector, 6> at;
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                at[i][k] = LongInteger(Binary64(points[i][static_cast<int>(k)]), -grid_);
        for (std::size_t i = 0; i < 6; ++i) {
            const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
            edge_[i] = at[next] - at[i];
            from_first_[i] = at[i] - at[0];
        }
        search();
    }

    Scaled distance() const { return {best_.m, best_.exponent + grid_ - 1074}; }

  private:
    void search() {
        try_direction(cross(edge_[0], edge_[1]));
        try_direction(cross(edge_[3], edge_[4]));
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 3; j < 6; ++j) {
                const LongVector between = from_first_[j] - from_first_[i];
                try_direction(between);
                try_direction(cross(edge_[i], edge_[j]));
                for (const LongVector* edge : {&edge_[i], &edge_[j]})
                    try_direction(cross(*edge, cross(between, *edge)));
            }
    }

    /// n and the gap are exact, gap / |n| within 2^-52 + 2^-51 + 2^-53.
    void try_direction(const LongVector& n) {
        LongInteger min_a, max_a, min_b = dot(n, from_first_[3]), max_b = min_b;
        const auto widen = [](LongInteger& low, LongInteger& high, const LongInteger& x) {
            if (x < low)
                low = x;
            else if (high < x)
                high = x;
        };
        for (std::size_t i = 1; i < 3; ++i) {
            widen(min_a, max_a, dot(n, from_first_[i]));
            widen(min_b, max_b, dot(n, from_first_[3 + i]));
        }
        const LongInteger above = min_a - max_b, below = min_b - max_a;
        const LongInteger& gap = above.sign() > 0 ? above : below;
        if (gap.sign() <= 0)
            return;
        const Scaled size = gap.rounded(), length = length_of(n);
        int exponent = 0;
        const double m = 2 * std::frexp(size.m / length.m, &exponent);
        exponent += size.exponent - length.exponent - 1;
        if (best_.m == 0 || exponent > best_.exponent ||
            (exponent == best_.exponent && m > best_.m))
            best_ = {m, exponent};
    }

    int grid_ = 0; ///< coordinates are multiples of 2^(grid_ - 1074)
    std::array<LongVector, 6> edge_, from_first_;
    Scaled best_;
};

} // namespace

Scaled exact_distance(const Triangle<double>& a, const Triangle<double>& b) {
    return GreatestGap(a, b).distance();
}

} // namespace boxwood::detail
