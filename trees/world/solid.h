#pragma once

#include "kernels/convex/shapes.h"
#include "kernels/decision.h"
#include "trees/mesh_bvh.h"
#include "trees/world/detail/mesh_parts.h"
#include "trees/world/mesh_pairs.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace boxwood {

/// A closed mesh as a solid: its surface and what is inside by the even-odd rule. Throws
/// std::invalid_argument where the mesh is not closed, saying how many of its edges are open, and
/// as MeshTree.
class Solid {
  public:
    explicit Solid(TriangleMesh mesh, const MeshTreeOptions& options = {});

    const MeshTree& surface() const { return surface_; }
    /// How many parts of the surface hang together.
    std::size_t parts() const { return parts_.size(); }
    /// The vertices of a part.
    std::span<const std::uint32_t> vertices_of(std::size_t part) const {
        return parts_.vertices_of(part);
    }

    /// Whether a point lies inside, in doubles and off by at most `error` a coordinate; nothing
    /// where it is within that and the rounding of floats of the surface.
    std::optional<bool> holds(const Vec3<double>& point, double error = 0) const;
    /// How deep a point lies inside, scene units: the distance to the surface, below 0 outside;
    /// off by at most the distance of the point from its rounding to floats, and a share 2^-40.
    double depth_of(const Vec3<double>& point) const;
    /// Whether a part of another solid, whose surface does not touch this one's, lies inside. Where
    /// all its vertices are within the rounding of floats of this surface, the answer is yes.
    bool holds(const Solid& other, std::size_t part, const Pose& other_in_this) const {
        return holds(other.surface_.mesh(), other.vertices_of(part), other_in_this);
    }
    /// The same of some vertices of a mesh that hang together.
    bool holds(const TriangleMesh& other, std::span<const std::uint32_t> vertices,
               const Pose& other_in_this) const;
    /// The same of a convex shape; maybe: so near to the surface that floats do not tell.
    Answer holds(const convex::Shape& shape, const Pose& shape_in_this) const;

  private:
    MeshTree surface_;
    MeshBvh sides_;
    detail::MeshParts parts_;
};

/// Whether two solids share a point: their surfaces touch, or a part of one lies in the other.
bool collide(const Solid& a, const Solid& b, const Pose& b_in_a, Work* work = nullptr);

/// How far two solids are apart. Below 0: they share a point, and -distance is how deep they are in
/// each other, the farthest that a point of one's surface inside the other is from the other's.
/// Both are between lo and hi.
struct SolidDistance {
    double distance = std::numeric_limits<double>::infinity();
    double lo = std::numeric_limits<double>::infinity();
    double hi = std::numeric_limits<double>::infinity();
    Vec3<double> point_a{}, point_b{}; ///< where it is taken, in A's frame; deep: the same point
};

/// hi - lo is at most `tolerance` where they are deep in each other, and 2^-20 of the size of both,
/// or more after four million pieces of triangles;
/// 0: a hundredth of the smaller one's size. Where they are apart, as of their surfaces. It takes a
/// query of a point for each triangle near the other solid, and more the narrower the tolerance is.
/// Throws std::invalid_argument for a tolerance that is negative or NaN.
SolidDistance signed_distance(const Solid& a, const Solid& b, const Pose& b_in_a,
                              double tolerance = 0, Work* work = nullptr);

/// The same of a solid and a convex shape, which stands at `shape_in_solid`: the surface of a plane
/// or a half-space is its flat. hi - lo is at most `tolerance` and 2^-20 of the sizes and of how
/// far both are from the origin where they are deep in each other.
SolidDistance signed_distance(const Solid& solid, const convex::Shape& shape,
                              const Pose& shape_in_solid, double tolerance = 0,
                              Work* work = nullptr);

/// Whether a solid and a convex shape share a point, as mesh_shape.h says of its surface.
Decision collide(const Solid& solid, const convex::Shape& shape, const Pose& shape_in_solid,
                 Work* work = nullptr);

} // namespace boxwood
