#pragma once

#include "bench/commands/queries/bodies.h"
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
inline constexpr const char* obstacle_form =
    "what stands around the robot, in the frame of its root: [NAME=]BODY[@x,y,z] or "
    "[NAME=]BODY[@16 numbers], a 4 x 4 matrix row by row; a box is solid; may be repeated";

/// An obstacle as it was written.
struct Obstacle {
    std::string name; ///< all of the text, where it has no NAME
    std::string body; ///< body_forms
    Pose pose{};
};
/// Throws BadInput. A file that is called as the text, or as what is behind the NAME, is one.
Obstacle read_obstacle(const std::string& text);

/// What --allow and --obstacle say.
struct AllowedByUser {
    /// Takes the pairs of links into the robot's. Throws BadInput for a name of nothing.
    AllowedByUser(std::span<const std::string> allow, std::span<const std::string> obstacles,
                  RobotCase& robot);

    std::vector<Obstacle> obstacles;
    std::vector<Pair> with_obstacles; ///< of link, of obstacle
};

/// What stands around a robot.
class Surroundings {
  public:
    /// Both must outlive it. Throws as read_body.
    Surroundings(const RobotCase& robot, const AllowedByUser& allowed, const RobotFiles& files,
                 QueryTimes& times);
    Surroundings(const Surroundings&) = delete;
    Surroundings& operator=(const Surroundings&) = delete;

    struct Meeting {
        std::uint32_t link = 0;
        std::string_view obstacle; ///< its name
    };
    struct Answer {
        /// Which links touch which obstacles; a pair once, whatever the link is made of.
        std::vector<Meeting> hits;
        /// The nearest of them; none if none may meet.
        std::optional<std::pair<Meeting, BodyDistance>> nearest;
    };
    /// With the robot in a state.
    Answer answer(std::span<const double> values);

  private:
    Meeting meeting(Pair bodies) const;

    World world_;
    RobotBodies links_;
    std::map<std::uint32_t, std::string_view> names_; ///< of the obstacles
};

} // namespace boxwood::bench
