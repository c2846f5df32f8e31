#include "trees/world/bodies/detail/swept_box.h"

#include "kernels/arithmetic/rounding.h"
#include "trees/world/pose.h"

namespace boxwood::detail {
namespace {

Aabb<double> wider(Aabb<double> box, double by) {
    box.min = box.min - Vec3<double>{by, by, by};
    box.max = box.max + Vec3<double>{by, by, by};
    return box;
}

/// The boxes at nine times, wider by what a point goes from one of them to the middle between two.
Aabb<double> sampled(const BodyShape& shape, const Motion& motion) {
    constexpr int steps = 8;
    Aabb<double> box;
    for (int i = 0; i <= steps; ++i)
        box.extend(shape.bounds_at(motion.at(static_cast<double>(i) / steps)));
    const double longest_way = motion.longest_way(round_outward(shape.bounds()));
    return wider(box, longest_way / (2 * steps) * (1 + 0x1p-40));
}

} // namespace

convex::Motion convex_motion(const MovingShape& of) {
    if (of.from.rotation == of.to.rotation) // and not by a rounding
        return {of.from, of.to.translation - of.from.translation, {}, of.from.translation};
    // As Motion has them: near half a turn a rounding decides which way it goes.
    const Pose from = checked_pose(of.from), to = checked_pose(of.to);
    return of.path == MotionPath::screw ? convex::screw_motion(from, to)
                                        : convex::linear_motion(from, to);
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
    return wider(sampled(shape, motion), by);
}

} // namespace boxwood::detail
