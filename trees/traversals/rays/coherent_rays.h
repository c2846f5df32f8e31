#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/ray_box/fused_slabs.h"
#include "trees/traversals/rays/ray_traversal.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace boxwood::detail {

/// Rays that go through a tree together, if they are coherent.
inline constexpr std::size_t packet_size = 16;

/// A set of packets of one chunk: packet i holds its rays [16 i, 16 i + 16).
class PacketSet {
  public:
    void add(std::size_t packet) { bits_ |= std::uint32_t{1} << packet; }
    /// The packet of this ray.
    bool holds(std::size_t ray) const { return bits_ >> (ray / packet_size) & 1; }

  private:
    static_assert(ray_chunk <= 32 * packet_size);
    std::uint32_t bits_ = 0;
};

/// Whether rays begin near each other, as measured by the bounds of all that they may meet, and go
/// much the same way: then they visit much the same nodes. No if one of them is not finite, or an
/// end of it no number.
inline bool are_coherent(std::span<const Ray<float>> rays, const SlabBounds& bounds) {
    const Ray<float>& lead = rays[0];
    float size = 0, length = 0;
    for (int axis = 0; axis < 3; ++axis) {
        size = std::max(size, bounds.max[axis] - bounds.min[axis]);
        length = std::max(length, std::abs(lead.direction[axis]));
    }
    const float near = 0x1p-5f * size, alike = 0x1p-4f * length;
    bool are = std::isfinite(near) && std::isfinite(length);
    for (const Ray<float>& ray : rays) {
        are &= !std::isnan(ray.t_min) && !std::isnan(ray.t_max);
        for (int axis = 0; axis < 3; ++axis) {
            are &= std::abs(ray.direction[axis] - lead.direction[axis]) <= alike;
            are &= std::abs(ray.origin[axis] - lead.origin[axis]) <= near;
        }
    }
    return are;
}

/// p * rdir - shift, a bound of many such lines for all p between two ends.
struct BoundingLine {
    float rdir, shift;
};

/// What BoundingLine is made of: lines p * r_i - s_i, whose signs are all that of `like`.
struct LineEnds {
    float low, high;       ///< p
    float at_low, at_high; ///< the least of all there, or the greatest
    float size;            ///< |r_i| * max(|low|, |high|) + |s_i| of all, the greatest
    float like;            ///< one of the r_i
};

namespace line {

/// 0 where the lines are too large for a bound that says anything.
inline float pad(const LineEnds& ends, float slope) {
    // Roundings, u = 2^-24, in terms of w = size + |slope| max(|low|, |high|): of the lines at the
    // ends and at p, fused or not, 2u w each, here 3u w, of the bounding line at p 3u w: 32u w is
    // more, and 2^-140 more than what underflows.
    const float widest = std::max(std::abs(ends.low), std::abs(ends.high));
    const float pad = 0x1p-19f * (ends.size + std::abs(slope) * widest) + 0x1p-140f;
    return pad < 0x1p80f ? pad : 0;
}

inline float slope(const LineEnds& ends) {
    const float slope = (ends.at_high - ends.at_low) / (ends.high - ends.low);
    if (!std::isfinite(slope))
        return ends.like;
    return std::copysign(std::max(std::abs(slope), std::numeric_limits<float>::min()), ends.like);
}

} // namespace line

/// Not above any of the lines, evaluated in floats, at any p from low to high; also evaluated in
/// floats. rdir has the sign of the lines and is not 0. The least of lines is concave: less any
/// slope it is least at an end.
inline BoundingLine line_below(const LineEnds& ends) {
    const float slope = line::slope(ends), pad = line::pad(ends, slope);
    if (!(pad > 0))
        return {std::copysign(std::numeric_limits<float>::min(), ends.like),
                std::numeric_limits<float>::max()};
    return {slope,
            std::max(slope * ends.low - ends.at_low, slope * ends.high - ends.at_high) + pad};
}

/// Not below any of them; at_low and at_high are the greatest.
inline BoundingLine line_above(const LineEnds& ends) {
    const float slope = line::slope(ends), pad = line::pad(ends, slope);
    if (!(pad > 0))
        return {std::copysign(std::numeric_limits<float>::min(), ends.like),
                -std::numeric_limits<float>::max()};
    return {slope,
            std::min(slope * ends.low - ends.at_low, slope * ends.high - ends.at_high) - pad};
}

} // namespace boxwood::detail
