#include "bench/commands/queries/body_pair.h"

#include "bench/commands/queries/bodies.h"
#include "kernels/convex/contact.h"
#include "kernels/convex/first_contact.h"
#include "kernels/triangle_distance/certified.h"
#include "kernels/triangle_triangle/guigue_devillers_batch.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace boxwood::bench {
namespace {

using convex::Shape;

bool is_round(const std::string& text) {
    const std::optional<Shape> primitive = read_primitive(text);
    return primitive && primitive->kind() != convex::ShapeKind::box;
}

Pose inverse(const Pose& pose) { return relative_pose(pose, Pose{}); }

/// Whether both cores are points or segments, or one is a point: kernels/convex/signed_distance.h.
bool has_closed_form(const Shape& a, const Shape& b) {
    const auto is = [](const Shape& s, convex::ShapeKind kind) { return s.kind() == kind; };
    return is(a, convex::ShapeKind::sphere) || is(b, convex::ShapeKind::sphere) ||
           (is(a, convex::ShapeKind::capsule) && is(b, convex::ShapeKind::capsule));
}

/// The box that is a mesh here, if it is one.
std::optional<Shape> box_of(const std::string& text, bool is_mesh) {
    const std::optional<Shape> primitive = is_mesh ? read_primitive(text) : std::nullopt;
    return primitive && primitive->kind() == convex::ShapeKind::box ? primitive : std::nullopt;
}

/// What was found of B and A, in B's frame, as of A and B, in A's.
MeshDistance swapped(MeshDistance d, const Pose& b_in_a) {
    std::swap(d.point_a, d.point_b);
    d.point_a = b_in_a(d.point_a);
    d.point_b = b_in_a(d.point_b);
    std::swap(d.triangles.a, d.triangles.b);
    return d;
}

MeshDistance distance_of_shapes(const Shape& a, const Shape& b, const Pose& b_in_a) {
    const convex::SignedDistance d = convex::signed_distance(a, Pose{}, b, b_in_a);
    MeshDistance found{std::max(0.0, d.distance), std::max(0.0, d.lo), std::max(0.0, d.hi),
                       d.point_a, d.point_b};
    if (found.hi == 0)
        found.point_a = found.point_b = 0.5 * (d.point_a + d.point_b);
    return found;
}

FirstContact first_contact_of_shapes(const Shape& a, const BodyPair::Path& path_a, const Shape& b,
                                     const BodyPair::Path& path_b, MotionPath kind) {
    const auto motion = [&](const BodyPair::Path& path) {
        return kind == MotionPath::screw ? convex::screw_motion(path.from, path.to)
                                         : convex::linear_motion(path.from, path.to);
    };
    const convex::FirstContact first = convex::first_contact(a, motion(path_a), b, motion(path_b));
    FirstContact found;
    found.hit = first.answer;
    found.t_free = first.t_free;
    found.t_hit = std::isfinite(first.t_hit) ? first.t_hit : 1;
    return found;
}

Contact turned(Contact c, const Pose& b_in_a) {
    c.point = b_in_a(c.point);
    const Vec3<double> n = c.normal; // from B to A
    for (std::size_t k = 0; k < 3; ++k)
        c.normal[static_cast<int>(k)] = -dot(b_in_a.rotation[k], n);
    std::swap(c.triangles.a, c.triangles.b);
    return c;
}

} // namespace

BodyPair::BodyPair(const std::string& a, const std::string& b, bool solid)
    : a_(read(a, is_round(b), solid)), b_(read(b, is_round(a), solid)), box_a_(box_of(a, mesh(a_))),
      box_b_(box_of(b, mesh(b_))), rounded_((box_a_ ? rounding_of_mesh(*box_a_) : 0) +
                                            (box_b_ ? rounding_of_mesh(*box_b_) : 0)) {}

BodyPair::Body BodyPair::read(const std::string& text, bool beside_round, bool solid) {
    if (const std::optional<Shape> primitive = read_primitive(text))
        if (beside_round || primitive->kind() != convex::ShapeKind::box)
            return *primitive;
    return named(text, [&]() -> Body {
        if (solid)
            return Solid(read_body(text));
        return MeshTree(read_body(text));
    });
}

const MeshTree* BodyPair::mesh(const Body& body) {
    if (const auto* solid = std::get_if<Solid>(&body))
        return &solid->surface();
    return std::get_if<MeshTree>(&body);
}

