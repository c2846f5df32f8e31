#include "kernels/convex/first_contact.h"

#include "kernels/convex/detail/relative_pose.h"
#include "kernels/convex/unit_flat.h"

namespace boxwood::convex {
namespace {

using namespace detail;
using V = Vec3<double>;

/// One of the two bodies.
struct Body {
    const Shape& shape;
    const Motion& motion;
    bool is_flat;
    double reach; ///< of the shape from its origin
    double arm;   ///< of the shape from the centre of rotation
    double error; ///< of its poses

    Body(const Shape& s, const Motion& m)
        : shape(s), motion(m),
          is_flat(s.kind() == ShapeKind::half_space || s.kind() == ShapeKind::plane),
          reach(s.visit([]<class S>(const S& x) {
              if constexpr (BoundedShape<S>)
                  return detail::reach(core(x)) + radius_of(x);
              else
                  return std::abs(unit_flat(x).offset);
          })),
          arm((norm1(m.start.translation - m.centre) + reach) * (1 + defect(m.start.rotation))),
          error(motion_error(m, reach)) {}

    /// How fast a point of it moves along n at most, n of unit length: the arm turns with
    /// speed spin x arm, of which |n x spin| arm is along n.
    double speed(V n) const {
        return dot(n, motion.velocity) + length(cross(n, motion.spin)) * arm;
    }
    double greatest_speed() const { return norm1(motion.velocity) + norm1(motion.spin) * arm; }
    double size() const { return arm + norm1(motion.velocity); }
};

/// A direction and how far b is beyond a along it: less than the truth.
struct Gap {
    V normal;
    double gap;
};

struct Pair {
    Body a, b;
    double size =
        a.size() + b.size() + norm1(a.motion.start.translation - b.motion.start.translation);
    double error = a.error + b.error;

    Gap gap_at(double t) const {
        const Pose pose_a = pose_at(a.motion, t), pose_b = pose_at(b.motion, t);
        const SignedDistance d =
            signed_distance(a.shape, pose_a, b.shape, pose_b, {.relative = 0x1p-10, .absolute = 0});
        if (a.is_flat || b.is_flat)
            return {d.normal, d.lo - error};
        // lo holds along a direction that is the normal up to rounding: this is the normal's own.
        const double gap = extent_along(b.shape, pose_b, d.normal).least -
                           extent_along(a.shape, pose_a, d.normal).greatest;
        return {d.normal, gap - error};
    }
    bool overlap_at(double t) const {
        return within(a.shape, pose_at(a.motion, t), b.shape, pose_at(b.motion, t), -error)
                   .answer == Answer::yes;
    }
    /// How fast the gap along n may fall; the room is for rounding, of n too.
    double closing_speed(V n) const {
        return (a.speed(n) + b.speed(-n)) + 0x1p-40 * greatest_speed();
    }
    double greatest_speed() const { return a.greatest_speed() + b.greatest_speed(); }
};

/// An overlap soon after t, at steps of twice the length each; infinite if there is none.
double overlap_after(const Pair& pair, double t, double step, int& steps) {
    for (double s = step;; s *= 2) {
        const double at = std::min(t + s, 1.0);
        ++steps;
        if (pair.overlap_at(at))
            return at;
        if (at == 1)
            return inf;
    }
}

} // namespace

FirstContact first_contact(const Shape& shape_a, const Motion& motion_a, const Shape& shape_b,
                           const Motion& motion_b, double slack) {
    constexpr int max_steps = 1000;
    const Pair pair{{shape_a, motion_a}, {shape_b, motion_b}};
    if (!(slack > 0))
        slack = 0x1p-40 * pair.size;
    FirstContact found{Answer::maybe, 0, inf, 0};
    const auto spins = [](const Body& x) { return x.is_flat && x.motion.spin != V{}; };
    if (spins(pair.a) || spins(pair.b) || !(pair.size < inf))
        return found;
    if (pair.overlap_at(0))
        return {Answer::yes, 0, 0, 0};
    const auto look_behind = [&] {
        const double step = std::max(slack / pair.greatest_speed(), 0x1p-52);
        found.t_hit = std::min(found.t_hit, overlap_after(pair, found.t_free, step, found.steps));
        return found.t_hit <= found.t_free + 1024 * step;
    };
    while (found.steps < max_steps) {
        ++found.steps;
        const Gap g = pair.gap_at(found.t_free);
        if (!(g.gap > 0))
            break;
        const double speed = pair.closing_speed(g.normal);
        const double next = found.t_free + g.gap / speed * (1 - 0x1p-50);
        if (!(speed > 0) || next >= 1)
            return {Answer::no, 1, 1, found.steps};
        if (!(next > found.t_free))
            break;
        found.t_free = next;
        if (g.gap <= slack) {
            if (look_behind())
                break;
            slack *= 0x1p-10; // it was a near miss
        }
    }
    if (found.t_hit < inf || look_behind() || found.t_hit < inf)
        found.answer = Answer::yes;
    return found;
}

} // namespace boxwood::convex
