#pragma once

#include "trees/world/mesh_tree.h"
#include "trees/world/pose.h"
#include "trees/world/robot_collision.h"

#include <memory>
#include <span>
#include <vector>

namespace boxwood {

/// The narrow phase of a robot whose links are meshes and boxes: exact for whether they touch,
/// certified for distances (mesh_pairs.h). A link is its surface. Links that name one mesh in one
/// scale share its tree. Immutable; any number of threads may ask it at once.
class RobotMeshes final : public LinkNarrowPhase {
  public:
    /// meshes: those that the links name. Throws std::invalid_argument, naming the link, for a mesh
    /// that is not there and for a shape that is neither a mesh nor a box; and as MeshTree.
    RobotMeshes(const Robot& robot, std::span<const TriangleMesh> meshes);

    bool collide(std::uint32_t a, std::uint32_t b,
                 std::span<const RigidTransform<double>> poses) const override;
    LinkDistance distance(std::uint32_t a, std::uint32_t b,
                          std::span<const RigidTransform<double>> poses,
                          double limit) const override;

  private:
    struct Part {
        std::shared_ptr<const MeshTree> tree;
        Pose origin; ///< in the link
    };
    template <class F>
    void for_each_pair(std::uint32_t a, std::uint32_t b,
                       std::span<const RigidTransform<double>> poses, const F& f) const;

    std::vector<std::vector<Part>> parts_; ///< by link
};

} // namespace boxwood
