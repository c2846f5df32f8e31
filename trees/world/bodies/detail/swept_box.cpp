#include "trees/world/bodies/detail/swept_box.h"

#include "kernels/arithmetic/rounding.h"

#include <algorithm>
#include <cmath>

namespace boxwood::detail {
namespace {

Aabb<double> wider(Aabb<double> box, double by) {
    box.min = box.min - Vec3<double>{by, by, by};
    box.max = box.max + Vec3<double>{by, by, by};
    return box;
}

/// The boxes at nine times, wider by what a point goes from one of them to the middle between two.
template <class PoseAt>
Aabb<double> sampled(const BodyShape& shape, const PoseAt& pose_at, double longest_way) {
    constexpr int steps = 8;
    Aabb<double> box;
    for (int i = 0; i <= steps; ++i)
        box.extend(shape.bounds_at(pose_at(static_cast<double>(i) / steps)));
    return wider(box, longest_way / (2 * steps) * (1 + 0x1p-40));
}

/// As Motion::longest_way.
double longest_way(const convex::Motion& motion, const Aabb<double>& box) {
    double fastest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3<double> p{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                             corner & 4 ? box.max.z : box.min.z};
        fastest = std::max(fastest, length(cross(motion.spin, motion.start(p) - motion.centre)));
    }
    return (length(motion.velocity) + fastest) * (1 + 0x1p-40);
}

} // namespace

convex::Motion convex_motion(const MovingShape& of) {
    if (of.from.rotation == of.to.rotation) // and not by a rounding
        return {of.from, of.to.translation - of.from.translation, {}, of.from.translation};
    return of.path == MotionPath::screw ? convex::screw_motion(of.from, of.to)
                                        : convex::linear_motion(of.from, of.to);
}

Aabb<double> swept_box(const MovingShape& of) {
    const BodyShape& shape = of.shape;
    if (shape.empty())
        return {};
    // The tolerance of first contacts by default, and some for rounding.
    const auto& [low, high] = shape.bounds();
    const double by = of.margin * (1 + 0x1p-50) + 0x1p-35 * length(high - low) +
                      0x1p-40 * (length(max(-low, high)) + length(of.from.translation) +
                                 length(of.to.translation));
    if (of.from.rotation == of.to.rotation) // all points go on straight lines
        return wider(merge(shape.bounds_at(of.from), shape.bounds_at(of.to)), by);
    const Motion motion(of.from, of.to, of.path);
    Aabb<double> box = sampled(
        shape, [&](double t) { return motion.at(t); },
        motion.longest_way(round_outward(shape.bounds())));
    if (shape.shape_class() == ShapeClass::convex) {
        const convex::Motion other = convex_motion(of);
        box.extend(sampled(
            shape, [&](double t) { return convex::pose_at(other, t); },
            longest_way(other, shape.bounds())));
    }
    return wider(box, by);
}

} // namespace boxwood::detail
