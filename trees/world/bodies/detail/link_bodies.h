#pragma once

#include "trees/world/bodies/body_shape.h"
#include "trees/world/robot.h"

#include <map>
#include <span>
#include <tuple>

namespace boxwood::detail {

/// What the geometries of a robot's links are made of. Those that name one mesh in one scale share
/// its tree.
class LinkBodies {
  public:
    /// are_solid: closed meshes are. The meshes must outlive it.
    LinkBodies(std::span<const TriangleMesh> meshes, bool are_solid)
        : meshes_(meshes), are_solid_(are_solid) {}

    /// Throws std::invalid_argument, naming the link, for a mesh that is not there; and as
    /// BodyShape::surface.
    BodyShape make(const LinkDescription& link, const LinkShape& shape);

  private:
    std::span<const TriangleMesh> meshes_;
    bool are_solid_;
    std::map<std::tuple<std::uint32_t, double, double, double>, BodyShape> made_;
};

} // namespace boxwood::detail
