#include "trees/curve_order.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace boxwood {
namespace {

constexpr int bits = 21;
using Cell = std::array<std::uint32_t, 3>;

std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}
std::uint64_t morton(const Cell& c) { return spread(c[0]) << 2 | spread(c[1]) << 1 | spread(c[2]); }

/// The transposed Hilbert index of a cell, interleaved. Source: Skilling 2004, "Programming the
/// Hilbert curve".
std::uint64_t hilbert(Cell c) {
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
        for (std::uint32_t& x : c) {
            const std::uint32_t p = q - 1;
            if ((x & q) != 0)
                c[0] ^= p;
            else {
                const std::uint32_t t = (c[0] ^ x) & p;
                c[0] ^= t;
                x ^= t;
            }
        }
    c[1] ^= c[0];
    c[2] ^= c[1];
    std::uint32_t t = 0;
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
        if ((c[2] & q) != 0)
            t ^= q - 1;
    for (std::uint32_t& x : c)
        x ^= t;
    return morton(c);
}

} // namespace

CurveOrder curve_order(Boxes boxes, Curve curve, const Executor&) {
    require_valid(boxes);
    const std::size_t n = boxes.size();
    Aabb<double> centres;
    const auto centre = [&](std::size_t i) {
        return .5 * (Vec3<double>(boxes[i].min) + Vec3<double>(boxes[i].max));
    };
    for (std::size_t i = 0; i < n; ++i)
        centres.extend(centre(i));
    const Vec3<double> extent = centres.max - centres.min;
    const double side = std::max({extent.x, extent.y, extent.z});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3<double> at = centre(i) - centres.min;
        Cell cell{};
        for (int axis = 0; axis < 3; ++axis)
            if (side > 0)
                cell[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(
                    std::min(at[axis] / side * (1 << bits), double{(1 << bits) - 1}));
        sorted[i] = {curve == Curve::morton ? morton(cell) : hilbert(cell),
                     static_cast<std::uint32_t>(i)};
    }
    std::ranges::sort(sorted);
    CurveOrder result{Buffer<std::uint64_t>(n), Buffer<std::uint32_t>(n)};
    for (std::size_t i = 0; i < n; ++i) {
        result.codes[i] = sorted[i].first;
        result.order[i] = sorted[i].second;
    }
    return result;
}

} // namespace boxwood
