/// A mesh against a convex shape.
///
/// Depth first, the nearest box on top. A step opens a block: bounds of the distances of its eight
/// boxes to what the shape lies in (detail/shape_bounds.h); of a leaf, of its triangles. What is
/// left of those goes to the convex kernels, one by one, the nearest first. What is wanted is up to
/// a visitor: those that may touch, or those that may be the nearest.

#include "trees/world/mesh_shape.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/arithmetic/rounding.h"
#include "kernels/convex/shared_point.h"
#include "trees/world/detail/advance.h"
#include "trees/world/detail/entry_stack.h"
#include "trees/world/detail/nearest_candidates.h"
#include "trees/world/detail/shape_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace boxwood {
namespace {

using namespace detail;

/// a - b is a double, which d becomes.
bool is_exact_difference(double a, double b, double& d) {
    d = a - b;
    const double back = d - a; // the error of a sum, by Knuth
    return (a - (d - back)) - (b + back) == 0;
}

/// A triangle about its first corner, where the differences of corners are doubles (of floats they
/// nearly always are): the kernels' bounds are as wide as the sizes that they are given.
struct PlacedTriangle {
    convex::Triangle corners;
    Pose pose;

    explicit PlacedTriangle(const Triangle<double>& t) : corners(t) {
        convex::Triangle near;
        bool is_exact = true;
        for (int axis = 0; axis < 3; ++axis) {
            is_exact &= is_exact_difference(t.b[axis], t.a[axis], near.b[axis]);
            is_exact &= is_exact_difference(t.c[axis], t.a[axis], near.c[axis]);
        }
        if (is_exact) {
            corners = near;
            pose.translation = t.a;
        }
    }
};

/// A shape in the mesh's frame.
struct PlacedShape {
    const convex::Shape& shape;
    const Pose& pose;

    Answer touches(const PlacedTriangle& t) const {
        return convex::collide(t.corners, t.pose, shape, pose).answer;
    }
    convex::SignedDistance measure(const PlacedTriangle& t,
                                   const convex::Tolerance& tolerance = {}) const {
        return convex::signed_distance(t.corners, t.pose, shape, pose, tolerance);
    }
    Vec3<double> shared_point(const PlacedTriangle& t) const {
        return convex::shared_point(t.corners, t.pose, shape, pose);
    }
};

/// A block that waits, with a bound of its distance.
struct Waiting {
    double bound;
    std::uint32_t ref;
};

void put_nearest_last(Waiting* entries, std::size_t n) {
    for (std::size_t i = 1; i < n; ++i) {
        const Waiting x = entries[i];
        std::size_t k = i;
        for (; k > 0 && entries[k - 1].bound < x.bound; --k)
            entries[k] = entries[k - 1];
        entries[k] = x;
    }
}

void count_visit(Work* work, std::size_t stacked) {
    if (work) {
        ++work->node_visits;
        work->box_tests += 8;
        work->stack_max = std::max<std::uint64_t>(work->stack_max, stacked + 1);
    }
}

/// The triangles that the visitor wants by their bounds, the nearest first. True to end.
template <class Visitor>
bool visit_triangles(const TriangleLeaf& leaf, const Envelope& envelope, Visitor& visitor,
                     Work* work) {
    double bounds[8];
    bound_triangles(envelope, leaf, bounds);
    std::size_t order[8], n = 0;
    for (std::size_t lane = 0; lane < leaf.count; ++lane)
        if (visitor.wants(bounds[lane])) {
            std::size_t k = n++;
            for (; k > 0 && bounds[order[k - 1]] > bounds[lane]; --k)
                order[k] = order[k - 1];
            order[k] = lane;
        }
    for (std::size_t k = 0; k < n && visitor.wants(bounds[order[k]]); ++k) {
        const std::size_t lane = order[k];
        if (work)
            ++work->triangle_tests;
        if (visitor.take(leaf.triangle[lane], {leaf.corner_f64(0, lane), leaf.corner_f64(1, lane),
                                               leaf.corner_f64(2, lane)}))
            return true;
    }
    return false;
}

template <class Visitor>
void visit_nearest_first(const MeshTree& mesh, const Envelope& envelope, Visitor& visitor,
                         Work* work) {
    // Each step takes one and leaves up to eight.
    EntryStack<Waiting> stack(8 * (mesh.depth() + 1));
    stack.push({-std::numeric_limits<double>::infinity(), mesh.root()});
    while (!stack.empty()) {
        const Waiting open = stack.pop();
        if (!visitor.wants(open.bound))
            continue;
        count_visit(work, stack.size());
        if (is_leaf(open.ref)) {
            if (visit_triangles(mesh.leaf(open.ref), envelope, visitor, work))
                return;
            continue;
        }
        const ObbBlock& block = mesh.block(open.ref);
        double bounds[8];
        bound_boxes(envelope, block, bounds);
        const std::size_t first = stack.size();
        for (std::size_t lane = 0; lane < block.count; ++lane)
            if (visitor.wants(bounds[lane]))
                stack.push({bounds[lane], block.ref[lane]});
        put_nearest_last(stack.from(first), stack.size() - first);
    }
}

/// Whether a triangle touches: ends at the first that does for sure.
struct FirstTouch {
    PlacedShape shape;
    Answer answer = Answer::no;