std::string_view BodyPair::touch_kernel() const {
    if (mesh(a_) && mesh(b_) && rounded_ == 0)
        return GuigueDevillersExactBatch::name;
    return distance_kernel();
}
std::string_view BodyPair::distance_kernel() const {
    if (mesh(a_) && mesh(b_) && rounded_ == 0)
        return CertifiedDistance::name;
    const bool closed =
        !mesh(a_) && !mesh(b_) && has_closed_form(std::get<Shape>(a_), std::get<Shape>(b_));
    return closed ? convex::closed_form_info.name : convex::gjk_epa_info.name;
}

/// Each body as what it is; a Solid beside a MeshTree does not come about.
bool BodyPair::touch(const Pose& b_in_a) const {
    const auto may_touch = [](Decision d) { return d.answer != Answer::no; };
    const auto* shape_a = std::get_if<Shape>(&a_);
    const auto* shape_b = std::get_if<Shape>(&b_);
    const auto* solid_a = std::get_if<Solid>(&a_);
    const auto* solid_b = std::get_if<Solid>(&b_);
    if (shape_a && shape_b)
        return may_touch(convex::collide(*shape_a, Pose{}, *shape_b, b_in_a));
    if (shape_b)
        return may_touch(solid_a ? collide(*solid_a, *shape_b, b_in_a)
                                 : collide(*mesh(a_), *shape_b, b_in_a));
    if (shape_a)
        return may_touch(solid_b ? collide(*solid_b, *shape_a, inverse(b_in_a))
                                 : collide(*mesh(b_), *shape_a, inverse(b_in_a)));
    // Boxes whose corners are no floats are asked themselves, before their rounded ones.
    if (rounded_ > 0 && distance_of_solid_boxes(b_in_a).lo > 0)
        return false;
    if (solid_a && solid_b ? collide(*solid_a, *solid_b, b_in_a)
                           : collide(*mesh(a_), *mesh(b_), b_in_a))
        return true;
    return rounded_ > 0 && distance_of_meshes(b_in_a).lo == 0;
}

std::vector<Pair> BodyPair::touching_triangles(const Pose& b_in_a, std::size_t limit) const {
    std::vector<Pair> pairs;
    if (rounded_ > 0 && !touch(b_in_a))
        return pairs;
    if (mesh(a_) && mesh(b_))
        pairs = boxwood::touching_triangles(*mesh(a_), *mesh(b_), b_in_a, limit);
    else if (mesh(a_) || mesh(b_))
        for (const Contact& c : contacts(b_in_a, {.max_pairs = limit}))
            pairs.push_back(c.triangles);
    std::ranges::sort(pairs);
    return pairs;
}

MeshDistance BodyPair::distance(const Pose& b_in_a) const {
    MeshDistance d = distance_of_surfaces(b_in_a);
    if (d.lo > 0 && !is_certainly_apart(b_in_a))
        d.distance = d.lo = d.hi = 0;
    return d;
}

MeshDistance BodyPair::distance_of_surfaces(const Pose& b_in_a) const {
    const MeshTree *mesh_a = mesh(a_), *mesh_b = mesh(b_);
    if (!mesh_a && !mesh_b)
        return distance_of_shapes(std::get<Shape>(a_), std::get<Shape>(b_), b_in_a);
    MeshDistance d;
    if (mesh_a && mesh_b)
        d = distance_of_meshes(b_in_a);
    else if (mesh_a)
        d = boxwood::distance(*mesh_a, std::get<Shape>(b_), b_in_a);
    else
        d = swapped(boxwood::distance(*mesh_b, std::get<Shape>(a_), inverse(b_in_a)), b_in_a);
    if (!mesh_a)
        d.triangles.a = no_triangle;
    if (!mesh_b)
        d.triangles.b = no_triangle;
    return d;
}

/// Of the boxes themselves, as solids, of which one is there at least.
MeshDistance BodyPair::distance_of_solid_boxes(const Pose& b_in_a) const {
    if (box_a_ && box_b_)
        return distance_of_shapes(*box_a_, *box_b_, b_in_a);
    return box_b_ ? boxwood::distance(*mesh(a_), *box_b_, b_in_a)
                  : swapped(boxwood::distance(*mesh(b_), *box_a_, inverse(b_in_a)), b_in_a);
}

/// Where solids are apart, so far apart are their surfaces.
MeshDistance BodyPair::distance_of_meshes(const Pose& b_in_a) const {
    MeshDistance d = boxwood::distance(*mesh(a_), *mesh(b_), b_in_a);
    if (rounded_ == 0)
        return d;
    if (MeshDistance solids = distance_of_solid_boxes(b_in_a); solids.lo > 0) {
        solids.triangles = d.triangles;
        return solids;
    }
    d.lo = std::max(0.0, d.lo - rounded_);
    d.hi += rounded_;
    return d;
}

