#include "bench/commands/queries/body_pair.h"

#include "kernels/convex/signed_distance.h"
#include "kernels/triangle_distance/certified.h"
#include "kernels/triangle_triangle/guigue_devillers_batch.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
#include <utility>

namespace boxwood::bench {
namespace {

using convex::ShapeKind;

Pose inverse(const Pose& pose) { return relative_pose(pose, Pose{}); }

ShapeKind kind_of_parts(const NamedBody& body) {
    return body.has_triangles() ? ShapeKind::triangle : body.shape.convex_shape().kind();
}

/// kernels/convex/signed_distance.h says which pairs have one.
bool has_closed_form(ShapeKind a, ShapeKind b) {
    const auto is_flat = [](ShapeKind k) {
        return k == ShapeKind::half_space || k == ShapeKind::plane;
    };
    const auto is_simple = [](ShapeKind k) {
        return k != ShapeKind::hull && k != ShapeKind::triangle;
    };
    return is_flat(a) || is_flat(b) || (a == ShapeKind::sphere && is_simple(b)) ||
           (b == ShapeKind::sphere && is_simple(a)) ||
           (a == ShapeKind::capsule && b == ShapeKind::capsule);
}

BodyShape exact(const NamedBody& body) { return body.box ? BodyShape(*body.box) : body.shape; }
double rounding_of(const NamedBody& body) { return body.box ? rounding_of_mesh(*body.box) : 0; }

std::uint32_t number(const NamedBody& body, std::uint32_t part) {
    return part < body.numbers.size() ? body.numbers[part] : part;
}

} // namespace

BodyPair::BodyPair(const std::string& a, const std::string& b, const BodyReading& how)
    : a_(read_body(a, is_surface_form(b), how)), b_(read_body(b, is_surface_form(a), how)),
      exact_a_(exact(a_)), exact_b_(exact(b_)), rounded_(rounding_of(a_) + rounding_of(b_)) {}

std::string_view BodyPair::touch_kernel() const {
    const bool has_radius = a_.shape.radius() + b_.shape.radius() > 0;
    return are_both_meshes() && rounded_ == 0 && !has_radius ? GuigueDevillersExactBatch::name
                                                             : distance_kernel();
}
std::string_view BodyPair::distance_kernel() const {
    if (are_both_meshes() && rounded_ == 0)
        return CertifiedDistance::name;
    const auto kind = [](const NamedBody& body) {
        return body.box ? ShapeKind::box : kind_of_parts(body);
    };
    return has_closed_form(kind(a_), kind(b_)) ? convex::closed_form_info.name
                                               : convex::gjk_epa_info.name;
}

bool BodyPair::are_solid() const {
    const auto is_solid = [](const NamedBody& body) {
        return body.shape.shape_class() != ShapeClass::surface;
    };
    return is_solid(a_) && is_solid(b_);
}

bool BodyPair::touch(const Pose& b_in_a) const {
    if (rounded_ > 0 && are_solid())
        return collide(PosedShape{exact_a_}, PosedShape{exact_b_, b_in_a}) != Answer::no;
    // Boxes whose corners are no floats come first, themselves, before their rounded ones.
    if (rounded_ > 0 && distance_of_exact(b_in_a).lo > 0)
        return false;
    if (collide(PosedShape{a_.shape}, PosedShape{b_.shape, b_in_a}) != Answer::no)
        return true;
    return rounded_ > 0 && distance(b_in_a).lo == 0;
}

std::vector<Pair> BodyPair::touching_parts(const Pose& b_in_a, std::size_t limit) const {
    std::vector<Pair> pairs;
    if (!a_.has_triangles() && !b_.has_triangles())
        return pairs;
    if (rounded_ > 0 && !touch(b_in_a))
        return pairs;
    if (are_both_meshes() && a_.shape.radius() + b_.shape.radius() == 0) {
        pairs = touching_triangles(a_.shape.tree(), b_.shape.tree(), b_in_a, limit);
        for (Pair& pair : pairs)
            pair = {number(a_, pair.a), number(b_, pair.b)};
    } else {
        for (const BodyContact& c : contacts(b_in_a, {.max_pairs = limit}))
            if (c.depth >= 0)
                pairs.push_back(c.parts);
    }
    std::ranges::sort(pairs);
    return pairs;
}

BodyDistance BodyPair::numbered(BodyDistance found) const {
    found.parts = {number(a_, found.parts.a), number(b_, found.parts.b)};
    return found;
}

BodyDistance BodyPair::distance_of(const BodyShape& a, const BodyShape& b, const Pose& b_in_a,
                                   const DistanceOptions& options) const {
    BodyDistance d = boxwood::distance(PosedShape{a}, PosedShape{b, b_in_a}, options);
    if (d.hi == 0)
        d.point_a = d.point_b = 0.5 * (d.point_a + d.point_b);
    return d;
}

BodyDistance BodyPair::distance_of_exact(const Pose& b_in_a, const DistanceOptions& options) const {
    return distance_of(exact_a_, exact_b_, b_in_a, options);
}

BodyDistance BodyPair::distance(const Pose& b_in_a, const DistanceOptions& options) const {
    BodyDistance d = numbered(distance_of(a_.shape, b_.shape, b_in_a, options));
    if (rounded_ == 0)
        return d;
    if (BodyDistance itself = distance_of_exact(b_in_a, options); itself.lo > 0 || are_solid()) {
        itself.parts = d.parts;
        return itself;
    }
    d.lo = std::max(0.0, d.lo - rounded_);
    d.hi += rounded_;
    return d;
}

MeshWithin BodyPair::within(const Pose& b_in_a, double tolerance) const {
    const bool has_radius = a_.shape.radius() + b_.shape.radius() > 0;
    const bool has_mesh = a_.has_triangles() || b_.has_triangles();
    MeshWithin near;
    if (!has_mesh || rounded_ > 0 || has_radius) {
        const BodyDistance d = distance(b_in_a);
        near = {d.lo <= tolerance, d.lo, d.hi};
    } else if (are_both_meshes()) {
        near = boxwood::within(a_.shape.tree(), b_.shape.tree(), b_in_a, tolerance);
    } else if (a_.has_triangles()) {
        near = boxwood::within(a_.shape.tree(), b_.shape.convex_shape(), b_in_a, tolerance);
    } else {
        near =
            boxwood::within(b_.shape.tree(), a_.shape.convex_shape(), inverse(b_in_a), tolerance);
    }
    const bool has_solid =
        a_.shape.shape_class() == ShapeClass::solid || b_.shape.shape_class() == ShapeClass::solid;
    if (!near.within && has_solid && touch(b_in_a))
        near = {true, 0, 0};
    return near;
}

std::vector<BodyContact> BodyPair::contacts(const Pose& b_in_a,
                                            const ContactOptions& options) const {
    if (rounded_ > 0 && !touch(b_in_a))
        return {};
    std::vector<BodyContact> found =
        boxwood::contacts(PosedShape{a_.shape}, PosedShape{b_.shape, b_in_a}, options);
    for (BodyContact& c : found)
        c.parts = {number(a_, c.parts.a), number(b_, c.parts.b)};
    return found;
}

FirstContact BodyPair::first_contact(const Path& a, const Path& b, MotionPath kind) const {
    // Boxes themselves, unless one begins in the other: then nothing is said of when they are free.
    const bool is_apart = rounded_ > 0 && distance_of_exact(relative_pose(a.from, b.from)).lo > 0;
    FirstContact found =
        boxwood::first_contact(MovingShape{is_apart ? exact_a_ : a_.shape, a.from, a.to, kind},
                               MovingShape{is_apart ? exact_b_ : b_.shape, b.from, b.to, kind});
    if (rounded_ > 0 && !is_apart)
        found.t_free = 0;
    return found;
}

} // namespace boxwood::bench
