#include "bench/peers/each_case.h"
#include "bench/peers/kernel_peers.h"

#include <BulletCollision/CollisionDispatch/btBoxBoxDetector.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <variant>

namespace boxwood::bench {
namespace on_shapes {
namespace {

using Shape = std::unique_ptr<btConvexInternalShape>;

/// Null for an ellipsoid, which Bullet has not. Its margins would round what has corners.
Shape shape_of(const ShapeOfPair& of) {
    const std::vector<double> doubles = lengths_of(of.shape);
    const auto length = [&](std::size_t i) { return static_cast<btScalar>(doubles[i]); };
    const auto sharp = [](auto shape) {
        shape->setMargin(0);
        return shape;
    };
    switch (of.shape.kind()) {
    case convex::ShapeKind::sphere:
        return std::make_unique<btSphereShape>(length(0));
    case convex::ShapeKind::box:
        return sharp(std::make_unique<btBoxShape>(btVector3(length(0), length(1), length(2))));
    case convex::ShapeKind::capsule:
        return std::make_unique<btCapsuleShapeZ>(length(0), 2 * length(1));
    case convex::ShapeKind::cylinder:
        return sharp(
            std::make_unique<btCylinderShapeZ>(btVector3(length(0), length(0), length(1))));
    case convex::ShapeKind::cone:
        return sharp(std::make_unique<btConeShapeZ>(length(0), 2 * length(1)));
    case convex::ShapeKind::hull: {
        auto hull = std::make_unique<btConvexHullShape>();
        for (std::size_t i = 0; i < doubles.size(); i += 3)
            hull->addPoint({length(i), length(i + 1), length(i + 2)}, false);
        hull->recalcLocalAabb();
        return sharp(std::move(hull));
    }
    default:
        return nullptr;
    }
}

btTransform transform_of(const convex::Pose& pose) {
    const auto number = [](double x) { return static_cast<btScalar>(x); };
    const auto& [x, y, z] = pose.rotation;
    return btTransform(btMatrix3x3(number(x.x), number(x.y), number(x.z), number(y.x), number(y.y),
                                   number(y.z), number(z.x), number(z.y), number(z.z)),
                       btVector3(number(pose.translation.x), number(pose.translation.y),
                                 number(pose.translation.z)));
}

double greatest_length(const ShapeOfPair& of) {
    double greatest = 0;
    for (const double length : lengths_of(of.shape))
        greatest = std::max(greatest, std::abs(length));
    return greatest;
}

struct Pair {
    Shape a, b;
    btGjkPairDetector::ClosestPointInput input;
    btScalar rounding; ///< a distance that is none
    explicit Pair(const ShapePairCase& c)
        : a(shape_of(c.a)), b(shape_of(c.b)),
          rounding(static_cast<btScalar>(1e-4 * (greatest_length(c.a) + greatest_length(c.b)))) {
        input.m_transformA = transform_of(c.a.pose);
        input.m_transformB = transform_of(c.b.pose);
    }
};

/// As in Bullet's own algorithm for two convex shapes, what is farther apart than they may be to
/// touch needs no distance, so that GJK ends at the first axis that separates them so far. Where
/// they overlap it may end at a distance that is not quite 0, or, without a solver for depth, as
/// that algorithm has one, at none that is right.
template <bool with_depth> Decision collide(Pair& p) {
    if (!p.a || !p.b)
        return {Answer::maybe, 0};
    const btScalar touch = p.rounding, at_most = p.a->getMargin() + p.b->getMargin() + touch;
    p.input.m_maximumDistanceSquared = at_most * at_most;
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver depth;
    btGjkPairDetector detector(p.a.get(), p.b.get(), &simplex, with_depth ? &depth : nullptr);
    btPointCollector result;
    detector.getClosestPoints(p.input, result, nullptr);
    if (result.m_hasResult || with_depth)
        return yes_or_no(result.m_hasResult && result.m_distance <= touch);
    constexpr int found_a_distance = 1; // too far to be a result; else the two overlap
    return yes_or_no(detector.m_lastUsedMethod != found_a_distance);
}

template <bool is_signed> Distance distance(const Pair& p) {
    if (!p.a || !p.b)
        return plain_distance(std::numeric_limits<double>::quiet_NaN());
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver depth;
    btGjkPairDetector detector(p.a.get(), p.b.get(), &simplex, is_signed ? &depth : nullptr);
    btPointCollector result;
    detector.getClosestPoints(p.input, result, nullptr);
    const double found = result.m_hasResult ? static_cast<double>(result.m_distance) : 0.0;
    return plain_distance(is_signed ? found : std::max(found, 0.0));
}

bool both_are(const Pair& p, int kind) {
    return p.a && p.b && p.a->getShapeType() == kind && p.b->getShapeType() == kind;
}
/// As btSphereSphereCollisionAlgorithm has it.
double distance_of_spheres(const Pair& p) {
    const btVector3 between = p.input.m_transformA.getOrigin() - p.input.m_transformB.getOrigin();
    return between.length() - (static_cast<const btSphereShape&>(*p.a).getRadius() +
                               static_cast<const btSphereShape&>(*p.b).getRadius());
}
/// Of a capsule along z, or of a sphere, which is one of no length.
struct Rod {
    btVector3 centre, half; ///< half its axis, in the world
    btScalar radius;

