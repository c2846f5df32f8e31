#pragma once

#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>

namespace boxwood::detail {

/// How long two boxes stay as they are. The gap between them is how far apart they are on the axis
/// on which they are farthest apart, or, negative, how deep they overlap: whatever the two move in
/// sum, each face of each, up to |gap| leaves it as it is whether they overlap.
struct GapScale {
    static constexpr std::uint32_t overlap = std::uint32_t{1} << 31, last = 128;

    float begin;   ///< the bucket that motion has reached, at most `last`
    float per_gap; ///< buckets in a unit of motion

    /// The scale from here on, of doubles. Less than what is true is safe.
    static GapScale from(double begin, double per_gap) {
        return {static_cast<float>(begin), static_cast<float>(std::min(per_gap, 1e38))};
    }

    /// The bucket of motion in which the gap may be used up, or earlier, and `last` for all beyond;
    /// with the bit `overlap` as `overlaps` says. Of an empty box `last`.
    /// The gap is a difference of floats, its bucket a product: each is rounded by 2^-24 of it (and
    /// by FLT_MIN where denormal numbers are flushed), so that up to `last` less than 2^-14 is lost
    /// or won; 2^-10 is taken off.
    std::uint32_t code(const Box& a, const Box& b) const {
        const Vec3<float> low = max(a.min, b.min), high = min(a.max, b.max), apart = low - high;
        const float gap = std::max(std::max(apart.x, apart.y), apart.z);
        const bool meet = low.x <= high.x && low.y <= high.y && low.z <= high.z;
        const float sure = std::max(std::abs(gap) - 4 * FLT_MIN, 0.f);
        const float at = std::min(begin + sure * per_gap - 0x1p-10f, float{last});
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::max(at, 0.f))) |
               (meet ? overlap : 0);
    }
};

/// The codes of n pairs, which lie `words` numbers of 32 bits apart: the same on every instruction
/// set. At most max_gap_items items.
void gap_codes(const Pair* pairs, std::size_t words, std::size_t n, const Box* boxes,
               GapScale scale, std::uint32_t* codes);
inline constexpr std::size_t max_gap_items = std::size_t{1} << 28;

} // namespace boxwood::detail
