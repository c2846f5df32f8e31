#pragma once

#include "bench/commands/queries/robot_case.h"

#include <cstdint>
#include <string>

namespace boxwood::bench {

/// What `boxwood demo four-link` prints: the idea of a box tree, step by step, on a robot of four
/// links. Every number in it is computed as it is written.
std::string four_link_demo();

/// What `boxwood demo robot` prints: the same steps on the user's own robot, from the boxes of its
/// links to which of them touch, at rest and in a random state. Throws BadInput.
struct RobotDemo {
    RobotFiles files;
    std::uint64_t seed = 1;
};
std::string robot_demo(const RobotDemo& demo, const MakeLinkNarrowPhase& make_narrow_phase);

} // namespace boxwood::bench
