#pragma once

#include "kernels/arithmetic/rounding.h"
#include "kernels/primitives/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace boxwood::detail {

/// A triangle whose parts on either side of a plane across an axis are boxed, so that no ray that
/// the watertight kernel lets hit the triangle slips between the boxes of its parts.
///
/// Each box holds all points of the triangle on its side and what lies within `pad` of them, as far
/// as the box of the whole does; pad = 2^-22 of the triangle's extent along each axis.
/// Why: corner i moves by up to 2u |X_i|, u = 2^-24 (ray_box/slabs.h), which is a slack relative to
/// the point that the corners are mixed to as long as all X_i have one sign. Else the sum of w_i
/// |X_i| goes beyond it by at most half the extent: u of the extent across. The roundings here are
/// at most 2^-50 of a coordinate; an extent that is not zero is at least 2^-24 of that, and a zero
/// one gives exact coordinates.
class ClippedTriangle {
  public:
    explicit ClippedTriangle(const Triangle<float>& t) {
        const std::array corners{t.a, t.b, t.c};
        for (int k = 0; k < 3; ++k) {
            for (std::size_t i = 0; i < 3; ++i)
                corner_[i][k] = static_cast<double>(corners[i][k]);
            const auto [low, high] = std::minmax({corner_[0][k], corner_[1][k], corner_[2][k]});
            pad_[k] = 0x1p-22 * (high - low);
        }
    }

    /// The boxes of what is at or below `plane` along `axis`, and at or above it, of the part of
    /// the triangle in `box`; an empty one if there is nothing.
    std::pair<Aabb<float>, Aabb<float>> parts(const Aabb<float>& box, int axis, float plane) const {
        const double at = static_cast<double>(plane);
        Aabb<double> below, above;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3<double>& a = corner_[i];
            const Vec3<double>& b = corner_[i == 2 ? 0 : i + 1];
            if (a[axis] <= at)
                below.extend(a);
            if (a[axis] >= at)
                above.extend(a);
            if ((a[axis] < at && b[axis] > at) || (a[axis] > at && b[axis] < at)) {
                Vec3<double> cross = a + ((at - a[axis]) / (b[axis] - a[axis])) * (b - a);
                cross[axis] = at;
                below.extend(cross);
                above.extend(cross);
            }
        }
        return {within(below, box), within(above, box)};
    }

  private:
    Aabb<float> within(const Aabb<double>& part, const Aabb<float>& box) const {
        Aabb<float> cut;
        if (part.is_empty())
            return cut;
        for (int k = 0; k < 3; ++k) {
            cut.min[k] = std::max(box.min[k], round_down(part.min[k] - pad_[k]));
            cut.max[k] = std::min(box.max[k], round_up(part.max[k] + pad_[k]));
        }
        return cut.is_empty() ? Aabb<float>{} : cut;
    }

    std::array<Vec3<double>, 3> corner_;
    Vec3<double> pad_;
};

} // namespace boxwood::detail
