#pragma once

#include "trees/executor.h"
#include "trees/tree.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace boxwood::detail {

/// An item on its way to a leaf, 32 bytes: lanes 0-2 hold max, 4-6 hold -min, so that one maximum
/// of eight lanes grows a box. Lane 3 holds the item: bits whose float is no denormal, arithmetic
/// on which costs a hundred cycles on some machines (it may be NaN). Lane 7 is 0.
struct alignas(16) Prim8 {
    float v[8];

    std::uint32_t item() const { return std::bit_cast<std::uint32_t>(v[3]) & 0x3fffffff; }
    static float lane_of_item(std::size_t item) {
        return std::bit_cast<float>(0x40000000 | static_cast<std::uint32_t>(item));
    }
    /// max + min along an axis.
    float doubled_centre(int axis) const { return v[axis] - v[4 + axis]; }
    Box box() const { return {{-v[4], -v[5], -v[6]}, {v[0], v[1], v[2]}}; }
};
static_assert(max_items <= 0x40000000);

/// The items of boxes, scaled by a power of two so that no sum, square or count times an area
/// overflows. For coordinates between 2^-40 and 2^40 at the largest, which is any sane scene, the
/// scale is 1.
struct Prims8 {
    Buffer<Prim8> prims;
    alignas(32) float centres[8]; ///< (max, -min) of the doubled centres
    float scale = 1;

    /// Throws as `require_valid`.
    Prims8(Boxes boxes, const Executor& executor);
};

/// Half of the items on each side of the median centre along the axis of largest spread, ties by
/// item; returns how many go first. For `centres` see Prims8.
std::size_t halve(std::span<Prim8> prims, const float (&centres)[8]);
std::size_t halve(std::span<Prim8> prims);

/// The items by their doubled centres along an axis, equal ones in their old order. O(n).
void sort_by_centre(std::span<const Prim8> prims, int axis, std::span<Prim8> sorted);

} // namespace boxwood::detail
