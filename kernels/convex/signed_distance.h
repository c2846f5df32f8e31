#pragma once

#include "kernels/convex/support.h"
#include "kernels/decision.h"

#include <cstdint>

namespace boxwood::convex {

/// How far apart two shapes are, or how deep one is in the other. Negative: minus the length of the
/// least translation after which they only touch. lo <= true value <= hi, and lo <= distance <= hi:
/// lo > 0 proves that they are apart, hi < 0 that they overlap. The truth is that of the shapes put
/// where the doubles of the poses say; radii of spheres and capsules are not scaled.
struct SignedDistance {
    double distance = 0, lo = 0, hi = 0;
    /// On a and on b, in the world: point_b - point_a = distance * normal, up to rounding and, for
    /// round shapes, the root of (hi - lo) times the size.
    Vec3<double> point_a{}, point_b{};
    /// Of unit length, from a to b: moving b along it takes it away.
    Vec3<double> normal{0, 0, 1};

    /// So far along the normal the two surely part; below 0 where they are apart.
    double depth() const { return distance <= 0 ? -lo : -distance; }
};

/// How wide hi - lo may be: the search ends when it is at most relative * |distance| + absolute,
/// plus rounding. Wider tolerances cost less; the bounds hold for all of them.
struct Tolerance {
    double relative = 0x1p-36;
    double absolute = 0;
};

/// Closed forms: sphere with sphere, capsule, box, cylinder, cone, and by a root ellipsoid; capsule
/// with capsule (their segments); half-space and plane with all; the depth of boxes (15
/// directions).
inline constexpr KernelInfo closed_form_info{
    "convex_convex",
    "closed_form",
    "spheres, capsules and planes with what they have a formula for; 15 directions for boxes",
    Promise::certified,
    "lo <= signed distance <= hi, width about 2e-14 of the size of all, of ellipsoids 5e-14; "
    "derived in convex/detail/relative_pose.h",
    "30 to 200 flops; ellipsoids some five turns of a search"};
/// The rest: Gilbert-Johnson-Keerthi apart, the expanding polytope for depth.
inline constexpr KernelInfo gjk_epa_info{
    "convex_convex",
    "gjk_epa",
    "GJK on cores without their radii, then an expanding polytope for depth; ends by its bounds",
    Promise::certified,
    "lo <= signed distance <= hi, width by tolerance, 2^-36 of hi; wider for round shapes deep in "
    "one another",
    "0.2 to 2 us apart, 1 to 50 us for depth"};

/// The pose's matrix is a rotation up to rounding: what it lacks (at most 2^-10) widens the bounds.
/// The width of [lo, hi] is 2^-36 of the distance, plus about 2e-14 of the size of all, 5e-14 for a
/// sphere and an ellipsoid,
/// (|translation| of b from a, and how far both reach from their origins), where the search ends as
/// it should. Sizes are 0 or 2^-100 .. 2^100, else the bounds say next to nothing. NaN, or no
/// rotation: NaN.
SignedDistance signed_distance(const Shape& a, const Pose& pose_a, const Shape& b,
                               const Pose& pose_b, const Tolerance& tolerance = {});

/// Whether the signed distance is at most t: yes and no are proven, maybe is within rounding.
Decision within(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, double t);

/// Whether the two share a point: within(..., 0).
Decision collide(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

namespace detail {

using DistanceOf = SignedDistance(const void*, const Pose&, const void*, const Pose&,
                                  const Tolerance&);
using WithinOf = Decision(const void*, const Pose&, const void*, const Pose&, double);
/// By the kinds of a and b.
extern DistanceOf* const distance_table[shape_kinds * shape_kinds];
extern WithinOf* const within_table[shape_kinds * shape_kinds];

template <class A, class B>
constexpr std::size_t entry = static_cast<std::size_t>(kind_of<A>()) * shape_kinds +
                              static_cast<std::size_t>(kind_of<B>());

} // namespace detail

/// The same of shapes whose kinds are known.
template <ConvexShape A, ConvexShape B>
SignedDistance signed_distance(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b,
                               const Tolerance& tolerance = {}) {
    return detail::distance_table[detail::entry<A, B>](&a, pose_a, &b, pose_b, tolerance);
}
template <ConvexShape A, ConvexShape B>
Decision within(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b, double t) {
    return detail::within_table[detail::entry<A, B>](&a, pose_a, &b, pose_b, t);
}
template <ConvexShape A, ConvexShape B>
Decision collide(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b) {
    return within(a, pose_a, b, pose_b, 0);
}

} // namespace boxwood::convex
