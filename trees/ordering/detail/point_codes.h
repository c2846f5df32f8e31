#pragma once

#include "trees/ordering/ray_codes.h"

#include <algorithm>

namespace boxwood::detail {

/// Codes of points: those next to each other visit much the same nodes of a tree. The place on a
/// Morton curve through the cube around a box.
class PointGrid {
  public:
    static constexpr int bits = 8; ///< per axis: three digits of radix_sort

    template <class Real> explicit PointGrid(const Aabb<Real>& bounds) : low_(bounds.min) {
        const auto extent =
            static_cast<Vec3<double>>(bounds.max) - static_cast<Vec3<double>>(bounds.min);
        const double side = std::max({extent.x, extent.y, extent.z});
        scale_ = side > 0 ? static_cast<float>((1 << bits) / side) : 0;
    }

    /// Any point has a code; one that lies elsewhere, or is not a number, gets that of some cell.
    std::uint32_t code(Vec3<float> point) const {
        return cell<0>(point) | cell<1>(point) | cell<2>(point);
    }

  private:
    template <int axis> std::uint32_t cell(Vec3<float> point) const {
        const float at = (point[axis] - low_[axis]) * scale_;
        const float cell = at > 0 ? std::min(at, (1 << bits) - 1.0f) : 0; // NaN is not above 0
        return EntryGrid::spread(static_cast<std::uint32_t>(cell)) << axis;
    }

    Vec3<float> low_;
    float scale_;
};
static_assert(EntryGrid::spread(0xff) == 0x249249);

} // namespace boxwood::detail
