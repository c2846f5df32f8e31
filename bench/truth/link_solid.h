#pragma once

#include "bench/truth/posed_triangles.h"
#include "kernels/kinematics/robot_description.h"
#include "kernels/primitives/aabb.h"

#include <functional>
#include <vector>

namespace boxwood::bench {

/// A shape of a link, for judges: a mesh as its surface, all others as solids. What is round lies
/// between two polyhedra, with 32 faces around and 16 from pole to pole.
struct LinkSolid {
    PosedTriangles inner;            ///< on or in the shape, in its own frame
    PosedTriangles outer;            ///< around it; of meshes and boxes the same
    RigidTransform<double> origin{}; ///< of its frame, in the link's

    /// Of solids: 0 in the middle, 1 on the surface, more outside.
    std::function<double(Vec3<double>)> level{};
    double outer_level = 1; ///< that `outer` stays below

    /// Solids that surely or maybe contain a point of their own frame.
    bool contains(Vec3<double> p) const { return level && level(p) <= 1 - 0x1p-30; }
    bool may_contain(Vec3<double> p) const { return level && level(p) <= outer_level; }
};

LinkSolid link_solid(const LinkGeometry& geometry, const std::vector<TriangleMesh>& meshes);

/// A shape where its link is. The solid must outlive it.
struct PlacedSolid {
    PlacedSolid(const LinkSolid& of, const RigidTransform<double>& link);

    const LinkSolid* solid;
    RigidTransform<double> pose;
    PosedTriangles inner, outer;
    Aabb<double> box; ///< of both
};

/// By rational arithmetic on triangles that are posed in doubles. What is between is not known.
bool surely_touch(const PlacedSolid& a, const PlacedSolid& b);
bool may_touch(const PlacedSolid& a, const PlacedSolid& b);

} // namespace boxwood::bench
