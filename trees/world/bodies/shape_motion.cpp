#include "trees/world/bodies/detail/surface_pairs.h"

#include "kernels/arithmetic/rounding.h"
#include "kernels/convex/first_contact.h"
#include "trees/world/bodies/detail/swept_box.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace boxwood {
namespace {

using namespace detail;

FirstContact of_convex(const convex::FirstContact& found) {
    FirstContact contact;
    contact.hit = found.answer;
    contact.t_free = std::min(found.t_free, 1.0);
    contact.t_hit = std::min(found.t_hit, 1.0);
    contact.steps = static_cast<std::size_t>(found.steps);
    return contact;
}

/// Without margins, and of those that are apart at the start: by what they are.
FirstContact of_surfaces(const MovingShape& a, const MovingShape& b,
                         const ContinuousOptions& options, Work* work) {
    const bool convex_a = a.shape.shape_class() == ShapeClass::convex,
               convex_b = b.shape.shape_class() == ShapeClass::convex;
    if (convex_a && convex_b)
        return of_convex(convex::first_contact(a.shape.convex_shape(), convex_motion(a),
                                               b.shape.convex_shape(), convex_motion(b),
                                               options.tolerance));
    if (convex_a) {
        FirstContact found = of_surfaces(b, a, options, work);
        std::swap(found.triangles.a, found.triangles.b);
        return found;
    }
    const Motion motion_a(a.from, a.to, a.path), motion_b(b.from, b.to, b.path);
    const MeshTree& mesh = a.shape.tree();
    if (!convex_b)
        return first_contact(mesh, motion_a, b.shape.tree(), motion_b, options, work);
    FirstContact found =
        first_contact(mesh, motion_a, b.shape.convex_shape(), motion_b, options, work);
    found.triangles.b = ~0u;
    return found;
}

/// One of two that approach each other.
struct Approaching {
    explicit Approaching(const MovingShape& of)
        : shape(of.shape), margin(of.margin), motion(of.from, of.to, of.path) {
        const Vec3<double>& t = of.from.translation;
        reach = std::abs(t.x) + std::abs(t.y) + std::abs(t.z);
        if (shape.is_bounded()) {
            speed = motion.longest_way(round_outward(shape.bounds()));
            const auto& [low, high] = shape.bounds();
            size = length(high - low);
            const Vec3<double> far = max(-low, high);
            reach += std::abs(far.x) + std::abs(far.y) + std::abs(far.z);
        } else {
            speed = length(of.to.translation - of.from.translation) * (1 + 0x1p-40);
        }
    }
    PosedShape at(double t) const { return {shape, motion.at(t), margin}; }

    const BodyShape& shape;
    double margin;
    Motion motion;
    double speed = 0, size = 0, reach = 0;
};

/// Conservative advancement on the distance between bounds, as that of two meshes (continuous.h),
/// margins included.
FirstContact advance(const Approaching& a, const Approaching& b, const ContinuousOptions& options,
                     Work* work) {
    const double speed = a.speed + b.speed;
    const double rounding = 0x1p-44 * (speed + a.reach + b.reach);
    const double tolerance = std::max(
        options.tolerance > 0 ? options.tolerance : 0x1p-36 * (a.size + b.size), 4 * rounding);
    FirstContact found;
    DistanceOptions near;
    double t = 0;
    while (found.steps < options.max_steps) {
        const BodyDistance d = distance(a.at(t), b.at(t), near, work);
        ++found.steps;
        if (d.lo <= tolerance && d.hi > tolerance && near.relative > 0) {
            near.relative = 0; // look again
            continue;
        }
        if (d.hi <= tolerance || d.lo <= 2 * rounding) {
            found.hit = Answer::yes;
            found.t_free = found.t_hit = t;
            found.triangles = d.parts;
            return found;
        }
        if (t >= 1)
            return found;
        const double free = std::max(d.lo - 2 * rounding, 0.0);
        t = std::min(1.0, t + (speed > 0 ? free / speed * (1 - 0x1p-40) : 1));
        found.t_free = t;
        if (d.parts.a != ~0u && d.parts.b != ~0u)
            near.start = d.parts;
        // Far apart a rough distance will do.
        near.relative = d.lo > 64 * tolerance ? .1 : 0;
    }
    found.hit = Answer::maybe;
    found.t_free = t;
    return found;
}

bool turns_without_bounds(const MovingShape& of) {
    return !of.shape.is_bounded() && !(of.from.rotation == of.to.rotation);
}

} // namespace

FirstContact first_contact(const MovingShape& a, const MovingShape& b,
                           const ContinuousOptions& options, Work* work) {
    if (!(options.tolerance >= 0))
        throw std::invalid_argument("a tolerance must be at least 0");
    FirstContact found;
    if (a.shape.empty() || b.shape.empty())
        return found;
    const PosedShape start_a{a.shape, a.from, a.margin}, start_b{b.shape, b.from, b.margin};
    found.hit = inside(start_a, start_b).answer;
    if (found.hit != Answer::no) {
        found.t_free = 0;
        found.t_hit = found.hit == Answer::yes ? 0 : 1;
        return found;
    }
    if (turns_without_bounds(a) || turns_without_bounds(b)) {
        found.hit = Answer::maybe;
        found.t_free = 0;
        return found;
    }
    if (margin_of(start_a, start_b) > 0)
        return advance(Approaching(a), Approaching(b), options, work);
    return of_surfaces(a, b, options, work);
}

} // namespace boxwood
