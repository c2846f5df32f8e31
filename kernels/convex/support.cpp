#include "kernels/convex/detail/relative_pose.h"

namespace boxwood::convex {
namespace {

using namespace detail;

template <BoundedShape S> Extent along(const S& s, const Pose& pose, Vec3<double> d) {
    const Vec3<double> local = transposed_times(pose.rotation, d);
    const double middle = dot(d, pose.translation), size = length(d);
    // Roundings: 4u of d and the matrix, then support, product and sum; the matrix may stretch.
    const double radius = radius_of(s) * size;
    const double error =
        32 * u * norm1(d) * (norm1(pose.translation) + 2 * reach(core(s)) + radius_of(s));
    const double low = dot(local, support(core(s), -local));
    const double high = dot(local, support(core(s), local));
    return {(middle + low) - (radius + error), (middle + high) + (radius + error)};
}

} // namespace

Extent extent_along(const Shape& shape, const Pose& pose, Vec3<double> d) {
    return shape.visit([&]<class S>(const S& s) -> Extent {
        if constexpr (BoundedShape<S>)
            return along(s, pose, d);
        else
            return {-inf, inf};
    });
}

Aabb<double> bounds(const Shape& shape, const Pose& pose) {
    return shape.visit([&]<class S>(const S& s) -> Aabb<double> {
        Aabb<double> box{{-inf, -inf, -inf}, {inf, inf, inf}};
        if constexpr (BoundedShape<S>)
            for (int k = 0; k < 3; ++k) {
                Vec3<double> d{};
                d[k] = 1;
                const Extent e = along(s, pose, d);
                box.min[k] = e.least, box.max[k] = e.greatest;
            }
        return box;
    });
}

} // namespace boxwood::convex
