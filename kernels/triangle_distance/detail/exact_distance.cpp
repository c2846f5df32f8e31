#include "kernels/triangle_distance/detail/exact_distance.h"

#include "kernels/triangle_distance/detail/greatest_gap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace boxwood::detail {
namespace {

/// The largest power of two of which all coordinates are whole multiples.
int grid_of(const std::array<Vec3<double>, 6>& points) {
    int grid = 1024;
    for (const Vec3<double>& p : points)
        for (int k = 0; k < 3; ++k)
            if (const Binary64 x(p[k]); x.mantissa != 0)
                grid = std::min(grid, x.weight + std::countr_zero(x.mantissa));
    return grid;
}

} // namespace

Scaled exact_distance(const Triangle<double>& a, const Triangle<double>& b) {
    const std::array<Vec3<double>, 6> points{a.a, a.b, a.c, b.a, b.b, b.c};
    const int grid = grid_of(points); // coordinates are multiples of 2^(grid - 1074)
    WholeVector<LongInteger> at[6];
    for (std::size_t i = 0; i < 6; ++i)
        for (int k = 0; k < 3; ++k)
            at[i].of[k] = LongInteger(Binary64(points[i][k]), -grid);
    const Scaled gap = GreatestGap<LongInteger>(at).distance();
    return {gap.m, gap.exponent + grid - 1074};
}

} // namespace boxwood::detail
