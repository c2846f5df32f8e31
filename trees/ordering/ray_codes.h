#pragma once

#include "kernels/arithmetic/on_both.h"
#include "kernels/primitives/ray.h"
#include "trees/tree.h"

#include <cstdint>

namespace boxwood {

/// Codes of rays: those next to each other visit much the same nodes of a tree. The octant of the
/// direction stands above the place on a Morton curve where the ray enters the cube around a box.
class EntryGrid {
  public:
    static constexpr int bits = 7; ///< per axis: with the octant three digits of radix_sort

    explicit EntryGrid(const Box& bounds)
        : plane_{{bounds.min.x, bounds.min.y, bounds.min.z},
                 {bounds.max.x, bounds.max.y, bounds.max.z}} {
        const auto extent =
            static_cast<Vec3<double>>(bounds.max) - static_cast<Vec3<double>>(bounds.min);
        const double xy = larger(extent.x, extent.y), side = larger(xy, extent.z);
        scale_ = side > 0 ? static_cast<float>((1 << bits) / side) : 0;
    }

    /// Any ray has a code, of 3 bits + 3: one that passes by, and whatever is not a number or
    /// overflows, gets that of some cell.
    BOXWOOD_BOTH std::uint32_t code(const Ray<float>& ray) const {
        float t = ray.t_min;
        const std::uint32_t octant = enter<0>(ray.origin.x, ray.direction.x, t) |
                                     enter<1>(ray.origin.y, ray.direction.y, t) |
                                     enter<2>(ray.origin.z, ray.direction.z, t);
        const std::uint32_t curve = cell<0>(ray.origin.x + t * ray.direction.x) |
                                    cell<1>(ray.origin.y + t * ray.direction.y) |
                                    cell<2>(ray.origin.z + t * ray.direction.z);
        return octant << 3 * bits | curve;
    }

    /// Bit i of a cell's number goes to bit 3 i.
    BOXWOOD_BOTH static constexpr std::uint32_t spread(std::uint32_t cell) {
        cell = (cell | cell << 8) & 0x0000f00fu;
        cell = (cell | cell << 4) & 0x000c30c3u;
        return (cell | cell << 2) & 0x00249249u;
    }

  private:
    template <class Real> BOXWOOD_BOTH static Real larger(Real a, Real b) { return a < b ? b : a; }

    /// The ray is not within the bounds before this t; gives its bit of the octant.
    template <int axis>
    BOXWOOD_BOTH std::uint32_t enter(float origin, float direction, float& t) const {
        const std::uint32_t sign = bits_as<std::uint32_t>(direction) >> 31;
        t = larger(t, (plane_[sign][axis] - origin) / direction);
        return sign << axis;
    }
    template <int axis> BOXWOOD_BOTH std::uint32_t cell(float place) const {
        const float at = larger(first_, (place - plane_[0][axis]) * scale_);
        return spread(static_cast<std::uint32_t>(last_ < at ? last_ : at)) << axis;
    }

    float plane_[2][3];
    float scale_;
    /// Cells along an axis; constants would be taken for cases apart, whose branches are
    /// mispredicted.
    float first_ = 0, last_ = (1 << bits) - 1;
};
static_assert(EntryGrid::spread(0x7f) == 0x49249 && EntryGrid::spread(0x50) == 0x41000);

} // namespace boxwood
