#include "bench/peers/coal/conversions.h"
#include "bench/peers/coal/module.h"
#include "bench/peers/each_case.h"

#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

namespace boxwood::bench {
namespace {

using Geometry = std::shared_ptr<coal::CollisionGeometry>;

Geometry convex_of(const Polyhedron& polyhedron) {
    auto points = std::make_shared<std::vector<coal::Vec3s>>();
    for (const Vec3<double>& p : polyhedron.points)
        points->emplace_back(p.x, p.y, p.z);
    auto faces = std::make_shared<std::vector<coal::Triangle>>();
    for (const auto& [a, b, c] : polyhedron.faces)
        faces->emplace_back(a, b, c);
    return std::make_shared<coal::Convex<coal::Triangle>>(
        points, static_cast<unsigned>(points->size()), faces, static_cast<unsigned>(faces->size()));
}

Geometry geometry_of(const ShapeOfPair& of) {
    const std::vector<double> length = lengths_of(of.shape);
    switch (of.shape.kind()) {
    case convex::ShapeKind::sphere:
        return std::make_shared<coal::Sphere>(length[0]);
    case convex::ShapeKind::box:
        return std::make_shared<coal::Box>(2 * length[0], 2 * length[1], 2 * length[2]);
    case convex::ShapeKind::capsule:
        return std::make_shared<coal::Capsule>(length[0], 2 * length[1]);
    case convex::ShapeKind::cylinder:
        return std::make_shared<coal::Cylinder>(length[0], 2 * length[1]);
    case convex::ShapeKind::cone:
        return std::make_shared<coal::Cone>(length[0], 2 * length[1]);
    case convex::ShapeKind::ellipsoid:
        return std::make_shared<coal::Ellipsoid>(length[0], length[1], length[2]);
    case convex::ShapeKind::hull:
        return convex_of(*of.polyhedron);
    default:
        throw std::invalid_argument("the families of shape pairs have no such shape");
    }
}

/// What a user keeps for many queries of two shapes; Compute refers to them.
template <class Compute> struct Kept {
    Geometry a, b;
    coal::Transform3s pose_a, pose_b;
    std::unique_ptr<Compute> compute;
    coal::CollisionResult touches;
    coal::DistanceResult nearest;
    explicit Kept(const ShapePairCase& c)
        : a(geometry_of(c.a)), b(geometry_of(c.b)), pose_a(transform_of(c.a.pose)),
          pose_b(transform_of(c.b.pose)), compute(std::make_unique<Compute>(a.get(), b.get())) {}
};

template <coal::GJKVariant variant> Decision collide(Kept<coal::ComputeCollision>& of) {
    coal::CollisionRequest request;
    request.gjk_variant = variant;
    request.enable_contact = false;
    request.distance_upper_bound = 0; // GJK ends as soon as it knows that they are apart
    of.touches.clear();
    return yes_or_no((*of.compute)(of.pose_a, of.pose_b, request, of.touches) > 0);
}

template <bool is_signed, coal::GJKVariant variant>
Distance distance(Kept<coal::ComputeDistance>& of) {
    coal::DistanceRequest request;
    request.gjk_variant = variant;
    request.enable_signed_distance = is_signed;
    of.nearest.clear();
    (*of.compute)(of.pose_a, of.pose_b, request, of.nearest);
    // Not signed it is 0 or less where they overlap.
    return plain_distance(is_signed ? of.nearest.min_distance
                                    : std::max(of.nearest.min_distance, 0.0));
}

template <coal::GJKVariant variant>
std::unique_ptr<Contender> make(const Job& job, CoalShapeQuery query) {
    using Collisions = Kept<coal::ComputeCollision>;
    using Distances = Kept<coal::ComputeDistance>;
    switch (query) {
    case CoalShapeQuery::collide:
        return over_cases<ShapePairCase, Collisions, collide<variant>>(job);
    case CoalShapeQuery::distance:
        return over_cases<ShapePairCase, Distances, distance<false, variant>>(job);
    case CoalShapeQuery::signed_distance:
        return over_cases<ShapePairCase, Distances, distance<true, variant>>(job);
    }
    return nullptr;
}

} // namespace

std::unique_ptr<Contender> make_coal_shapes(const Job& job, CoalShapeQuery query, CoalGjk gjk) {
    switch (gjk) {
    case CoalGjk::plain:
        return make<coal::DefaultGJK>(job, query);
    case CoalGjk::polyak:
        return make<coal::PolyakAcceleration>(job, query);
    case CoalGjk::nesterov:
        return make<coal::NesterovAcceleration>(job, query);
    }
    return nullptr;
}

} // namespace boxwood::bench
