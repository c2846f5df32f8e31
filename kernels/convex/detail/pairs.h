#pragma once

#include "kernels/convex/detail/box_box.h"
#include "kernels/convex/detail/epa.h"
#include "kernels/convex/detail/foot.h"
#include "kernels/convex/signed_distance.h"
#include "kernels/convex/unit_flat.h"
#include "kernels/features/segment_segment.h"

/// What each pair of shapes is answered by: a closed form, or GJK and EPA on the cores.
namespace boxwood::convex::detail {

using V = Vec3<double>;

template <class S> inline constexpr bool is_flat = !BoundedShape<S>;
/// Whether a point has a closed form against it.
template <class S>
concept HasFoot = requires(V p, const S& s) {
    foot(p, core(s));
};

template <class S>
concept HasInnerBall = requires(const S& s) {
    inner_radius(core(s));
};

/// NaN in all, as for NaN and for poses that are none.
SignedDistance no_distance();
inline bool in_range(double size) { return size >= smallest_size && size <= largest_size; }
/// size is out of range or NaN. Where all is one point with radii, bounds are as near as can be.
[[gnu::cold]] SignedDistance of_odd_size(double size, double lack, double radius, const Pose& a);

inline Decision decided(double lo, double hi, double t) {
    return {hi <= t ? Answer::yes : lo > t ? Answer::no : Answer::maybe};
}

/// A frame in which the cores of two shapes were searched.
struct PosedFrame {
    const Pose& pose;
    V operator()(V p) const { return pose(p); }
    V direction(V n) const { return unit_or(times(pose.rotation, n), {0, 0, 1}); }
};
struct MovedFrame {
    V origin;
    V operator()(V p) const { return origin + p; }
    V direction(V n) const { return n; }
};

/// Of cores in such a frame, made that of the shapes in the world.
template <class Frame>
SignedDistance in_world(const CoreDistance& core, double value, double error, double radius_a,
                        double radius_b, const Frame& frame) {
    const double radius = radius_a + radius_b;
    SignedDistance d;
    d.lo = core.lo - radius - error;
    d.hi = core.hi - radius + error;
    d.distance = std::clamp(value - radius, d.lo, d.hi);
    d.normal = frame.direction(core.normal);
    d.point_a = frame(core.on_a) + d.normal * radius_a;
    d.point_b = frame(core.on_a - core.between) - d.normal * radius_b;
    return d;
}

inline SignedDistance swapped(SignedDistance d) {
    std::swap(d.point_a, d.point_b);
    d.normal = -d.normal;
    return d;
}

/// Sphere a and a shape with a closed form, in that one's frame; if that has but one axis or none,
/// in the world's, where nothing of the rotation counts but the axis as it is.
template <class B> struct Ball {
    static constexpr bool in_world = std::is_same_v<B, Sphere> || std::is_same_v<B, Capsule>;
    Foot at;
    double distance, error, size, lack, radius;

    [[gnu::always_inline]] Ball(const Sphere& a, const Pose& pose_a, const B& b,
                                const Pose& pose_b) {
        const V between = pose_a.translation - pose_b.translation;
        radius = a.radius + radius_of(b);
        size = norm1(between) + reach(core(b)) + radius;
        lack = in_world ? 0 : defect(pose_b.rotation);
        if constexpr (std::is_same_v<B, Capsule>) {
            const V axis = third_column(pose_b.rotation);
            size += b.half_length * norm1(axis); // which need not be of unit length
            at = foot_on_rod(between, axis, b.half_length);
        } else
            at = foot(in_world ? between : transposed_times(pose_b.rotation, between), core(b));
        distance = at.distance - radius;
        error = distance_error(size, lack) + at.width;
    }
    bool is_odd() const { return !in_range(size) || !(lack <= max_defect); }
};

template <class B>
SignedDistance ball_distance(const Sphere& a, const Pose& pose_a, const B& b, const Pose& pose_b) {
    const Ball<B> ball(a, pose_a, b, pose_b);
    if (ball.is_odd()) [[unlikely]]
        return of_odd_size(ball.size, ball.lack, ball.radius, pose_b);
    const auto turned = [&](V v) { return ball.in_world ? v : times(pose_b.rotation, v); };
    V n = turned(ball.at.normal);
    if (ball.lack > 0x1p-40) [[unlikely]] // a matrix that is no rotation stretches it so far
        n = unit_or(n, {0, 0, 1});
    return {ball.distance,
            ball.distance - ball.error,
            ball.distance + ball.error,
            pose_a.translation - n * a.radius,
            pose_b.translation + turned(ball.at.point) + n * radius_of(b),
            -n};
}

/// A bounded shape a against the half-space or plane b: only the normal separates the two.
template <class A, class B> struct OnFlat {
    V normal, local;  ///< of b; in the world and in a's frame
    V below, above;   ///< a's core farthest against and along it, in a's frame
    double low, high; ///< their heights above the plane
    double radius, size, lack, error;

    [[gnu::always_inline]] OnFlat(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b) {
        const auto [unit, offset] = unit_flat(b);
        radius = radius_of(a);
        normal = times(pose_b.rotation, unit);
        const V between = pose_a.translation - pose_b.translation;
        local = transposed_times(pose_a.rotation, normal);
        size = norm1(between) + reach(core(a)) + radius + std::abs(offset);
        lack = defect(pose_b.rotation);
        if constexpr (!std::is_same_v<A, Sphere>)
            lack += defect(pose_a.rotation);
        error = distance_error(size, lack);
        below = support(core(a), -local);
        above = support(core(a), local);
        const double middle = dot(normal, between) - offset;
        low = middle + dot(local, below);
        high = middle + dot(local, above);
    }
    bool is_odd() const { return !in_range(size) || !(lack <= max_defect); }
    /// Beyond the plane, on the other side from where the normal points.
    bool is_beneath() const { return std::is_same_v<B, Plane> && -high > low; }
    double distance() const { return (is_beneath() ? -high : low) - radius; }
};

template <class A, class B>
SignedDistance flat_distance(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b) {
    const OnFlat<A, B> flat(a, pose_a, b, pose_b);
    if (flat.is_odd()) [[unlikely]]
        return of_odd_size(flat.size, flat.lack, flat.radius, pose_a);
    const bool beneath = flat.is_beneath();
    const double d = flat.distance(), sign = beneath ? -1 : 1;
    const V at = pose_a(beneath ? flat.above : flat.below);
    return {d,
            d - flat.error,
            d + flat.error,
            at - flat.normal * (sign * flat.radius),
            at - flat.normal * (beneath ? flat.high : flat.low),
            flat.normal * -sign};
}

/// Of two half-spaces or planes. Unless they are parallel no translation takes them apart, and
/// whether they are, rounding leaves open.
SignedDistance flats_distance(const HalfSpace& a, bool a_is_plane, const Pose& pose_a,
                              const HalfSpace& b, bool b_is_plane, const Pose& pose_b);

/// The segments of two capsules, in the world.
struct Rods {
    V half_a, half_b, b_from_a; ///< half of each, and from middle to middle
    double radius_a, radius_b, size, error;