    bool wants(double bound) const { return !(bound > 0); }
    bool take(std::uint32_t, const Triangle<double>& t) {
        const Answer found = shape.touches(PlacedTriangle(t));
        if (found != Answer::no)
            answer = found;
        return found == Answer::yes;
    }
};

/// All that touch or may, or are within a margin.
struct AllTouches {
    PlacedShape shape;
    std::size_t limit;
    double margin;
    std::vector<Contact> found{};

    bool wants(double bound) const { return !(bound > margin); }
    bool take(std::uint32_t i, const Triangle<double>& t) {
        const PlacedTriangle placed(t);
        const bool may_touch = shape.touches(placed) != Answer::no;
        if (!may_touch && margin == 0)
            return false;
        const convex::SignedDistance d = shape.measure(placed);
        if (!may_touch && d.lo > margin)
            return false;
        found.push_back({0.5 * (d.point_a + d.point_b),
                         d.normal,
                         may_touch ? std::max(0.0, d.depth()) : -d.distance,
                         {i, 0}});
        return found.size() >= limit;
    }
};

/// The nearest triangle. Each is measured roughly, and again, as finely as is wanted, if it may be
/// the nearest. The truth is at least `least_lo`, or `wanted` where something was left out.
class NearestTriangle {
  public:
    NearestTriangle(const PlacedShape& shape, const DistanceGoal& goal)
        : shape_(shape), goal_(goal), wanted_(goal.options.limit) {
        const DistanceOptions& o = goal.options;
        fine_ = {std::max(0x1p-36, o.relative / 2), o.absolute / 2};
        rough_ = {std::max(0x1p-8, fine_.relative), fine_.absolute};
    }

    bool wants(double bound) const { return !(bound > 0) || bound < wanted_; }
    bool take(std::uint32_t i, const Triangle<double>& t) {
        if (!wants(gap_along_normal(t)))
            return false;
        const PlacedTriangle placed(t);
        convex::SignedDistance d = shape_.measure(placed, rough_);
        if (d.lo > 0 && d.lo < wanted_ && d.hi > goal_.stop_at &&
            d.hi - d.lo > fine_.relative * d.hi + fine_.absolute)
            d = shape_.measure(placed, fine_);
        if (!wants(d.lo))
            return false;
        least_lo_ = std::min(least_lo_, std::max(d.lo, 0.0));
        if (d.hi <= 0) {
            const Vec3<double> p = shape_.shared_point(placed);
            best_ = {0, 0, 0, p, p, {i, 0}};
            least_lo_ = wanted_ = 0;
            return true;
        }
        if (d.hi < best_.hi) {
            const DistanceOptions& o = goal_.options;
            best_ = {d.distance, d.lo, d.hi, d.point_a, d.point_b, {i, 0}};
            normal_ = d.normal;
            shape_begins_ = convex::extent_along(shape_.shape, shape_.pose, normal_).least;
            // What is beyond the best one's own lo cannot make the answer's less.
            wanted_ =
                std::max(0.0, std::min({wanted_, d.lo, d.hi * (1 - o.relative) - o.absolute}));
        }
        if (d.hi > goal_.stop_at)
            return false;
        least_lo_ = 0; // nearer ones may not have been looked at
        return true;
    }
    MeshDistance answer() const {
        MeshDistance nearest = best_;
        nearest.lo = std::min({least_lo_, wanted_, best_.hi});
        nearest.distance = std::clamp(nearest.distance, nearest.lo, nearest.hi);
        return nearest;
    }

  private:
    /// A bound of the distance: the gap along the normal of the best so far. A height is off by 4u
    /// of the corner's |coordinates|, and the normal is of length 1 to 2^-40.
    double gap_along_normal(const Triangle<double>& t) const {
        double high = -std::numeric_limits<double>::infinity(), size = std::abs(shape_begins_);
        for (const Vec3<double>& p : {t.a, t.b, t.c}) {
            high = std::max(high, dot(normal_, p));
            size = std::max(size, std::abs(p.x) + std::abs(p.y) + std::abs(p.z));
        }
        return (shape_begins_ - high) * (1 - 0x1p-40) - 0x1p-49 * size;
    }

