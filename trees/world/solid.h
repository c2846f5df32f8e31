#pragma once

#include "kernels/convex/shapes.h"
#include "kernels/decision.h"
#include "trees/mesh_bvh.h"
#include "trees/world/mesh_pairs.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace boxwood {

/// A closed mesh as a solid: its surface and what is inside by the even-odd rule. Throws
/// std::invalid_argument where the mesh is not closed, saying how many of its edges are open, and
/// as MeshTree.
class Solid {
  public:
    explicit Solid(TriangleMesh mesh, const MeshTreeOptions& options = {});

    const MeshTree& surface() const { return surface_; }
    /// How many parts of the surface hang together.
    std::size_t parts() const { return begin_.size() - 1; }
    /// The vertices of a part.
    std::span<const std::uint32_t> vertices_of(std::size_t part) const {
        return std::span(vertices_).subspan(begin_[part], begin_[part + 1] - begin_[part]);
    }

    /// Whether a point, which may be off by `error`, lies inside; nothing where the surface is too
    /// near to tell in floats.
    std::optional<bool> holds(const Vec3<double>& point, double error = 0) const;
    /// Whether a part of another solid, whose surface does not touch this one's, lies inside. Where
    /// all its vertices are within the rounding of floats of this surface, the answer is yes.
    bool holds(const Solid& other, std::size_t part, const Pose& other_in_this) const;

  private:
    MeshTree surface_;
    MeshBvh sides_;
    std::vector<std::uint32_t> vertices_; ///< by part
    std::vector<std::size_t> begin_;
};

/// Whether two solids share a point: their surfaces touch, or a part of one lies in the other.
bool collide(const Solid& a, const Solid& b, const Pose& b_in_a, Work* work = nullptr);

/// The same of a solid and a convex shape, as mesh_shape.h says of its surface.
Decision collide(const Solid& solid, const convex::Shape& shape, const Pose& shape_in_solid,
                 Work* work = nullptr);

} // namespace boxwood
