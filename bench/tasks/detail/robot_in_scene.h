#pragma once

#include "scenes/scene.h"
#include "trees/world/allowed_pairs.h"
#include "trees/world/robot.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boxwood::bench {

/// The robot of a scene, and the pairs of its links that may collide: those of its SRDF file, or
/// adjacent links if it has none.
struct RobotInScene {
    Robot robot;
    LinkBoxes boxes;
    AllowedPairs allowed;

    explicit RobotInScene(const Scene& scene);

    std::span<const TriangleMesh> meshes() const { return meshes_; }
    std::span<const std::vector<double>> states() const { return states_; }

  private:
    std::span<const TriangleMesh> meshes_;
    std::span<const std::vector<double>> states_;
};

} // namespace boxwood::bench
