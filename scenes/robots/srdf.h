#pragma once

#include "kernels/kinematics/robot_description.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boxwood {

/// What an SRDF file says of a robot beside its URDF file.
struct Srdf {
    /// Pairs of links whose collision is disabled, each once, sorted. A reason other than Adjacent,
    /// Never, Always, Default, Sampled and User becomes the note of `user`.
    std::vector<AllowedPair> allowed;
    /// Values of joints (by index) by name, such as "ready".
    struct State {
        std::string name, group;
        std::vector<std::pair<std::uint32_t, double>> values;
    };
    std::vector<State> states;
};

/// Reads by tinyxml2: disable_collisions, disable_default_collisions, enable_collisions (MoveIt's
/// order of them), group_state. Throws std::runtime_error, "file:line: ...", for a file that is
/// missing or malformed or a URDF file, and for links and joints that the robot does not have.
Srdf read_srdf(const std::filesystem::path& file, const RobotDescription& robot);
Srdf parse_srdf(std::string_view text, const std::string& source, const RobotDescription& robot);

/// An SRDF file with these pairs, a note behind its reason: reason="Sampled: in none of ...".
/// What reads it again gets the same pairs. All else is kept of `original`, the text of an SRDF
/// file, if there is one. Throws as parse_srdf for an original that is none.
std::string srdf_text(const RobotDescription& robot, std::span<const AllowedPair> pairs,
                      std::string_view original = {});

} // namespace boxwood
