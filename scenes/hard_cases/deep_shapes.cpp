#include "scenes/hard_cases/drawn_shapes.h"
#include "scenes/hard_cases/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

/// Pairs whose depth is a closed form: that of the origin in their Minkowski difference.
namespace boxwood {
namespace {

using convex::ShapeKind;
using Vec = Vec3<double>;

/// How far a point inside, in the shape's frame, is from the surface.
double depth_inside(const convex::Sphere& s, Vec p) { return s.radius - length(p); }
double depth_inside(const convex::Box& s, Vec p) {
    return std::min({s.half.x - std::abs(p.x), s.half.y - std::abs(p.y), s.half.z - std::abs(p.z)});
}
double across(Vec p) { return std::sqrt(p.x * p.x + p.y * p.y); } ///< from the z axis
double depth_inside(const convex::Capsule& s, Vec p) {
    const double beyond = std::max(std::abs(p.z) - s.half_length, 0.0);
    return s.radius - std::sqrt(across(p) * across(p) + beyond * beyond);
}
double depth_inside(const convex::Cylinder& s, Vec p) {
    return std::min(s.radius - across(p), s.half_length - std::abs(p.z));
}
double depth_inside(const convex::Cone& s, Vec p) {
    const double height = 2 * s.half_length,
                 side = std::sqrt(s.radius * s.radius + height * height);
    const double radius_here = s.radius * (s.half_length - p.z) / height;
    return std::min((radius_here - across(p)) * height / side, p.z + s.half_length);
}
/// Of its middle.
double depth_inside(const convex::Ellipsoid& s, Vec) {
    return std::min({s.radii.x, s.radii.y, s.radii.z});
}
double depth_inside(const Polyhedron& hull, Vec p) {
    double depth = std::numeric_limits<double>::infinity();
    for (const auto& [i, j, k] : hull.faces) {
        const Vec a = hull.points[i],
                  n = cross(hull.points[j] - a, hull.points[k] - a); // out of it
        depth = std::min(depth, dot(a - p, n) / length(n));
    }
    return depth;
}
double depth_inside(const ShapeOfPair& posed, Vec p) {
    return posed.shape.visit([&]<class S>(const S& s) -> double {
        if constexpr (std::is_same_v<S, convex::Hull>)
            return depth_inside(*posed.polyhedron, p);
        else if constexpr (requires { depth_inside(s, p); })
            return depth_inside(s, p);
        return std::numeric_limits<double>::quiet_NaN(); // is not drawn
    });
}

ShapePairCase as_deep(const Drawn& a, const Drawn& b, double depth) {
    return with_slack(a, b, -depth, -depth);
}

/// A ball whose centre is in the other shape: `share` of the way from the middle of the ball inside
/// it to its surface.
ShapePairCase ball_in(ShapeKind kind, double share, Draws& draws) {
    Drawn a = draw_shape(kind, draws), b = draw_shape(ShapeKind::sphere, draws);
    const Vec to = a.farthest_along(draws.unit_vector());
    const Vec centre = a.ball.centre + share * (to - a.ball.centre);
    a.posed.pose.translation = draw_offset(draws);
    b.posed.pose.translation = a.posed.pose(centre);
    return as_deep(a, b, b.ball.radius + depth_inside(a.posed, centre));
}

ShapePairCase ball_in(Draws& draws) {
    ShapeKind kind = ShapeKind::ellipsoid; // has a closed form of its middle alone
    while (kind == ShapeKind::ellipsoid)
        kind = draw_kind(draws);
    return ball_in(kind, draws.uniform(0, 0.95), draws);
}

/// Puts b, turned as a is, so far from a along its axes.
void put_beside(Drawn& a, Drawn& b, Vec by, Draws& draws) {
    a.posed.pose.translation = draw_offset(draws);
    b.posed.pose.rotation = a.posed.pose.rotation;
    b.posed.pose.translation = a.posed.pose(by);
}
Vec draw_within(Vec half, Draws& draws) {
    return {half.x * draws.uniform(-0.95, 0.95), half.y * draws.uniform(-0.95, 0.95),
            half.z * draws.uniform(-0.95, 0.95)};
}
/// In the cylinder of this radius and half length: in a square prism in it.
Vec draw_within(double radius, double half, Draws& draws) {
    return draw_within({radius * std::sqrt(0.5), radius * std::sqrt(0.5), half}, draws);
}

template <class S> const S& as(const Drawn& drawn) { return *drawn.posed.shape.get_if<S>(); }

/// Two of the same axes, whose difference is a box, or a cylinder with or without a ball around it.
ShapePairCase side_by_side(Draws& draws) {
    constexpr std::array<std::array<ShapeKind, 2>, 5> all{
        {{ShapeKind::box, ShapeKind::box},
         {ShapeKind::box, ShapeKind::capsule},
         {ShapeKind::capsule, ShapeKind::capsule},
         {ShapeKind::cylinder, ShapeKind::capsule},
         {ShapeKind::cylinder, ShapeKind::cylinder}}};
    const auto [kind_a, kind_b] = all[static_cast<std::size_t>(draw_integer(draws, 0, 4))];
    Drawn a = draw_shape(kind_a, draws), b = draw_shape(kind_b, draws);
    const auto beside = [&](const auto& difference, Vec by, double around) {
        put_beside(a, b, by, draws);
        return as_deep(a, b, around + depth_inside(difference, by));
    };
    if (kind_a == ShapeKind::box) {
        Vec half = as<convex::Box>(a).half;
        if (kind_b == ShapeKind::box)
            half = half + as<convex::Box>(b).half;
        else
            half.z += as<convex::Capsule>(b).half_length;
        return beside(convex::Box{half}, draw_within(half, draws),
                      kind_b == ShapeKind::box ? 0 : as<convex::Capsule>(b).radius);
    }
    if (kind_a == ShapeKind::capsule) {
        const auto &one = as<convex::Capsule>(a), &two = as<convex::Capsule>(b);
        const convex::Capsule both{one.radius + two.radius, one.half_length + two.half_length};
        const double end = 0.3 * both.radius; // of what lies beyond the rod
        return beside(both, draw_within(both.radius, both.half_length + end, draws), 0);
    }
    convex::Cylinder both = as<convex::Cylinder>(a);
    if (kind_b == ShapeKind::cylinder) {
        both.radius += as<convex::Cylinder>(b).radius;
        both.half_length += as<convex::Cylinder>(b).half_length;
        return beside(both, draw_within(both.radius, both.half_length, draws), 0);
    }
    both.half_length += as<convex::Capsule>(b).half_length;
    return beside(both, draw_within(both.radius, both.half_length, draws),
                  as<convex::Capsule>(b).radius);
}

} // namespace

HardCaseFamily deep_shapes_family() {
    return in_range(
        rounded_family("deep_shapes", "convex shapes in each other, whose depth has a closed form",
                       Panel::generic, [](const HardCaseSpec& spec, const Random& random) {
                           return shape_pairs(spec, random, [](Draws& draws) {
                               return draw_coin(draws) ? ball_in(draws) : side_by_side(draws);
                           });
                       }));
}

HardCaseFamily ball_in_ellipsoid_family() {
    return in_range(rounded_family(
        "ball_in_ellipsoid", "a ball in the middle of an ellipsoid: both ways out are equally deep",
        Panel::degenerate, [](const HardCaseSpec& spec, const Random& random) {
            return shape_pairs(
                spec, random, [](Draws& draws) { return ball_in(ShapeKind::ellipsoid, 0, draws); });
        }));
}

} // namespace boxwood
