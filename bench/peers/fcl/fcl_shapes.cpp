#include "bench/peers/each_case.h"
#include "bench/peers/fcl/mesh_models.h"
#include "bench/peers/kernel_peers.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>

namespace boxwood::bench {
namespace on_shapes {
namespace {

template <class S> using Geometry = std::shared_ptr<fcl::CollisionGeometry<S>>;

template <class S> Geometry<S> convex_of(const Polyhedron& polyhedron) {
    auto points = std::make_shared<std::vector<fcl::Vector3<S>>>();
    for (const Vec3<double>& p : polyhedron.points)
        points->emplace_back(static_cast<S>(p.x), static_cast<S>(p.y), static_cast<S>(p.z));
    auto faces = std::make_shared<std::vector<int>>();
    for (const auto& face : polyhedron.faces) {
        faces->push_back(3);
        for (const std::uint32_t corner : face)
            faces->push_back(static_cast<int>(corner));
    }
    return std::make_shared<fcl::Convex<S>>(points, static_cast<int>(polyhedron.faces.size()),
                                            faces);
}

template <class S> Geometry<S> geometry_of(const ShapeOfPair& of) {
    const std::vector<double> doubles = lengths_of(of.shape);
    const auto length = [&](std::size_t i) { return static_cast<S>(doubles[i]); };
    switch (of.shape.kind()) {
    case convex::ShapeKind::sphere:
        return std::make_shared<fcl::Sphere<S>>(length(0));
    case convex::ShapeKind::box:
        return std::make_shared<fcl::Box<S>>(2 * length(0), 2 * length(1), 2 * length(2));
    case convex::ShapeKind::capsule:
        return std::make_shared<fcl::Capsule<S>>(length(0), 2 * length(1));
    case convex::ShapeKind::cylinder:
        return std::make_shared<fcl::Cylinder<S>>(length(0), 2 * length(1));
    case convex::ShapeKind::cone:
        return std::make_shared<fcl::Cone<S>>(length(0), 2 * length(1));
    case convex::ShapeKind::ellipsoid:
        return std::make_shared<fcl::Ellipsoid<S>>(length(0), length(1), length(2));
    case convex::ShapeKind::hull:
        return convex_of<S>(*of.polyhedron);
    default:
        throw std::invalid_argument("the families of shape pairs have no such shape");
    }
}

/// A user's two shapes, with a result that keeps its memory from call to call.
template <class S> struct Pair {
    Geometry<S> a, b;
    fcl::Transform3<S> pose_a, pose_b;
    fcl::CollisionResult<S> touches;
    fcl::DistanceResult<S> nearest;
    bool has_depth; ///< of its contact, in closed form
    bool are_capsules;
    explicit Pair(const ShapePairCase& c)
        : a(geometry_of<S>(c.a)), b(geometry_of<S>(c.b)), pose_a(transform_of<S>(c.a.pose)),
          pose_b(transform_of<S>(c.b.pose)), has_depth(depth_is_closed(*a, *b)),
          are_capsules(a->getNodeType() == fcl::GEOM_CAPSULE &&
                       b->getNodeType() == fcl::GEOM_CAPSULE) {}

    static bool depth_is_closed(const fcl::CollisionGeometry<S>& a,
                                const fcl::CollisionGeometry<S>& b) {
        const auto has_formula = [](fcl::NODE_TYPE type) {
            return type == fcl::GEOM_SPHERE || type == fcl::GEOM_BOX || type == fcl::GEOM_CAPSULE ||
                   type == fcl::GEOM_CYLINDER;
        };
        const fcl::NODE_TYPE one = a.getNodeType(), two = b.getNodeType();
        return (one == fcl::GEOM_SPHERE && has_formula(two)) ||
               (two == fcl::GEOM_SPHERE && has_formula(one)) ||
               (one == fcl::GEOM_BOX && two == fcl::GEOM_BOX);
    }
};

template <class S, fcl::GJKSolverType solver> Decision collide(Pair<S>& p) {
    fcl::CollisionRequest<S> request;
    request.gjk_solver_type = solver;
    p.touches.clear();
    return yes_or_no(fcl::collide<S>(p.a.get(), p.pose_a, p.b.get(), p.pose_b, request, p.touches) >
                     0);
}

template <class S, fcl::GJKSolverType solver> double plain(Pair<S>& p) {
    fcl::DistanceRequest<S> request;
    request.gjk_solver_type = solver;
    p.nearest.clear();
    fcl::distance<S>(p.a.get(), p.pose_a, p.b.get(), p.pose_b, request, p.nearest);
    return static_cast<double>(p.nearest.min_distance);
}

template <class S, fcl::GJKSolverType solver> Distance distance(Pair<S>& p) {
    return plain_distance(std::max(plain<S, solver>(p), 0.0));
}

/// By the contact, where FCL has its depth in closed form, and of two capsules by the distance,
/// which is one that goes below zero: its polytope needs tens of milliseconds for two spheres. NaN
/// where FCL gives up: its polytope throws.
template <class S, fcl::GJKSolverType solver> Distance signed_distance(Pair<S>& p) {
    if (p.are_capsules)
        return plain_distance(plain<S, solver>(p));
    if (p.has_depth) {
        fcl::CollisionRequest<S> request;
        request.enable_contact = true;
        request.gjk_solver_type = solver;
        p.touches.clear();
        fcl::collide<S>(p.a.get(), p.pose_a, p.b.get(), p.pose_b, request, p.touches);
        if (!p.touches.isCollision())
            return distance<S, solver>(p);
        return plain_distance(-static_cast<double>(p.touches.getContact(0).penetration_depth));
    }
    fcl::DistanceRequest<S> request;
    request.enable_signed_distance = true;
    request.gjk_solver_type = solver;
    p.nearest.clear();
    try {
        fcl::distance<S>(p.a.get(), p.pose_a, p.b.get(), p.pose_b, request, p.nearest);
        return plain_distance(static_cast<double>(p.nearest.min_distance));
    } catch (const std::exception&) {
        return plain_distance(std::numeric_limits<double>::quiet_NaN());
    }
}

template <class S, fcl::GJKSolverType solver>
void append(std::vector<ContenderEntry>& all, const std::string& after, const std::string& how) {
    constexpr bool is_single = std::is_same_v<S, float>;
    const std::string precision = is_single ? "f32" : "f64",
                      name = is_single ? "shapes_f32." : "shapes.";
    const std::string notes =
        "default tolerances (1e-6); closed forms where FCL has them; one pair per call, into a "
        "kept result" +
        std::string(is_single ? "; floats, compiled here" : "");
    all.push_back(each_case<ShapePairCase, Pair<S>, collide<S, solver>>(
        "shape_collide", "fcl", name + "collide" + after, precision,
        "FCL's collide on two shapes, " + how,
        "one contact without its point (enable_contact off); " + notes));
    all.push_back(each_case<ShapePairCase, Pair<S>, distance<S, solver>>(
        "shape_distance", "fcl", name + "distance" + after, precision,
        "FCL's distance of two shapes, " + how,
        "not signed, without points; its -1 where they overlap is read as 0; " + notes));
    if constexpr (solver == fcl::GST_LIBCCD)
        all.push_back(each_case<ShapePairCase, Pair<S>, signed_distance<S, solver>>(
            "signed_shape_distance", "fcl", name + "signed_distance" + after, precision,
            "FCL's signed distance of two shapes, " + how,
            "without points; two capsules by distance, which goes below zero; a sphere and "
            "another, a box, capsule or cylinder, and two boxes by distance and, where they "
            "overlap, the depth of their contact, which is a closed form; the rest by its "
            "polytope; no answer where FCL throws; " +
                notes));
}

} // namespace
} // namespace on_shapes

std::vector<ContenderEntry> fcl_shapes() {
    std::vector<ContenderEntry> all;
    on_shapes::append<double, fcl::GST_LIBCCD>(all, "", "by libccd");
    on_shapes::append<double, fcl::GST_INDEP>(all, ".indep", "by its own GJK");
    on_shapes::append<float, fcl::GST_LIBCCD>(all, "", "in floats, by libccd");
    on_shapes::append<float, fcl::GST_INDEP>(all, ".indep", "in floats, by its own GJK");
    return all;
}

} // namespace boxwood::bench
