/// By what a and b are: two meshes, a mesh and a convex shape, or two convex shapes. A mesh comes
/// first, and in its frame questions about it are answered.

#include "trees/world/bodies/detail/surface_pairs.h"

#include "kernels/convex/signed_distance.h"
#include "trees/world/detail/nearest_candidates.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace boxwood::detail {
namespace {

Answer answer_of(const MeshWithin& found, double most) {
    if (!found.within)
        return Answer::no;
    return found.hi <= most ? Answer::yes : Answer::maybe;
}

constexpr std::uint32_t none = ~0u;

/// In the frame of a's mesh.
BodyDistance posed(const MeshDistance& d, const Pose& pose) {
    return {{}, d.distance, d.lo, d.hi, pose(d.point_a), pose(d.point_b), d.triangles};
}

BodyDistance swapped(BodyDistance d) {
    std::swap(d.point_a, d.point_b);
    std::swap(d.parts.a, d.parts.b);
    return d;
}

BodyDistance of_convex(const convex::SignedDistance& d) {
    return {{},
            std::max(0.0, d.distance),
            std::max(0.0, d.lo),
            std::max(0.0, d.hi),
            d.point_a,
            d.point_b,
            {none, none}};
}

/// Any point of the shape, in its frame.
Vec3<double> point_of(const convex::Shape& shape) {
    if (const auto* hull = shape.get_if<convex::Hull>())
        return hull->points().front();
    if (const auto* triangle = shape.get_if<convex::Triangle>())
        return triangle->a;
    return {};
}

Inside inside_solid(const PosedShape& outer, const PosedShape& inner) {
    const Solid& solid = outer.shape.solid();
    const Pose inner_in_outer = relative_pose(outer.pose, inner.pose);
    if (is_convex(inner)) {
        const convex::Shape& shape = inner.shape.convex_shape();
        return {solid.holds(shape, inner_in_outer), inner.pose(point_of(shape))};
    }
    const TriangleMesh& mesh = inner.shape.tree().mesh();
    const bool is_solid = inner.shape.shape_class() == ShapeClass::solid;
    const std::size_t parts = is_solid ? inner.shape.solid().parts() : inner.shape.parts().size();
    for (std::size_t part = 0; part < parts; ++part) {
        const auto vertices = is_solid ? inner.shape.solid().vertices_of(part)
                                       : inner.shape.parts().vertices_of(part);
        if (solid.holds(mesh, vertices, inner_in_outer))
            return {Answer::yes, inner.pose(Vec3<double>(mesh.vertices[vertices.front()]))};
    }
    return {};
}

} // namespace

Answer surfaces_within(const PosedShape& a, const PosedShape& b, double most, Work* work) {
    if (a.shape.empty() || b.shape.empty())
        return Answer::no;
    if (is_convex(a) && is_convex(b))
        return convex::within(a.shape.convex_shape(), a.pose, b.shape.convex_shape(), b.pose, most)
            .answer;
    if (is_convex(a))
        return surfaces_within(b, a, most, work);
    const MeshTree& mesh = a.shape.tree();
    const Pose b_in_a = relative_pose(a.pose, b.pose);
    if (is_convex(b)) {
        const convex::Shape& shape = b.shape.convex_shape();
        return most > 0 ? answer_of(within(mesh, shape, b_in_a, most, work), most)
                        : collide(mesh, shape, b_in_a, work).answer;
    }
    const MeshTree& other = b.shape.tree();
    if (most > 0)
        return answer_of(within(mesh, other, b_in_a, most, work), most);
    return collide(mesh, other, b_in_a, work) ? Answer::yes : Answer::no;
}

BodyDistance surface_distance(const PosedShape& a, const PosedShape& b,
                              const DistanceOptions& options, Work* work) {
    if (a.shape.empty() || b.shape.empty())
        return {};
    if (is_convex(a) && is_convex(b)) {
        const DistanceOptions o = goal_of(options).options;
        return of_convex(convex::signed_distance(
            a.shape.convex_shape(), a.pose, b.shape.convex_shape(), b.pose,
            {std::max(convex::Tolerance{}.relative, o.relative), o.absolute}));
    }
    DistanceOptions of_mesh = options;
    if (is_convex(a)) {
        if (options.start)
            of_mesh.start = Pair{options.start->b, options.start->a};
        return swapped(surface_distance(b, a, of_mesh, work));
    }
    if (options.start && (options.start->a == none || (!is_convex(b) && options.start->b == none)))
        of_mesh.start.reset();
    const MeshTree& mesh = a.shape.tree();
    const Pose b_in_a = relative_pose(a.pose, b.pose);
    if (!is_convex(b))
        return posed(distance(mesh, b.shape.tree(), b_in_a, of_mesh, work), a.pose);
    if (of_mesh.start)
        of_mesh.start->b = 0;
    BodyDistance found =
        posed(distance(mesh, b.shape.convex_shape(), b_in_a, of_mesh, work), a.pose);
    found.parts.b = none;
    return found;
}

Inside inside(const PosedShape& a, const PosedShape& b) {
    Inside found;
    if (a.shape.empty() || b.shape.empty())
        return found;
    const bool of_a = a.shape.shape_class() == ShapeClass::solid,
               of_b = b.shape.shape_class() == ShapeClass::solid;
    if ((!of_a && !of_b) || !overlaps(a.shape.bounds_at(a.pose), b.shape.bounds_at(b.pose)))
        return found;
    if (of_a && b.shape.is_bounded())
        found = inside_solid(a, b);
    if (found.answer == Answer::no && of_b && a.shape.is_bounded())
        found = inside_solid(b, a);
    return found;
}

} // namespace boxwood::detail
