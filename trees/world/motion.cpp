#include "trees/world/motion.h"

#include <algorithm>
#include <cmath>

namespace boxwood {

Motion::Motion(const Pose& from, const Pose& to, MotionPath kind) : from_(checked_pose(from)) {
    const Pose end = checked_pose(to);
    const AxisAngle turn = turn_between(from_.rotation, end.rotation);
    axis_ = turn.axis;
    angle_ = turn.angle;
    way_ = end.translation - from_.translation;
    is_screw_ = kind == MotionPath::screw;
    if (is_screw_) {
        const double along = dot(way_, axis_);
        across_ = way_ - along * axis_;
        way_ = along * axis_;
    }
}

// With R(t) the rotation so far and c the axis' place, the origin is at c + R(t) (o - c) across the
// axis, and across = (R(1) - 1) (o - c): the way to t is (R(t) - 1) (R(1) - 1)^-1 across. Turns
// about one axis commute, and R(t) - 1 is 2 sin(t angle / 2) times a turn by t angle / 2 and a
// right angle: what is left is a ratio of sines times a turn by (t - 1) angle / 2. No place is
// needed, which would be far away for a small angle.
Pose Motion::at(double t) const {
    Pose pose;
    pose.rotation = product(rotation_about(axis_, t * angle_), from_.rotation);
    Vec3<double> shift = t * way_;
    if (is_screw_) {
        const double half = angle_ / 2;
        const double part = half > 0 ? std::sin(t * half) / std::sin(half) : t;
        shift = shift + part * times(rotation_about(axis_, (t - 1) * half), across_);
    }
    pose.translation = from_.translation + shift;
    return pose;
}

Motion::Turn Motion::turn_of(const Aabb<float>& box) const {
    if (!(angle_ > 0))
        return {};
    // The speed of the origin across the axis at the start; that of a point does not change.
    Vec3<double> start{};
    if (is_screw_) {
        const double half = angle_ / 2;
        start = half / std::sin(half) * times(rotation_about(axis_, -half), across_);
    }
    double fastest = 0, farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3<double> p{double{corner & 1 ? box.max.x : box.min.x},
                             double{corner & 2 ? box.max.y : box.min.y},
                             double{corner & 4 ? box.max.z : box.min.z}};
        const Vec3<double> turned = times(from_.rotation, p);
        fastest = std::max(fastest, length(start + angle_ * cross(axis_, turned)));
        farthest = std::max(farthest, length(turned));
    }
    // Axis times angle is off by a few units of rounding, however small the angle.
    return {fastest, 0x1p-48 * farthest};
}

double Motion::longest_turn(const Aabb<float>& box) const {
    const Turn turn = turn_of(box);
    return turn.fastest * (1 + 0x1p-40) + turn.rounding;
}

double Motion::longest_bend(const Aabb<float>& box) const {
    return angle_ * (1 + 0x1p-40) * longest_turn(box);
}

double Motion::longest_way(const Aabb<float>& box) const {
    const auto [fastest, rounding] = turn_of(box);
    const double slid = length(common_way());
    // Across and along the axis of a screw the ways are at right angles.
    const double way = is_screw_ ? std::sqrt(fastest * fastest + slid * slid) : fastest + slid;
    return way * (1 + 0x1p-40) + rounding;
}

double relative_speed(const Motion& a, const Aabb<float>& box_a, const Motion& b,
                      const Aabb<float>& box_b) {
    const double together = length(a.common_way() - b.common_way()) * (1 + 0x1p-40) +
                            0x1p-50 * (length(a.common_way()) + length(b.common_way())) +
                            a.longest_turn(box_a) + b.longest_turn(box_b);
    return std::min(together, a.longest_way(box_a) + b.longest_way(box_b));
}

} // namespace boxwood
