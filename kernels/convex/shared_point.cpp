#include "kernels/convex/shared_point.h"

#include "kernels/convex/detail/pairs.h"

namespace boxwood::convex {
namespace {

using namespace detail;

template <class S>
V point_on_triangle(const Triangle& a, const Pose& pose_a, const S& b, const Pose& pose_b) {
    if constexpr (is_flat<S>) {
        const OnFlat<Triangle, S> flat(a, pose_a, b, pose_b);
        if (std::is_same_v<S, Plane> && flat.low < 0 && flat.high > 0)
            return pose_a(flat.below +
                          (flat.above - flat.below) * (flat.low / (flat.low - flat.high)));
        return pose_a(flat.is_beneath() ? flat.above : flat.below);
    } else {
        const detail::Search<Triangle, S> search{a, b, pose_a, pose_b};
        if (search.is_odd())
            return pose_a(a.a);
        const auto& inner_a = core(a);
        const auto& inner_b = core(b);
        const Difference difference{inner_a, inner_b, search.b_in_a};
        const Goal goal{search.size, 0x1p-36, 8 * u * search.size, search.radius_b};
        Simplex simplex;
        return pose_a(nearest_to_origin(difference, search.start(), goal, simplex).on_a);
    }
}

} // namespace

Vec3<double> shared_point(const Triangle& a, const Pose& pose_a, const Shape& b,
                          const Pose& pose_b) {
    return b.visit([&](const auto& shape) { return point_on_triangle(a, pose_a, shape, pose_b); });
}

} // namespace boxwood::convex
