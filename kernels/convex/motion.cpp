#include "kernels/convex/motion.h"

#include "kernels/convex/detail/relative_pose.h"

namespace boxwood::convex {
namespace {

using namespace detail;
using V = Vec3<double>;

/// Axis times angle of the rotation that turns the first into the second.
V turn_between(const Rows& from, const Rows& to) {
    const Rows m = product(to, {{{from[0].x, from[1].x, from[2].x},
                                 {from[0].y, from[1].y, from[2].y},
                                 {from[0].z, from[1].z, from[2].z}}});
    const V twice_sine{m[2].y - m[1].z, m[0].z - m[2].x, m[1].x - m[0].y};
    const double s = length(twice_sine) / 2, c = (m[0].x + m[1].y + m[2].z - 1) / 2;
    const double angle = std::atan2(s, c);
    if (s > 0x1p-26)
        return twice_sine * (angle / (2 * s));
    if (c > 0)
        return twice_sine * 0.5;
    // Near half a turn m is about 2 aa' - 1.
    int k = m[0].x >= m[1].y ? 0 : 1;
    if (m[2].z > m[static_cast<std::size_t>(k)][k])
        k = 2;
    V axis = m[static_cast<std::size_t>(k)];
    axis[k] += 1;
    const double size = length(axis);
    return size > 0 ? axis * (angle / size) : V{};
}

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
    return {from, to.translation - from.translation, turn_between(from.rotation, to.rotation),
            from.translation};
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
