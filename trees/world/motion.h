#pragma once

#include "kernels/primitives/aabb.h"
#include "trees/world/pose.h"

#include <cstdint>

namespace boxwood {

/// How a body goes from one pose to another while t goes from 0 to 1. linear: its origin on a
/// straight line, while it turns about it at a constant rate by the smaller angle. screw: it turns
/// about one axis of space and slides along it, both at constant rates.
enum class MotionPath : std::uint8_t { linear, screw };

class Motion {
  public:
    /// Throws as checked_pose.
    Motion(const Pose& from, const Pose& to, MotionPath kind = MotionPath::linear);
    /// A body that stays.
    explicit Motion(const Pose& pose = {}) : Motion(pose, pose) {}

    /// Rounded: off by less than 2^-46 of the greatest coordinate of the two poses.
    Pose at(double t) const;
    /// The longest way that a point of a box of the body goes, rounded up: also the greatest speed
    /// per unit of t, as all rates are constant.
    double longest_way(const Aabb<float>& box) const;
    /// What of a way is the same for all points, at a constant rate; and the longest that a point
    /// of the box goes besides, rounded up.
    Vec3<double> common_way() const { return angle_ > 0 ? way_ : way_ + across_; }
    double longest_turn(const Aabb<float>& box) const;
    /// The greatest acceleration of a point of a box, per square of t, rounded up: in a time h no
    /// point is farther than h^2 / 8 of it from where it would be if it went straight.
    double longest_bend(const Aabb<float>& box) const;

  private:
    struct Turn {
        double fastest = 0, rounding = 0;
    };
    Turn turn_of(const Aabb<float>& box) const;

    Pose from_;
    Vec3<double> axis_{0, 0, 1};
    Vec3<double> way_{};    ///< of the origin, or of a screw along its axis
    Vec3<double> across_{}; ///< of a screw: the rest of the origin's way
    double angle_ = 0;
    bool is_screw_ = false;
};

/// The greatest speed, per unit of t, at which a point of one box and a point of the other change
/// how they lie to each other, rounded up: of bodies that go together less than what each goes.
double relative_speed(const Motion& a, const Aabb<float>& box_a, const Motion& b,
                      const Aabb<float>& box_b);

} // namespace boxwood
