#pragma once

#include "scenes/robots/urdf.h"
#include "scenes/scene.h"

#include <optional>
#include <vector>

namespace boxwood {

/// The scene of a robot of the user's.
inline constexpr std::string_view robot_scene = "robot";

/// Kinds of states: at random, or along a way between such, `steps_along` from one to the next,
/// each value evenly.
inline constexpr std::string_view random_states = "random", states_along = "along";
inline constexpr std::size_t steps_along = 64;

/// A robot in states.
struct RobotStates {
    UrdfRobot robot;
    /// Of the SRDF file of the same name beside the URDF file; none if there is no such file.
    std::optional<std::vector<AllowedPair>> allowed;
    std::vector<std::vector<double>> states; ///< a value per joint that has one
};

/// Reads a URDF file, its meshes and its SRDF file, and draws n states of a kind by the seed
/// (random_values.h). Throws as read_urdf and read_srdf, and std::invalid_argument for another
/// kind.
RobotStates read_robot_states(const std::filesystem::path& urdf, std::size_t n, std::uint64_t seed,
                              std::string_view kind = random_states);

/// Around each link's geometry in the link's frame, rounded; empty without geometry.
std::vector<Aabb<float>> link_boxes(const UrdfRobot& robot);

} // namespace boxwood
