#include "trees/world/bodies/shape_pairs.h"

#include "kernels/convex/contact.h"
#include "kernels/convex/signed_distance.h"
#include "trees/world/bodies/detail/surface_pairs.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace boxwood {
namespace {

using namespace detail;

constexpr std::uint32_t none = ~0u;
/// Of parts that only a margin makes meet: with a wide one that may be each with each.
constexpr std::size_t max_near_pairs = std::size_t{1} << 16;

/// x - margin as doubles below and above it, at least 0. A difference rounds once.
double below(double x, double margin) {
    return margin > 0 ? std::max(0.0, (x - margin) * (1 - 0x1p-51)) : x;
}
double above(double x, double margin) {
    return margin > 0 ? std::max(0.0, (x - margin) * (1 + 0x1p-51)) : x;
}

BodyDistance grown(BodyDistance d, double margin) {
    d.lo = below(d.lo, margin);
    d.hi = above(d.hi, margin);
    d.distance = std::clamp(d.distance - margin, d.lo, d.hi);
    return d;
}

Vec3<double> turned(const Pose& pose, const Vec3<double>& v) {
    return {dot(pose.rotation[0], v), dot(pose.rotation[1], v), dot(pose.rotation[2], v)};
}

BodyContact posed(const Contact& contact, const Pose& pose, double margin) {
    return {{},
            pose(contact.point),
            turned(pose, contact.normal),
            contact.depth + margin,
            contact.triangles};
}

/// Those of surfaces that are at most `reach` apart, at 0 of those that touch; of convex shapes
/// also those that are near enough for the margin.
std::vector<BodyContact> within_reach(const PosedShape& a, const PosedShape& b, double margin,
                                      double reach, const ContactOptions& options, Work* work) {
    std::vector<BodyContact> found;
    if (a.shape.empty() || b.shape.empty())
        return found;
    if (is_convex(a) && is_convex(b)) {
        const convex::Contacts all = convex::contacts(a.shape.convex_shape(), a.pose,
                                                      b.shape.convex_shape(), b.pose, margin);
        const auto count =
            std::min<std::size_t>(static_cast<std::size_t>(all.count), options.max_contacts);
        for (std::size_t i = 0; i < count; ++i)
            found.push_back({{},
                             all.points[i].point,
                             all.distance.normal,
                             all.points[i].depth + margin,
                             {none, none}});
        return found;
    }
    if (is_convex(a)) {
        found = within_reach(b, a, margin, reach, options, work);
        for (BodyContact& contact : found) {
            contact.normal = -contact.normal;
            std::swap(contact.parts.a, contact.parts.b);
        }
        return found;
    }
    const MeshTree& mesh = a.shape.tree();
    const Pose b_in_a = relative_pose(a.pose, b.pose);
    ContactOptions near = options;
    near.margin = reach;
    const std::vector<Contact> all =
        is_convex(b) ? contacts(mesh, b.shape.convex_shape(), b_in_a, near, work)
                     : contacts(mesh, b.shape.tree(), b_in_a, near, work);
    for (const Contact& contact : all) {
        found.push_back(posed(contact, a.pose, margin));
        if (is_convex(b))
            found.back().parts.b = none;
    }
    return found;
}

/// Between the nearest points of two surfaces; sign: 1 where they are to be kept apart, -1 where
/// one is within the other.
BodyContact between(const BodyDistance& d, double sign, double margin) {
    BodyContact contact;
    contact.point = 0.5 * (d.point_a + d.point_b);
    const Vec3<double> apart = sign * (d.point_b - d.point_a);
    if (const double size = length(apart); size > 0)
        contact.normal = (1 / size) * apart;
    contact.depth = margin - sign * d.distance;
    contact.parts = d.parts;
    return contact;
}

} // namespace

Answer within(const PosedShape& a, const PosedShape& b, double tolerance, Work* work) {
    if (!(tolerance >= 0))
        throw std::invalid_argument("a tolerance must be at least 0");
    const Answer near = surfaces_within(a, b, margin_of(a, b) + tolerance, work);
    if (near == Answer::yes)
        return near;
    const Answer in = inside(a, b).answer;
    return in == Answer::no ? near : in;
}

Answer collide(const PosedShape& a, const PosedShape& b, Work* work) {
    return within(a, b, 0, work);
}

