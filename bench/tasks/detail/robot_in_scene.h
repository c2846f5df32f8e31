#pragma once

#include "scenes/scene.h"
#include "trees/queries/sinks.h"
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

/// What is answered of one state: how far apart the two nearest links are that must not touch.
struct StateDistance {
    double distance = 0, lo = 0, hi = 0;
    Pair links{~0u, ~0u}; ///< the lower first
};

} // namespace boxwood::bench
