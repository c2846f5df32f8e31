#pragma once

#include "bench/tasks/detail/robot_in_scene.h"
#include "bench/tasks/task.h"
#include "trees/world/bodies/robot_meshes.h"
#include "trees/world/robot_collision.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// Ours: the trees of a robot's links, and what they are searched by.
class RobotContender : public Contender {
  public:
    explicit RobotContender(const Job& job) : robot_(*job.scene) {}

    void build() override {
        self_.reset();
        meshes_.reset();
        meshes_.emplace(robot_.robot, robot_.meshes());
        self_.emplace(robot_.robot, robot_.boxes, robot_.allowed, *meshes_);
    }

  protected:
    RobotInScene robot_;
    std::optional<RobotMeshes> meshes_;
    std::optional<RobotSelfCollision> self_;
};

/// A task about the links of a robot in states. Keys: scene, states, n_states, peers.
class RobotTask : public Task {
  public:
    std::vector<std::string_view> keys() const override {
        return {"scene", "states", "n_states", "threads", "peers"};
    }
    SceneKind scenes() const override { return SceneKind::still; }
    void expand(const BlockReader& block, AddCell add) const override;
    ContenderEntry contender(const Choice& choice) const override;
    std::optional<std::string> missing(const Scene& scene) const override;
    std::uint64_t n_queries(const Scene& scene) const override;

  protected:
    /// What a query does after forward kinematics, for the notes.
    virtual std::string_view query_notes() const = 0;
    virtual Answering::Make make() const = 0;
};

} // namespace boxwood::bench
