#pragma once

#include "bench/commands/queries/robot_case.h"
#include "trees/world/bodies/robot_bodies.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// How an obstacle is written, for help.
inline constexpr const char* obstacle_forms =
    "what stands around the robot, in the frame of its root: BODY or BODY@x,y,z, where it is moved "
    "by that much; a mesh file, of which the surface counts, or a solid box:x,y,z, sphere:radius, "
    "capsule:radius,length, cylinder:radius,length; may be repeated";

/// What stands around a robot.
class Surroundings {
  public:
    /// The robot must outlive it. Throws BadInput, and as load_mesh.
    Surroundings(const RobotCase& robot, const std::vector<std::string>& obstacles);
    Surroundings(const Surroundings&) = delete;
    Surroundings& operator=(const Surroundings&) = delete;

    void place(std::span<const double> values) { links_.place(values); }

    struct Meeting {
        std::uint32_t link = 0;
        std::string_view obstacle; ///< as it was written
    };
    /// Which links touch which obstacles; a pair once, whatever the link is made of.
    std::vector<Meeting> hits() const;
    /// The nearest of them; none if no link has a geometry.
    std::optional<std::pair<Meeting, BodyDistance>> nearest() const;

  private:
    Meeting meeting(Pair bodies) const;

    World world_;
    RobotBodies links_;
    std::map<std::uint32_t, std::string> names_; ///< of the obstacles
};

} // namespace boxwood::bench
