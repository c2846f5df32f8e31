#include "trees/world/solid.h"

#include "kernels/convex/support.h"
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

/// How deep a solid's surface goes into another one, by branch and bound over its triangles: no
/// point of a piece is deeper than its middle by more than its radius.
class Deepest {
  public:
    void look(const Solid& into, const TriangleMesh& of, const Pose& pose, double tolerance) {
        const Aabb<double> box(into.surface().bounds());
        std::vector<Piece> pieces;
        for (const auto& triangle : of.triangles) {
            std::array<Vec3<double>, 3> corners;
            Aabb<double> around;
            for (std::size_t i = 0; i < 3; ++i)
                around.extend(corners[i] = pose(Vec3<double>(of.vertices[triangle[i]])));
            if (overlaps(around, box))
                add(pieces, into, corners);
        }
        std::ranges::make_heap(pieces, {}, &Piece::hi);
        // More pieces than that: the bounds are wide, and true.
        for (std::size_t n = 0; !pieces.empty() && n < 4'000'000; ++n) {
            if (pieces.front().hi <= lo + tolerance)
                break;
            std::ranges::pop_heap(pieces, {}, &Piece::hi);
            const auto [a, b, c] = pieces.back().corners;
            pieces.pop_back();
            const Vec3<double> ab = .5 * (a + b), bc = .5 * (b + c), ca = .5 * (c + a);
            for (const auto& corners : {std::array{a, ab, ca}, std::array{ab, b, bc},
                                        std::array{ca, bc, c}, std::array{ab, bc, ca}})
                if (add(pieces, into, corners))
                    std::ranges::push_heap(pieces, {}, &Piece::hi);
        }
        if (!pieces.empty())
            hi = std::max(hi, pieces.front().hi);
        hi = std::max(hi, lo);
    }

    double lo = 0, hi = 0; ///< of the depth
    Vec3<double> point{};  ///< in the frame of the solid that it is in

  private:
    struct Piece {
        double hi; ///< no point of it is deeper
        std::array<Vec3<double>, 3> corners;
    };

    /// False where it cannot be deeper than what is known.
    bool add(std::vector<Piece>& pieces, const Solid& into,
             const std::array<Vec3<double>, 3>& corners) {
        const Vec3<double> middle = (1. / 3) * (corners[0] + corners[1] + corners[2]);
        double radius = 0;
        for (const Vec3<double>& corner : corners)
            radius = std::max(radius, length(corner - middle));
        const double depth = into.depth_of(middle);
        const double off = length(middle - Vec3<double>(Vec3<float>(middle))) +
                           0x1p-40 * (std::abs(depth) + length(middle));
        if (depth - off > lo) {
            lo = depth - off;
            point = middle;
        }
        const double hi_of_piece = depth + off + radius * (1 + 0x1p-40);
        if (!(hi_of_piece > lo))
            return false;
        pieces.push_back({hi_of_piece, corners});
        return true;
    }
};

double size_of(const Solid& solid) {
    const Aabb<double> box(solid.surface().bounds());
    return box.is_empty() ? 0 : length(box.max - box.min);
}

} // namespace

SolidDistance signed_distance(const Solid& a, const Solid& b, const Pose& b_in_a, double tolerance,
                              Work* work) {
    if (!(tolerance >= 0))
        throw std::invalid_argument("the tolerance of a signed distance must be at least 0");
    if (!collide(a, b, b_in_a, work)) {
        const MeshDistance apart = distance(a.surface(), b.surface(), b_in_a, {}, work);
        return {apart.distance, apart.lo, apart.hi, apart.point_a, apart.point_b};
    }
    if (tolerance == 0)
        tolerance = .01 * std::min(size_of(a), size_of(b));
    const Pose a_in_b = relative_pose(b_in_a, Pose{});
    Deepest of_b, of_a;
    of_b.look(a, b.surface().mesh(), b_in_a, tolerance);
    of_a.lo = of_b.lo;
    of_a.look(b, a.surface().mesh(), a_in_b, tolerance);
    const bool is_of_a = of_a.lo > of_b.lo;
    const Vec3<double> point = is_of_a ? b_in_a(of_a.point) : of_b.point;
    // A pose turns and rounds.
    const double rounded = 0x1p-44 * (size_of(a) + size_of(b) + length(b_in_a.translation));
    const double lo = std::max(of_a.lo - rounded, 0.), hi = std::max(of_a.hi, of_b.hi) + rounded;
    return {0. - std::max(of_a.lo, 0.), 0. - hi, 0. - lo, point, point};
}

Decision collide(const Solid& solid, const convex::Shape& shape, const Pose& shape_in_solid,
                 Work* work) {
    const Decision touch = collide(solid.surface(), shape, shape_in_solid, work);
    return touch.answer != Answer::no ? touch : Decision{solid.holds(shape, shape_in_solid), 0};
}

} // namespace boxwood