BodyDistance distance(const PosedShape& a, const PosedShape& b, const DistanceOptions& options,
                      Work* work) {
    const double margin = margin_of(a, b);
    DistanceOptions of_surfaces = options;
    of_surfaces.limit = (options.limit + margin) * (1 + 0x1p-51);
    BodyDistance found = surface_distance(a, b, of_surfaces, work);
    const Inside in = found.lo > 0 ? inside(a, b) : Inside{};
    if (in.answer == Answer::yes)
        return {{}, 0, 0, 0, in.point, in.point, {none, none}};
    if (in.answer == Answer::maybe) {
        if (!found.found())
            found = surface_distance(a, b, {}, work);
        found.lo = found.distance = 0;
    }
    if (!found.found())
        return {.lo = std::max(options.limit, found.lo - margin)};
    return grown(found, margin);
}

BodyDistance signed_distance(const PosedShape& a, const PosedShape& b, double tolerance,
                             Work* work) {
    if (!(tolerance >= 0))
        throw std::invalid_argument("a tolerance must be at least 0");
    for (const PosedShape* of : {&a, &b})
        if (of->shape.shape_class() == ShapeClass::surface)
            throw std::invalid_argument(
                "a signed distance is that of solids (BodyShape::solid) and "
                "convex shapes: a surface has no inside");
    if (is_convex(a) && !is_convex(b)) {
        BodyDistance found = signed_distance(b, a, tolerance, work);
        std::swap(found.point_a, found.point_b);
        return found;
    }
    const double margin = margin_of(a, b);
    const auto less_margin = [&](double x, double way) { // rounded that way
        return margin > 0 && std::isfinite(x)
                   ? (x - margin) + way * 0x1p-51 * (std::abs(x) + margin)
                   : x;
    };
    const auto grown_by_margin = [&](double distance, double lo, double hi) {
        BodyDistance found;
        found.lo = less_margin(lo, -1);
        found.hi = less_margin(hi, 1);
        found.distance = std::clamp(less_margin(distance, 0), found.lo, found.hi);
        return found;
    };
    if (is_convex(a)) {
        const convex::SignedDistance d =
            convex::signed_distance(a.shape.convex_shape(), a.pose, b.shape.convex_shape(), b.pose);
        BodyDistance found = grown_by_margin(d.distance, d.lo, d.hi);
        found.point_a = d.point_a;
        found.point_b = d.point_b;
        return found;
    }
    const Pose b_in_a = relative_pose(a.pose, b.pose);
    const SolidDistance d =
        is_convex(b)
            ? signed_distance(a.shape.solid(), b.shape.convex_shape(), b_in_a, tolerance, work)
            : signed_distance(a.shape.solid(), b.shape.solid(), b_in_a, tolerance, work);
    BodyDistance found = grown_by_margin(d.distance, d.lo, d.hi);
    found.point_a = a.pose(d.point_a);
    found.point_b = a.pose(d.point_b);
    return found;
}

std::vector<BodyContact> contacts(const PosedShape& a, const PosedShape& b,
                                  const ContactOptions& options, Work* work) {
    const double margin = margin_of(a, b);
    std::vector<BodyContact> found = within_reach(a, b, margin, 0, options, work);
    if (!found.empty() || options.max_contacts == 0 || options.max_pairs == 0)
        return found;
    if (inside(a, b).answer == Answer::yes)
        return {between(surface_distance(a, b, {}, work), -1, margin)};
    if (!(margin > 0))
        return found;
    if (!is_convex(a) || !is_convex(b)) {
        ContactOptions some = options;
        some.max_pairs = std::min(options.max_pairs, max_near_pairs);
        found = within_reach(a, b, margin, margin, some, work);
    }
    DistanceOptions near; // the nearest, which may not be among so many
    near.limit = margin * (1 + 0x1p-30);
    const BodyDistance d = surface_distance(a, b, near, work);
    if (!d.found() || d.lo > margin)
        return found;
    const BodyContact nearest = between(d, 1, margin);
    if (found.empty() ||
        (nearest.depth > found.front().depth &&
         std::ranges::find(found, nearest.parts, &BodyContact::parts) == found.end())) {
        found.insert(found.begin(), nearest);
        if (found.size() > options.max_contacts)
            found.pop_back();
    }
    return found;
}

} // namespace boxwood