    PlacedShape shape_;
    DistanceGoal goal_;
    convex::Tolerance rough_, fine_;
    Vec3<double> normal_{}; ///< from the nearest triangle so far to the shape
    double shape_begins_ = -std::numeric_limits<double>::infinity(); ///< along the normal
    double wanted_; ///< what is nearer is looked for
    double least_lo_ = std::numeric_limits<double>::infinity();
    MeshDistance best_;
};

MeshDistance search(const MeshTree& mesh, const convex::Shape& shape, const Pose& pose,
                    const DistanceGoal& goal, Work* work) {
    return without_flushing([&]() -> MeshDistance {
        const Envelope envelope(shape, pose);
        if (mesh.empty())
            return {};
        NearestTriangle nearest({shape, pose}, goal);
        if (const auto& start = goal.options.start) {
            if (start->a >= mesh.size() || start->b != 0)
                throw std::invalid_argument("the triangle to start with is not there");
            if (nearest.take(start->a, mesh.triangle(start->a, Pose{})))
                return nearest.answer();
        }
        visit_nearest_first(mesh, envelope, nearest, work);
        return nearest.answer();
    });
}

/// The box of a shape in its own frame. Of one without an end, what of it may meet the mesh: no
/// point of the mesh is farther than `reach` from its origin.
Aabb<float> box_of(const convex::Shape& shape, double reach) {
    const Aabb<double> box = convex::bounds(shape, Pose{});
    const Aabb<double> all{{-reach, -reach, -reach}, {reach, reach, reach}};
    return round_outward(is_finite(box.min) && is_finite(box.max) ? box : all);
}

} // namespace

Decision collide(const MeshTree& mesh, const convex::Shape& shape, const Pose& shape_in_mesh,
                 Work* work) {
    return without_flushing([&]() -> Decision {
        const Envelope envelope(shape, shape_in_mesh);
        FirstTouch touch{{shape, shape_in_mesh}};
        if (!mesh.empty())
            visit_nearest_first(mesh, envelope, touch, work);
        if (work && touch.answer == Answer::yes)
            ++work->answers;
        return {touch.answer, 0};
    });
}

MeshDistance distance(const MeshTree& mesh, const convex::Shape& shape, const Pose& shape_in_mesh,
                      const DistanceOptions& options, Work* work) {
    return search(mesh, shape, shape_in_mesh, goal_of(options), work);
}

MeshWithin within(const MeshTree& mesh, const convex::Shape& shape, const Pose& shape_in_mesh,
                  double tolerance, Work* work) {
    return without_flushing([&] {
        return within_by(search(mesh, shape, shape_in_mesh, goal_within(tolerance), work),
                         tolerance);
    });
}

std::vector<Contact> contacts(const MeshTree& mesh, const convex::Shape& shape,
                              const Pose& shape_in_mesh, const ContactOptions& options,
                              Work* work) {
    check(options);
    AllTouches touches{{shape, shape_in_mesh}, options.max_pairs, options.margin};
    without_flushing([&] {
        const Envelope envelope(shape, shape_in_mesh);
        if (!mesh.empty() && options.max_pairs > 0)
            visit_nearest_first(mesh, envelope, touches, work);
    });
    if (work)
        work->answers += touches.found.size();
    return deepest_first(std::move(touches.found), options);
}

FirstContact first_contact(const MeshTree& mesh, const Motion& motion, const convex::Shape& shape,
                           const Motion& shape_motion, const ContinuousOptions& options,
                           Work* work) {
    check(options);
    if (mesh.empty())
        return {};
    // The origin of a shape without an end, and how far from it the mesh ever is: what of the shape
    // is farther does not matter, and what is nearer is no faster than that box.
    const double way = motion.longest_way(mesh.bounds());
    const double origin_way = shape_motion.longest_way({{0, 0, 0}, {0, 0, 0}});
    const Pose start = relative_pose(motion.at(0), shape_motion.at(0));
    const Aabb<float> box =
        box_of(shape, (reach_of(mesh.bounds(), start) + way + origin_way) * (1 + 0x1p-20));
    const bool is_flat = Envelope(shape, start).is_flat();
    const Approach approach{relative_speed(motion, mesh.bounds(), shape_motion, box),
                            way + shape_motion.longest_way(box),
                            reach_of(mesh.bounds(), motion.at(0)) +
                                reach_of(box, shape_motion.at(0)),
                            size_of(mesh.bounds()) + (is_flat ? 0 : size_of(box))};
    return advance(approach, options, [&](double t, const DistanceOptions& near) {
        return distance(mesh, shape, relative_pose(motion.at(t), shape_motion.at(t)), near, work);
    });
}

} // namespace boxwood
