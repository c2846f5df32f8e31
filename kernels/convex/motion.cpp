#include "kernels/convex/motion.h"

#include "kernels/convex/detail/relative_pose.h"

namespace boxwood::convex {
namespace {

using namespace detail;
using V = Vec3<double>;

} // namespace

Pose pose_at(const Motion& motion, double t) {
    Pose pose = motion.start;
    const double angle = length(motion.spin);
    if (!(angle > 0)) {
        pose.translation = motion.start.translation + t * motion.velocity;
        return pose;
    }
    const Rows turn = rotation_about(motion.spin * (1 / angle), t * angle);
    pose.rotation = product(turn, motion.start.rotation);
    pose.translation = times(turn, motion.start.translation - motion.centre) +
                       (motion.centre + t * motion.velocity);
    return pose;
}

Motion linear_motion(const Pose& from, const Pose& to) {
    const AxisAngle turn = turn_between(from.rotation, to.rotation);
    return {from, to.translation - from.translation, turn.axis * turn.angle, from.translation};
}

Motion screw_motion(const Pose& from, const Pose& to) {
    Motion motion = linear_motion(from, to);
    const double angle = length(motion.spin);
    // Where the turn is less, the axis is so far away that the line is the same up to rounding.
    if (!(angle > 0x1p-26))
        return motion;
    const V axis = motion.spin * (1 / angle), along = axis * dot(axis, motion.velocity);
    const V across = motion.velocity - along;
    motion.centre =
        from.translation + (across + cross(axis, across) * (1 / std::tan(angle / 2))) * 0.5;
    motion.velocity = along;
    return motion;
}

namespace detail {

double motion_error(const Motion& m, double reach) {
    const double arm = norm1(m.start.translation - m.centre) + reach;
    const double turn = norm1(m.spin) > 0 ? (48 + 8 * norm1(m.spin)) * arm : 0;
    return u * (turn + 8 * (norm1(m.start.translation) + norm1(m.centre) + norm1(m.velocity)));
}

} // namespace detail

} // namespace boxwood::convex