    Rod(const btConvexInternalShape& shape, const btTransform& at) : centre(at.getOrigin()) {
        if (shape.getShapeType() == SPHERE_SHAPE_PROXYTYPE) {
            half.setZero();
            radius = static_cast<const btSphereShape&>(shape).getRadius();
            return;
        }
        const auto& capsule = static_cast<const btCapsuleShape&>(shape);
        half = at.getBasis().getColumn(2) * capsule.getHalfHeight();
        radius = capsule.getRadius();
    }
};
bool are_rods(const Pair& p) {
    const auto is_rod = [](const Shape& shape) {
        return shape && (shape->getShapeType() == CAPSULE_SHAPE_PROXYTYPE ||
                         shape->getShapeType() == SPHERE_SHAPE_PROXYTYPE);
    };
    return is_rod(p.a) && is_rod(p.b) &&
           !(p.a->getShapeType() == SPHERE_SHAPE_PROXYTYPE &&
             p.b->getShapeType() == SPHERE_SHAPE_PROXYTYPE);
}
/// As btConvexConvexAlgorithm has two capsules, and a capsule and a sphere: by their axes' nearest
/// points.
double distance_of_rods(const Pair& p) {
    const Rod a(*p.a, p.input.m_transformA), b(*p.b, p.input.m_transformB);
    const btVector3 between = b.centre - a.centre;
    const btScalar aa = a.half.length2(), bb = b.half.length2(), ab = a.half.dot(b.half),
                   to_a = a.half.dot(between), to_b = b.half.dot(between), det = aa * bb - ab * ab;
    const auto within = [](btScalar x) { return std::clamp(x, btScalar(-1), btScalar(1)); };
    btScalar s = det > 0 ? within((to_a * bb - to_b * ab) / det) : btScalar(0);
    const btScalar t = bb > 0 ? within((s * ab - to_b) / bb) : btScalar(0);
    if (aa > 0)
        s = within((t * ab + to_a) / aa);
    return (between + t * b.half - s * a.half).length() - (a.radius + b.radius);
}
/// By btBoxBoxCollisionAlgorithm's detector: negative; nothing where they are apart.
std::optional<double> depth_of_boxes(const Pair& p) {
    btBoxBoxDetector detector(static_cast<const btBoxShape*>(p.a.get()),
                              static_cast<const btBoxShape*>(p.b.get()));
    btPointCollector result;
    detector.getClosestPoints(p.input, result, nullptr);
    return result.m_hasResult ? std::optional<double>(result.m_distance) : std::nullopt;
}
Decision default_collide(Pair& p) {
    if (both_are(p, SPHERE_SHAPE_PROXYTYPE))
        return yes_or_no(distance_of_spheres(p) <= 0);
    if (both_are(p, BOX_SHAPE_PROXYTYPE))
        return yes_or_no(depth_of_boxes(p).has_value());
    if (are_rods(p))
        return yes_or_no(distance_of_rods(p) <= 0);
    return collide<true>(p);
}
template <bool is_signed> Distance default_distance(const Pair& p) {
    const bool are_spheres = both_are(p, SPHERE_SHAPE_PROXYTYPE);
    if (are_spheres || are_rods(p)) {
        const double found = are_spheres ? distance_of_spheres(p) : distance_of_rods(p);
        return plain_distance(is_signed ? found : std::max(found, 0.0));
    }
    if (is_signed && both_are(p, BOX_SHAPE_PROXYTYPE))
        if (const std::optional<double> depth = depth_of_boxes(p))
            return plain_distance(*depth);
    return distance<is_signed>(p);
}

/// Answers that are none are not timed; in mixed families it is judged on the others.
std::optional<std::string> cannot(const Job& job) {
    const auto is_ellipsoid = [](const ShapeOfPair& of) {
        return of.shape.kind() == convex::ShapeKind::ellipsoid;
    };
    const auto* const cases =
        job.scene ? std::get_if<std::vector<ShapePairCase>>(&job.scene->cases) : nullptr;
    if (cases && std::ranges::all_of(*cases, [&](const ShapePairCase& c) {
            return is_ellipsoid(c.a) || is_ellipsoid(c.b);
        }))
        return "Bullet has no ellipsoids";
    return std::nullopt;
}

} // namespace
} // namespace on_shapes

std::vector<ContenderEntry> bullet_shapes() {
    using namespace on_shapes;
    const std::string notes =
        "input rounded to float; margins 0 but of spheres and capsules, whose radius it is; one "
        "pair per call";
    std::vector<ContenderEntry> all{
        each_case<ShapePairCase, Pair, collide<false>>(
            "shape_collide", "bullet", "shapes.collide", "f32",
            "Bullet's btGjkPairDetector without a solver for depth",
            "m_maximumDistanceSquared of the margins, as in its own algorithm, and of 1e-4 of the "
            "size, which counts as a touch; " +
                notes),
        each_case<ShapePairCase, Pair, distance<false>>(
            "shape_distance", "bullet", "shapes.distance", "f32",
            "Bullet's btGjkPairDetector without a solver for depth",
            "no result is read as 0; " + notes),
        each_case<ShapePairCase, Pair, distance<true>>(
            "signed_shape_distance", "bullet", "shapes.signed_distance", "f32",
            "Bullet's btGjkPairDetector with btGjkEpaPenetrationDepthSolver", notes),
        each_case<ShapePairCase, Pair, default_collide>(
            "shape_collide", "bullet", "shapes.collide.default_configuration", "f32",
            "Bullet's algorithms of two boxes, of spheres and capsules, else btGjkPairDetector "
            "with btGjkEpaPenetrationDepthSolver",
            "btBoxBoxDetector, formulas; of GJK a distance of 1e-4 of the size counts as a "
            "touch; " +
                notes),
        each_case<ShapePairCase, Pair, default_distance<false>>(
            "shape_distance", "bullet", "shapes.distance.default_configuration", "f32",
            "Bullet's algorithms of spheres and capsules, else as shapes.distance",
            "no result is read as 0; " + notes),
        each_case<ShapePairCase, Pair, default_distance<true>>(
            "signed_shape_distance", "bullet", "shapes.signed_distance.default_configuration",
            "f32",
            "Bullet's algorithms of two boxes that overlap, of spheres and capsules, else as "
            "shapes.signed_distance",
            "btBoxBoxDetector, formulas; " + notes)};
    for (ContenderEntry& e : all)
        e.cannot = cannot;
    return all;
}

} // namespace boxwood::bench
