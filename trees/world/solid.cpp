#include "trees/world/solid.h"

#include "kernels/convex/support.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace boxwood {

Solid::Solid(TriangleMesh mesh, const MeshTreeOptions& options)
    : surface_(mesh, options), sides_(std::move(mesh)) {
    if (const std::size_t open = sides_.open_edges())
        throw std::invalid_argument("the mesh is no solid: " + std::to_string(open) +
                                    " of its edges belong to an odd number of triangles");
    parts_ = detail::MeshParts(surface_.mesh());
}

std::optional<bool> Solid::holds(const Vec3<double>& point, double error) const {
    if (surface_.empty())
        return false;
    const Aabb<float>& box = surface_.bounds();
    for (int axis = 0; axis < 3; ++axis)
        if (point[axis] < double{box.min[axis]} || point[axis] > double{box.max[axis]})
            return false;
    // Where the surface is farther from p than p from the place itself, both are on one side.
    const Vec3<float> p(point);
    const double off = 2 * length(point - Vec3<double>(p)) + error + 0x1p-46 * length(point);
    const auto nearest = sides_.closest_point(p);
    if (nearest && std::sqrt(nearest->squared_distance) > off)
        return sides_.side(p) == Side::inside;
    return std::nullopt;
}

bool Solid::holds(const TriangleMesh& other, std::span<const std::uint32_t> vertices,
                  const Pose& other_in_this) const {
    const Vec3<double>& t = other_in_this.translation;
    const double error = 0x1p-46 * (std::abs(t.x) + std::abs(t.y) + std::abs(t.z));
    for (const std::uint32_t vertex : vertices)
        if (const auto inside = holds(other_in_this(Vec3<double>(other.vertices[vertex])), error))
            return *inside;
    return !surface_.empty();
}

/// As it does not meet the surface, it is where any of its points is.
Answer Solid::holds(const convex::Shape& shape, const Pose& shape_in_this) const {
    const Vec3<double>& t = shape_in_this.translation;
    return shape.visit([&]<class S>(const S& s) {
        if constexpr (convex::BoundedShape<S>) {
            constexpr Vec3<double> ways[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            for (const Vec3<double>& way : ways) {
                const Vec3<double> at = convex::support(s, way);
                const double error = 0x1p-44 * (std::abs(t.x) + std::abs(t.y) + std::abs(t.z) +
                                                std::abs(at.x) + std::abs(at.y) + std::abs(at.z));
                if (const auto inside = holds(shape_in_this(at), error))
                    return *inside ? Answer::yes : Answer::no;
            }
            return Answer::maybe;
        } else {
            return Answer::no; // it has no end, and this has
        }
    });
}

bool collide(const Solid& a, const Solid& b, const Pose& b_in_a, Work* work) {
    if (collide(a.surface(), b.surface(), b_in_a, work))
        return true;
    for (std::size_t part = 0; part < b.parts(); ++part)
        if (a.holds(b, part, b_in_a))
            return true;
    const Pose a_in_b = relative_pose(b_in_a, Pose{});
    for (std::size_t part = 0; part < a.parts(); ++part)
        if (b.holds(a, part, a_in_b))
            return true;
    return false;
}

Decision collide(const Solid& solid, const convex::Shape& shape, const Pose& shape_in_solid,
                 Work* work) {
    const Decision touch = collide(solid.surface(), shape, shape_in_solid, work);
    return touch.answer != Answer::no ? touch : Decision{solid.holds(shape, shape_in_solid), 0};
}

} // namespace boxwood
