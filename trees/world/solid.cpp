#include "trees/world/solid.h"

#include "kernels/convex/support.h"
#include "trees/detail/places.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

/// Which vertices hang together: sets that are joined.
class Joined {
  public:
    explicit Joined(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t top_of(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t i, std::uint32_t j) { parent_[top_of(i)] = top_of(j); }

  private:
    std::vector<std::uint32_t> parent_;
};

} // namespace

Solid::Solid(TriangleMesh mesh, const MeshTreeOptions& options)
    : surface_(mesh, options), sides_(std::move(mesh)) {
    if (const std::size_t open = sides_.open_edges())
        throw std::invalid_argument("the mesh is no solid: " + std::to_string(open) +
                                    " of its edges belong to an odd number of triangles");
    const TriangleMesh& held = surface_.mesh();
    const std::vector<std::uint32_t> first = detail::places_of(held.vertices);
    Joined joined(held.vertices.size());
    for (const auto& [a, b, c] : held.triangles) {
        joined.join(first[a], first[b]);
        joined.join(first[a], first[c]);
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> parts;
    for (const auto& triangle : held.triangles)
        for (const std::uint32_t vertex : triangle)
            parts[joined.top_of(first[vertex])].push_back(first[vertex]);
    begin_.push_back(0);
    for (auto& [top, vertices] : parts) {
        std::ranges::sort(vertices);
        const auto repeated = std::ranges::unique(vertices);
        vertices_.insert(vertices_.end(), vertices.begin(), repeated.begin());
        begin_.push_back(vertices_.size());
    }
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

bool Solid::holds(const Solid& other, std::size_t part, const Pose& other_in_this) const {
    const Vec3<double>& t = other_in_this.translation;
    const double error = 0x1p-46 * (std::abs(t.x) + std::abs(t.y) + std::abs(t.z));
    for (const std::uint32_t vertex : other.vertices_of(part))
        if (const auto inside =
                holds(other_in_this(Vec3<double>(other.surface_.mesh().vertices[vertex])), error))
            return *inside;
    return !surface_.empty();
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
    if (touch.answer != Answer::no)
        return touch;
    // The shape does not meet the surface: it is where any of its points is.
    const Vec3<double>& t = shape_in_solid.translation;
    return shape.visit([&]<class S>(const S& s) -> Decision {
        if constexpr (convex::BoundedShape<S>) {
            constexpr Vec3<double> ways[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            for (const Vec3<double>& way : ways) {
                const Vec3<double> at = convex::support(s, way);
                const double error = 0x1p-44 * (std::abs(t.x) + std::abs(t.y) + std::abs(t.z) +
                                                std::abs(at.x) + std::abs(at.y) + std::abs(at.z));
                if (const auto inside = solid.holds(shape_in_solid(at), error))
                    return {*inside ? Answer::yes : Answer::no, 0};
            }
            return {Answer::maybe, 0};
        } else {
            return touch; // it has no end, and the solid has
        }
    });
}

} // namespace boxwood
