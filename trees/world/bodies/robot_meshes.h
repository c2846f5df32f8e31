#pragma once

#include "kernels/convex/shapes.h"
#include "trees/world/bodies/body_shape.h"
#include "trees/world/mesh_tree.h"
#include "trees/world/pose.h"
#include "trees/world/robot_collision.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace boxwood {

/// The solid that the shape of a link is; a mesh is none.
std::optional<convex::Shape> solid_of(const LinkShape& shape);

struct RobotMeshesOptions {
    bool are_solid = false; ///< closed meshes are solids: what lies inside touches
};

/// The narrow phase of a robot. The mesh of a link is its surface, or on request a solid; boxes,
/// spheres, cylinders and capsules are solid, in doubles: what lies in one touches it. Of two
/// meshes it is exact whether they touch and certified how far they are apart (mesh_pairs.h); of
/// all else certified (mesh_shape.h, kernels/convex/), and what is within rounding touches. Links
/// that name one mesh in one scale share its tree. Immutable; any number of threads may ask it at
/// once.
class RobotMeshes final : public LinkNarrowPhase {
  public:
    /// meshes: those that the links name. Throws std::invalid_argument, naming the link, for a mesh
    /// that is not there; and as MeshTree.
    RobotMeshes(const Robot& robot, std::span<const TriangleMesh> meshes,
                const RobotMeshesOptions& options = {});

    bool collide(std::uint32_t a, std::uint32_t b,
                 std::span<const RigidTransform<double>> poses) const override;
    LinkDistance distance(std::uint32_t a, std::uint32_t b,
                          std::span<const RigidTransform<double>> poses,
                          double limit) const override;

  private:
    struct Part {
        const MeshTree* mesh; ///< that of `body`; none: `shape`
        convex::Shape shape;
        BodyShape body;
        Pose origin;         ///< in the link
        bool turns_or_moves; ///< whether the origin does; most do not
    };
    /// A part where its link is.
    struct Placed {
        const Part& part;
        Pose pose;
    };
    static Placed placed(const Part& part, const Pose& link);
    static bool has_solid(const Placed& a, const Placed& b);
    static bool touch(const Placed& a, const Placed& b);
    static LinkDistance distance_of(const Placed& a, const Placed& b, double limit);
    template <class F>
    void for_each_pair(std::uint32_t a, std::uint32_t b,
                       std::span<const RigidTransform<double>> poses, const F& f) const;

    std::vector<std::vector<Part>> parts_; ///< by link
};

} // namespace boxwood
