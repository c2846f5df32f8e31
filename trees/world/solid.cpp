#include "trees/world/solid.h"

#include "kernels/convex/signed_distance.h"
#include "kernels/convex/support.h"
#include "trees/world/detail/deepest.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

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

double Solid::depth_of(const Vec3<double>& point) const {
    return surface_.empty() ? -std::numeric_limits<double>::infinity()
                            : -sides_.signed_distance(Vec3<float>(point));
}

namespace {

using detail::CellPiece;
using detail::Deepest;
using detail::Depth;
using detail::TrianglePiece;

Depth depth_in(const Solid& solid, const Vec3<double>& point, double& error) {
    const double depth = solid.depth_of(point);
    error = length(point - Vec3<double>(Vec3<float>(point))) +
            0x1p-40 * (std::abs(depth) + length(point));
    return {depth - error, depth + error};
}

/// A shape that stands in the frame of a solid.
struct StandingShape {
    const convex::Shape& shape;
    const Pose& pose;

    convex::SignedDistance from(const Vec3<double>& point) const {
        return convex::signed_distance(convex::Sphere{0}, {Pose{}.rotation, point}, shape, pose);
    }
};

/// The triangles of a mesh that may reach into a box.
std::vector<TrianglePiece> pieces_in(const Aabb<double>& box, const TriangleMesh& mesh,
                                     const Pose& pose) {
    std::vector<TrianglePiece> pieces;
    for (const auto& triangle : mesh.triangles) {
        TrianglePiece piece;
        Aabb<double> around;
        for (std::size_t i = 0; i < 3; ++i)
            around.extend(piece.corners[i] = pose(Vec3<double>(mesh.vertices[triangle[i]])));
        if (overlaps(around, box))
            pieces.push_back(piece);
    }
    return pieces;
}

/// How deep a mesh goes into a solid. Points become those of another frame by `to`.
void look_into_solid(Deepest& deepest, const Solid& solid, const TriangleMesh& mesh,
                     const Pose& pose, const Pose& to) {
    const auto measure = [&](const TrianglePiece& piece) -> Deepest::Measured {
        double error = 0;
        const Depth depth = depth_in(solid, piece.middle(), error);
        return {depth.lo, depth.hi + piece.radius(), to(piece.middle()), error};
    };
    deepest.look(pieces_in(Aabb<double>(solid.surface().bounds()), mesh, pose), measure);
}

void look_into_shape(Deepest& deepest, const StandingShape& shape, const TriangleMesh& mesh) {
    const auto measure = [&](const TrianglePiece& piece) -> Deepest::Measured {
        const convex::SignedDistance d = shape.from(piece.middle());
        return {-d.hi, piece.radius() - d.lo, piece.middle(), d.hi - d.lo};
    };
    deepest.look(pieces_in(convex::bounds(shape.shape, shape.pose), mesh, Pose{}), measure);
}

/// How deep the surface of a shape goes into a solid, cell by cell of the space where both are. A
/// place of that surface is the nearest to the middle of a cell; what it is off is measured.
void look_at_surface(Deepest& deepest, const Solid& solid, const StandingShape& shape) {
    const Aabb<double> of_solid(solid.surface().bounds()),
        of_shape = convex::bounds(shape.shape, shape.pose);
    const Aabb<double> both{max(of_solid.min, of_shape.min), min(of_solid.max, of_shape.max)};
    if (both.is_empty())
        return;
    const auto measure = [&](const CellPiece& cell) -> Deepest::Measured {
        const Vec3<double> middle = cell.middle();
        const double radius = cell.radius();
        const convex::SignedDistance from = shape.from(middle);
        if (from.lo > radius || -from.hi > radius)
            return {0, 0, {}, 0}; // no surface
        double error = 0;
        const double hi = depth_in(solid, middle, error).hi + radius;
        const convex::SignedDistance off = shape.from(from.point_b);
        const double lo =
            depth_in(solid, from.point_b, error).lo - std::max(std::abs(off.lo), std::abs(off.hi));
        return {lo, hi, from.point_b, error + (from.hi - from.lo)};
    };
    deepest.look(std::vector{CellPiece{both}}, measure);
}

double size_of(const Aabb<double>& box) { return box.is_empty() ? 0 : length(box.max - box.min); }
double size_of(const Solid& solid) { return size_of(Aabb<double>(solid.surface().bounds())); }

void require_tolerance(double tolerance) {
    if (!(tolerance >= 0))
        throw std::invalid_argument("the tolerance of a signed distance must be at least 0");
}

SolidDistance apart_by(const MeshDistance& d) {
    return {d.distance, d.lo, d.hi, d.point_a, d.point_b};
}

/// A pose turns and rounds, by so much.
SolidDistance deep_by(const Deepest& deepest, double rounded) {
    const double lo = std::max(deepest.lo() - rounded, 0.), hi = deepest.hi() + rounded;
    return {0. - deepest.lo(), 0. - hi, 0. - lo, deepest.point(), deepest.point()};
}

} // namespace

SolidDistance signed_distance(const Solid& a, const Solid& b, const Pose& b_in_a, double tolerance,
                              Work* work) {
    require_tolerance(tolerance);
    if (!collide(a, b, b_in_a, work))
        return apart_by(distance(a.surface(), b.surface(), b_in_a, {}, work));
    if (tolerance == 0)
        tolerance = .01 * std::min(size_of(a), size_of(b));
    Deepest deepest(tolerance);
    look_into_solid(deepest, a, b.surface().mesh(), b_in_a, Pose{});
    look_into_solid(deepest, b, a.surface().mesh(), relative_pose(b_in_a, Pose{}), b_in_a);
    return deep_by(deepest, 0x1p-44 * (size_of(a) + size_of(b) + length(b_in_a.translation)));
}

SolidDistance signed_distance(const Solid& solid, const convex::Shape& shape,
                              const Pose& shape_in_solid, double tolerance, Work* work) {
    require_tolerance(tolerance);
    const Answer touch = collide(solid, shape, shape_in_solid, work).answer;
    const auto apart = [&] { return distance(solid.surface(), shape, shape_in_solid, {}, work); };
    if (touch == Answer::no)
        return apart_by(apart());
    if (tolerance == 0) // of a shape that has no size, of the solid
        for (const double size : {size_of(convex::bounds(shape, Pose{})), size_of(solid)})
            if (tolerance == 0 || .01 * size < tolerance)
                tolerance = .01 * size;
    Deepest deepest(tolerance);
    const StandingShape standing{shape, shape_in_solid};
    look_into_shape(deepest, standing, solid.surface().mesh());
    look_at_surface(deepest, solid, standing);
    SolidDistance found =
        deep_by(deepest, 0x1p-44 * (size_of(solid) + length(shape_in_solid.translation)));
    if (touch == Answer::maybe) // they may be apart, too, by what rounding leaves open
        found.hi = std::max(found.hi, apart().hi);
    return found;
}

Decision collide(const Solid& solid, const convex::Shape& shape, const Pose& shape_in_solid,
                 Work* work) {
    const Decision touch = collide(solid.surface(), shape, shape_in_solid, work);
    return touch.answer != Answer::no ? touch : Decision{solid.holds(shape, shape_in_solid), 0};
}

} // namespace boxwood