    Rods(const Capsule& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b)
        : half_a(third_column(pose_a.rotation) * a.half_length),
          half_b(third_column(pose_b.rotation) * b.half_length),
          b_from_a(pose_b.translation - pose_a.translation), radius_a(a.radius),
          radius_b(b.radius) {
        size = norm1(b_from_a) + norm1(half_a) + norm1(half_b) + radius_a + radius_b;
        error = distance_error(size, 0);
    }
    /// False if rounding leaves their distance too vague. on_a is seen from the middle of a.
    bool measure(const Goal& goal, CoreDistance& found) const;
};

template <class A, class B>
inline constexpr bool are_capsules = std::is_same_v<A, Capsule>&& std::is_same_v<B, Capsule>;

template <class A, class B> struct Search {
    const A& a;
    const B& b;
    const Pose& pose_a;
    const Pose& pose_b;
    RelativePose b_in_a{pose_a, pose_b};
    double radius_a = radius_of(a), radius_b = radius_of(b);
    double size = norm1(b_in_a.translation) + reach(core(a)) + reach(core(b)) + radius_a + radius_b;
    double error = distance_error(size, b_in_a.lack);

    static constexpr bool boxes = std::is_same_v<A, Box> && std::is_same_v<B, Box>;

    bool is_odd() const { return !in_range(size) || !(b_in_a.lack <= max_defect); }
    V start() const { return usable(b_in_a.translation) ? b_in_a.translation : V{1, 0, 0}; }

    CoreDistance run(const Goal& goal) const {
        const auto& inner_a = core(a);
        const auto& inner_b = core(b);
        const Difference difference{inner_a, inner_b, b_in_a};
        if constexpr (boxes)
            if (const BoxGaps gaps = box_gaps(a, b, b_in_a, size, 0); gaps.hi < -error)
                return boxes_depth(gaps, difference, goal);
        Simplex simplex;
        CoreDistance found = nearest_to_origin(difference, start(), goal, simplex);
        if (!found.overlapping || goal.reached(found.lo, found.hi))
            return found;
        if constexpr (boxes)
            return boxes_depth(box_gaps(a, b, b_in_a, size, inf), difference, goal);
        find_depth(AnyDifference(difference), simplex, goal, found);
        return found;
    }

    /// By the 15 directions. The points come from GJK, with b moved out, where corners do not do.
    template <class D>
    CoreDistance boxes_depth(const BoxGaps& gaps, const D& difference, const Goal& goal) const {
        CoreDistance found;
        found.lo = gaps.gap;
        found.hi = gaps.hi;
        found.normal = gaps.normal;
        found.between = gaps.normal * -gaps.gap;
        if (!touching_point(a, b, b_in_a, gaps, found.on_a)) {
            RelativePose out = b_in_a;
            out.translation = out.translation + found.between;
            Simplex simplex;
            found.on_a = nearest_to_origin(Difference{difference.a, difference.b, out}, gaps.normal,
                                           Goal{size, 0x1p-36, goal.slack}, simplex)
                             .on_a;
        }
        return found;
    }
};

template <class A, class B>
SignedDistance measure(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b,
                       const Tolerance& tolerance) {
    if constexpr (is_flat<A> && is_flat<B>) {
        return flats_distance({a.normal, a.offset}, std::is_same_v<A, Plane>, pose_a,
                              {b.normal, b.offset}, std::is_same_v<B, Plane>, pose_b);
    } else if constexpr (is_flat<A>) {
        return swapped(flat_distance(b, pose_b, a, pose_a));
    } else if constexpr (is_flat<B>) {
        return flat_distance(a, pose_a, b, pose_b);
    } else if constexpr (std::is_same_v<A, Sphere> && HasFoot<B>) {
        return ball_distance(a, pose_a, b, pose_b);
    } else {
        if constexpr (are_capsules<A, B>) {
            const Rods rods(a, pose_a, b, pose_b);
            const Goal goal{rods.size, tolerance.relative, tolerance.absolute + 8 * u * rods.size,
                            a.radius + b.radius};
            if (CoreDistance found; in_range(rods.size) && rods.measure(goal, found)) [[likely]]
                return in_world(found, found.hi, rods.error, a.radius, b.radius,
                                MovedFrame{pose_a.translation});
        }
        const Search<A, B> search{a, b, pose_a, pose_b};
        const double radius = search.radius_a + search.radius_b;
        if (search.is_odd()) [[unlikely]]
            return of_odd_size(search.size, search.b_in_a.lack, radius, pose_a);
        const Goal goal{search.size, tolerance.relative, tolerance.absolute + 8 * u * search.size,
                        radius};
        const CoreDistance found = search.run(goal);
        return in_world(found, Search<A, B>::boxes && found.overlapping ? found.lo : found.hi,
                        search.error, search.radius_a, search.radius_b, PosedFrame{pose_a});
    }
}

template <class A, class B>
Decision decide(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b, double t) {
    if constexpr (is_flat<A> && is_flat<B>) {
        const SignedDistance d = measure(a, pose_a, b, pose_b, {});
        return decided(d.lo, d.hi, t);
    } else if constexpr (is_flat<A>) {
        return decide(b, pose_b, a, pose_a, t);
    } else if constexpr (is_flat<B>) {
        const OnFlat<A, B> flat(a, pose_a, b, pose_b);
        if (flat.is_odd()) [[unlikely]] {
            const SignedDistance d = of_odd_size(flat.size, flat.lack, flat.radius, pose_a);
            return decided(d.lo, d.hi, t);
        }
        return decided(flat.distance() - flat.error, flat.distance() + flat.error, t);
    } else if constexpr (std::is_same_v<A, Sphere> && HasFoot<B>) {
        const Ball<B> ball(a, pose_a, b, pose_b);
        if (ball.is_odd()) [[unlikely]] {
            const SignedDistance d = of_odd_size(ball.size, ball.lack, ball.radius, pose_b);
            return decided(d.lo, d.hi, t);
        }
        return decided(ball.distance - ball.error, ball.distance + ball.error, t);
    } else {
        if constexpr (are_capsules<A, B>) {
            const Rods rods(a, pose_a, b, pose_b);
            const double limit = t + (a.radius + b.radius);
            const double error = rods.error + 4 * u * std::abs(limit);
            CoreDistance found;
            if (in_range(rods.size) &&
                rods.measure({rods.size, 0, 8 * u * rods.size, 0, limit + error, limit - error},
                             found)) [[likely]]
                return decided(found.lo - error, found.hi + error, limit);
        }
        const Search<A, B> search{a, b, pose_a, pose_b};
        const double radius = search.radius_a + search.radius_b;
        if (search.is_odd()) [[unlikely]] {
            const SignedDistance d = of_odd_size(search.size, search.b_in_a.lack, radius, pose_a);
            return decided(d.lo, d.hi, t);
        }
        const double limit = t + radius, error = search.error + 4 * u * std::abs(limit);
        if constexpr (HasInnerBall<A> && HasInnerBall<B>) {
            // Balls around the middles that overlap: nothing is left to search.
            const double inner_hi =
                length(search.b_in_a.translation) - inner_radius(core(a)) - inner_radius(core(b));
            if (inner_hi + error <= limit)
                return decided(-inf, inner_hi + error, limit);
        }
        if constexpr (Search<A, B>::boxes)
            if (limit <= 0) {
                const BoxGaps gaps = box_gaps(a, b, search.b_in_a, search.size, limit + error);
                return decided(gaps.gap - error, gaps.hi + error, limit);
            }
        const CoreDistance found =
            search.run({search.size, 0, 8 * u * search.size, 0, limit + error, limit - error});
        return decided(found.lo - error, found.hi + error, limit);
    }
}

} // namespace boxwood::convex::detail
