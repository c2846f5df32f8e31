#pragma once

#include "kernels/convex/shapes.h"
#include "trees/world/detail/mesh_parts.h"
#include "trees/world/mesh_tree.h"
#include "trees/world/pose.h"
#include "trees/world/solid.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boxwood {

enum class ShapeClass : std::uint8_t {
    surface, ///< the triangles of a mesh, or points: what lies inside is apart
    solid,   ///< a closed mesh and what is inside by the even-odd rule
    convex   ///< a convex shape and what is inside
};

/// What a body is made of, in a frame of its own. Copies share what they hold; so do bodies made of
/// copies. The tree of a mesh is built when a pair first needs it, by whichever thread comes first.
/// Threads: any number of them may use one shape and its copies at the same time.
class BodyShape {
  public:
    /// A convex shape; the points of a hull are copied. Throws std::invalid_argument for a size
    /// that is negative, NaN or beyond 2^60, a hull of no points and a normal of length 0.
    BodyShape(const convex::Shape& shape); // NOLINT: implicit by design
    template <convex::ConvexShape S>
    BodyShape(const S& shape) : BodyShape(convex::Shape(shape)) {} // NOLINT
    static BodyShape hull(std::vector<Vec3<double>> points);

    /// Throws as MeshTree, at once; without_bad_triangles (mesh_triage.h) takes out what it
    /// refuses. The tree is built on the thread that needs it: options.executor is not used.
    static BodyShape surface(TriangleMesh mesh, const MeshTreeOptions& options = {});
    /// One whose tree is there; not null.
    static BodyShape surface(std::shared_ptr<const MeshTree> tree);
    /// Throws as Solid, at once.
    static BodyShape solid(TriangleMesh mesh, const MeshTreeOptions& options = {});
    /// As `solid` where the mesh is closed, else as `surface`.
    static BodyShape solid_if_closed(TriangleMesh mesh, const MeshTreeOptions& options = {});

    /// Balls of one radius about points, each of which is a part of its own: answers name it by its
    /// index. They are met as a surface is. Throws std::invalid_argument for a radius that is
    /// negative, NaN or beyond 2^60, and InvalidBox for a point as MeshTree.
    static BodyShape points(std::span<const Vec3<float>> points, double radius);
    /// The surface over a grid of rows x columns corners: that of row j and column i is at
    /// (i step_x, j step_y, heights[j columns + i]). Between four of them are the triangles 2 q and
    /// 2 q + 1, q = j (columns - 1) + i. Throws std::invalid_argument for fewer than 2 columns or
    /// rows, or heights that are not columns x rows; and as `surface`.
    static BodyShape height_field(std::size_t columns, std::span<const float> heights, float step_x,
                                  float step_y);

    ShapeClass shape_class() const;
    /// A box around it without its radius, in its frame; of no triangle the empty one. Half-spaces
    /// and planes have infinite sides.
    const Aabb<double>& bounds() const;
    bool empty() const { return bounds().is_empty(); } ///< a mesh of no triangles, or no points
    bool is_bounded() const;
    /// It is all that is at most so far from what is held: 0 but of points.
    double radius() const;
    /// A box around it and its radius in a pose, padded by the rounding of questions about it.
    Aabb<double> bounds_at(const Pose& pose) const;

    /// What is held. Of another class: undefined.
    const convex::Shape& convex_shape() const;
    const MeshTree& tree() const; ///< of a surface or solid; built if it was not
    const Solid& solid() const;
    const detail::MeshParts& parts() const; ///< of a surface
    /// Whether the tree is there; true of a convex shape.
    bool is_built() const;
    /// Builds what a pair would; returns whether that was still to do.
    bool build() const;

    /// Whether both share what they hold.
    bool operator==(const BodyShape& other) const { return held_ == other.held_; }

  private:
    struct Held;
    explicit BodyShape(std::shared_ptr<const Held> held) : held_(std::move(held)) {}
    static BodyShape of_mesh(ShapeClass kind, TriangleMesh mesh, const MeshTreeOptions& options,
                             double radius);

    std::shared_ptr<const Held> held_;
};

} // namespace boxwood
