#include "trees/world/bodies/detail/surface_pairs.h"

#include "kernels/arithmetic/rounding.h"
#include "kernels/convex/first_contact.h"
#include "trees/world/bodies/detail/swept_box.h"
#include "trees/world/detail/advance.h"
#include "trees/world/detail/straight_ways.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
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

/// The box of a shape in its frame. Of one without bounds, what of it the other one may meet: no
/// point of that is ever farther from its origin.
Aabb<float> box_of(const MovingShape& of, const Motion& motion, const MovingShape& other,
                   const Motion& other_motion) {
    if (of.shape.is_bounded())
        return round_outward(of.shape.bounds());
    if (!other.shape.is_bounded())
        return {{0, 0, 0}, {0, 0, 0}}; // neither turns
    const Aabb<float> box = round_outward(other.shape.bounds());
    const double reach = reach_of(box, relative_pose(other.from, of.from)) +
                         other_motion.longest_way(box) +
                         motion.longest_way({{0, 0, 0}, {0, 0, 0}}) + of.margin + other.margin +
                         other.shape.radius();
    const Vec3<double> far{reach, reach, reach};
    return round_outward(Aabb<double>{-far, far});
}

/// Conservative advancement on the distance between bounds, margins included.
FirstContact of_grown(const MovingShape& a, const MovingShape& b, const ContinuousOptions& options,
                      Work* work) {
    const Motion motion_a(a.from, a.to, a.path), motion_b(b.from, b.to, b.path);
    const Aabb<float> box_a = box_of(a, motion_a, b, motion_b),
                      box_b = box_of(b, motion_b, a, motion_a);
    const auto size = [](const MovingShape& of, const Aabb<float>& box) {
        return of.shape.is_bounded() ? size_of(box) : 0;
    };
    const Approach approach{relative_speed(motion_a, box_a, motion_b, box_b),
                            motion_a.longest_way(box_a) + motion_b.longest_way(box_b),
                            reach_of(box_a, a.from) + reach_of(box_b, b.from),
                            size(a, box_a) + size(b, box_b),
                            motion_a.longest_bend(box_a) + motion_b.longest_bend(box_b)};
    const auto distance_at = [&](double t, const DistanceOptions& near) -> MeshDistance {
        const BodyDistance d = distance(PosedShape{a.shape, motion_a.at(t), a.margin},
                                        PosedShape{b.shape, motion_b.at(t), b.margin}, near, work);
        return {d.distance, d.lo, d.hi, d.point_a, d.point_b, d.parts};
    };
    if (a.shape.shape_class() == ShapeClass::convex || b.shape.shape_class() == ShapeClass::convex)
        return advance(approach, options, distance_at);
    const MovingMeshes meshes{a.shape.tree(), motion_a, b.shape.tree(), motion_b,
                              margin_of({a.shape, a.from, a.margin}, {b.shape, b.from, b.margin})};
    return advance(approach, options, distance_at,
                   [&](const Stretch& stretch) { return free_stretch(meshes, stretch, work); });
}

/// Two half-spaces or planes of which one turns.
bool turn_without_bounds(const MovingShape& a, const MovingShape& b) {
    return !a.shape.is_bounded() && !b.shape.is_bounded() &&
           !(a.from.rotation == a.to.rotation && b.from.rotation == b.to.rotation);
}

} // namespace

FirstContact first_contact(const MovingShape& a, const MovingShape& b,
                           const ContinuousOptions& options, Work* work) {
    check(options);
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
    if (margin_of(start_a, start_b) == 0)
        return of_surfaces(a, b, options, work);
    if (!turn_without_bounds(a, b))
        return of_grown(a, b, options, work);
    found.hit = Answer::maybe;
    found.t_free = 0;
    return found;
}

} // namespace boxwood
