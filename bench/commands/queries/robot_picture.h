#pragma once

#include "trees/world/robot_collision.h"

#include <string>
#include <vector>

namespace boxwood::bench {

/// The least distance of a robot's links in one state of many.
struct LeastOfState {
    double time = 0; ///< in waypoints
    LinkDistance least;
    bool collides = false;
};

/// The least distance over time with its interval, as an SVG with real text; shaded where links
/// collide. states: by time, not of none.
std::string robot_picture(const std::string& robot, const std::vector<LeastOfState>& states);

} // namespace boxwood::bench
