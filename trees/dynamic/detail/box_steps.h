#pragma once

#include "trees/tree.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace boxwood::detail {

/// Whether each is greater than the one before.
bool are_ascending(std::span<const std::uint32_t> items);

/// Whether so many moved that looking at all boxes is less work than at those alone.
inline bool is_nearly_all(std::size_t moved, std::size_t items) { return moved > items / 4; }

/// The most that a face of the box moved: 0 only if the boxes are the same, +inf if one of them is
/// absent and the other is not. Rounded: at most 2^-23 of it, and FLT_MIN, too small.
inline float box_step(const Box& now, const Box& before) {
    const auto step = [](float x, float y) {
        return x == y ? 0.f : std::max(std::abs(x - y), FLT_MIN);
    };
    const auto larger = [&](const Vec3<float>& a, const Vec3<float>& b) {
        return std::max(std::max(step(a.x, b.x), step(a.y, b.y)), step(a.z, b.z));
    };
    return std::max(larger(now.min, before.min), larger(now.max, before.max));
}

/// Boxes are followed sixteen at a time.
inline constexpr std::size_t follow_block = 16;

/// Takes the boxes of the blocks [begin, end) over to `before`, all of a block if none of its boxes
/// went farther than `max_step`, else none. The largest step of block b goes to steps[b]; the
/// numbers of the blocks not taken over go to `far`. Returns how many these are.
std::size_t follow_blocks(Boxes now, Box* before, std::size_t begin, std::size_t end,
                          float max_step, float* steps, std::uint32_t* far);

} // namespace boxwood::detail