/// Of bodies whose surfaces are apart.
bool BodyPair::is_certainly_apart(const Pose& b_in_a) const {
    const bool has_solid = std::holds_alternative<Solid>(a_) || std::holds_alternative<Solid>(b_);
    return !has_solid || !touch(b_in_a);
}

MeshWithin BodyPair::within(const Pose& b_in_a, double tolerance) const {
    const MeshTree *mesh_a = mesh(a_), *mesh_b = mesh(b_);
    MeshWithin near;
    if ((!mesh_a && !mesh_b) || rounded_ > 0) {
        const MeshDistance d = distance(b_in_a);
        near = {d.lo <= tolerance, d.lo, d.hi};
    } else if (mesh_a && mesh_b) {
        near = boxwood::within(*mesh_a, *mesh_b, b_in_a, tolerance);
    } else if (mesh_a) {
        near = boxwood::within(*mesh_a, std::get<Shape>(b_), b_in_a, tolerance);
    } else {
        near = boxwood::within(*mesh_b, std::get<Shape>(a_), inverse(b_in_a), tolerance);
    }
    if (!near.within && !is_certainly_apart(b_in_a))
        near = {true, 0, 0};
    return near;
}

std::vector<Contact> BodyPair::contacts(const Pose& b_in_a, const ContactOptions& options) const {
    if (rounded_ > 0 && !touch(b_in_a))
        return {};
    std::vector<Contact> found = contacts_of_surfaces(b_in_a, options);
    if (!found.empty() || options.max_pairs == 0 || is_certainly_apart(b_in_a))
        return found;
    const MeshDistance d = distance_of_surfaces(b_in_a);
    const Vec3<double> out = d.point_a - d.point_b;
    const double size = length(out);
    const Vec3<double> normal = size > 0 ? (1 / size) * out : Vec3<double>{0, 0, 1};
    return {{0.5 * (d.point_a + d.point_b), normal, d.distance, d.triangles}};
}

std::vector<Contact> BodyPair::contacts_of_surfaces(const Pose& b_in_a,
                                                    const ContactOptions& options) const {
    const MeshTree *mesh_a = mesh(a_), *mesh_b = mesh(b_);
    std::vector<Contact> found;
    if (mesh_a && mesh_b)
        return boxwood::contacts(*mesh_a, *mesh_b, b_in_a, options);
    if (mesh_a) {
        found = boxwood::contacts(*mesh_a, std::get<Shape>(b_), b_in_a, options);
    } else if (mesh_b) {
        for (const Contact& c :
             boxwood::contacts(*mesh_b, std::get<Shape>(a_), inverse(b_in_a), options))
            found.push_back(turned(c, b_in_a));
    } else {
        const convex::Contacts all =
            convex::contacts(std::get<Shape>(a_), Pose{}, std::get<Shape>(b_), b_in_a);
        const std::size_t count = std::min(
            {static_cast<std::size_t>(all.count), options.max_pairs, options.max_contacts});
        for (std::size_t i = 0; i < count; ++i) {
            const convex::ContactPoint& c = all.points[i];
            found.push_back({c.point, all.distance.normal, c.depth, {}});
        }
    }
    for (Contact& c : found) {
        if (!mesh_a)
            c.triangles.a = no_triangle;
        if (!mesh_b)
            c.triangles.b = no_triangle;
    }
    return found;
}

FirstContact BodyPair::first_contact(const Path& a, const Path& b, MotionPath kind) const {
    const auto* shape_a = std::get_if<Shape>(&a_);
    const auto* shape_b = std::get_if<Shape>(&b_);
    const Pose start = relative_pose(a.from, b.from);
    // Boxes themselves, unless one begins in the other: then nothing is said of when they are free.
    const bool is_rounded = rounded_ > 0;
    if (is_rounded && distance_of_solid_boxes(start).lo > 0) {
        shape_a = box_a_ ? &*box_a_ : nullptr;
        shape_b = box_b_ ? &*box_b_ : nullptr;
    }
    if (shape_a && shape_b)
        return first_contact_of_shapes(*shape_a, a, *shape_b, b, kind);
    const Motion motion_a(a.from, a.to, kind), motion_b(b.from, b.to, kind);
    if (shape_b)
        return boxwood::first_contact(*mesh(a_), motion_a, *shape_b, motion_b);
    if (shape_a)
        return boxwood::first_contact(*mesh(b_), motion_b, *shape_a, motion_a);
    FirstContact found = boxwood::first_contact(*mesh(a_), motion_a, *mesh(b_), motion_b);
    if (is_rounded)
        found.t_free = 0;
    return found;
}

} // namespace boxwood::bench
