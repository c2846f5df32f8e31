#pragma once

#include "kernels/primitives/triangle.h"
#include "trees/world/allowed_pairs.h"
#include "trees/world/bodies/world.h"
#include "trees/world/robot.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace boxwood {

struct RobotBodiesOptions {
    std::string prefix{}; ///< of the bodies' names, where a world has several robots
    /// Of each body; groups and masks keep questions to the robot and its surroundings, say.
    std::uint32_t group = 1, mask = ~std::uint32_t{0};
    double margin = 0;
    bool are_solid = false; ///< closed meshes are solids
};

/// A robot among the other bodies of a World, which answers what it touches and how near it is to
/// what. Each geometry of a link is a body: the first is called as its link, the others LINK#2,
/// LINK#3 and so on. A mesh is its surface, or on request a solid; boxes, balls, cylinders and
/// capsules are solid. Bodies of one link may meet, and those of two links that `allowed` names.
/// Links that name one mesh in one scale share its tree. The world and the robot must outlive it;
/// the bodies stay in the world.
class RobotBodies {
  public:
    /// Puts the bodies into the world, the robot at rest. meshes: those that the links name.
    /// Throws std::invalid_argument, naming the link, for a mesh that is not there, unless
    /// `allowed` has one item per link, and for names that the world has; then nothing is in the
    /// world.
    RobotBodies(World& world, const Robot& robot, std::span<const TriangleMesh> meshes,
                const AllowedPairs& allowed, const RobotBodiesOptions& options = {});

    /// Moves all bodies: values and root as Robot::poses has them, which says what is refused.
    void place(std::span<const double> values, const RigidTransform<double>& root = {});

    std::span<const std::uint32_t> bodies() const { return bodies_; } ///< by link, then geometry
    /// The link that a body of the world is of, if it is one of these.
    std::optional<std::uint32_t> link_of(std::uint32_t body) const;

  private:
    void insert(std::span<const TriangleMesh> meshes, const RobotBodiesOptions& options);
    void allow(const AllowedPairs& allowed);

    World* world_;
    const Robot* robot_;
    std::vector<std::uint32_t> bodies_, links_; ///< and of which link each is
    std::vector<Pose> origins_;                 ///< of each body in its link
    std::unordered_map<std::uint32_t, std::uint32_t> link_of_;
    std::vector<RigidTransform<double>> link_poses_;
    std::vector<Pose> poses_;
};

} // namespace boxwood
