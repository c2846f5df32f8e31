#include "bench/truth/link_solid.h"

#include "kernels/oracle/oracle.h"
#include "kernels/primitives/rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace boxwood::bench {
namespace {

constexpr int meridians = 32, arcs_of_quarter = 8;

/// Corners of half a cross-section from the lower pole to the upper one: r across, z along.
struct Corner {
    double r, z;
};
using Profile = std::vector<Corner>;

/// A profile turned about z. The corners' circles lie around the polygons, or in them.
PosedTriangles turned_about_z(const Profile& profile, bool is_outer) {
    constexpr double step = 2 * std::numbers::pi / meridians;
    const double wider = is_outer ? 1 / std::cos(step / 2) : 1;
    const auto at = [&](const Corner& c, int k) {
        return Vec3<double>{wider * c.r * std::cos(k * step), wider * c.r * std::sin(k * step),
                            c.z};
    };
    PosedTriangles all;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i)
        for (int k = 0; k < meridians; ++k) {
            const Vec3<double> a = at(profile[i], k), b = at(profile[i], k + 1);
            const Vec3<double> c = at(profile[i + 1], k + 1), d = at(profile[i + 1], k);
            if (profile[i].r > 0)
                all.push_back({a, b, c});
            if (profile[i + 1].r > 0)
                all.push_back({a, c, d});
        }
    return all;
}

/// Two half-circles of this radius, `apart` along z: with the corners on them, or with edges that
/// touch them.
Profile round_profile(double radius, double apart, bool is_outer) {
    constexpr double step = std::numbers::pi / 2 / arcs_of_quarter;
    const double r = is_outer ? radius / std::cos(step / 2) : radius;
    Profile profile;
    for (int k = -arcs_of_quarter; k <= 0; ++k)
        profile.push_back({k == -arcs_of_quarter ? 0 : r * std::cos(k * step),
                           r * std::sin(k * step) - apart / 2});
    for (int k = apart > 0 ? 0 : 1; k <= arcs_of_quarter; ++k)
        profile.push_back({k == arcs_of_quarter ? 0 : r * std::cos(k * step),
                           r * std::sin(k * step) + apart / 2});
    return profile;
}

double part(double x, double of) { return std::abs(x) / of; }

struct SolidOf {
    const std::vector<TriangleMesh>& meshes;

    /// A mesh in its scale, rounded to floats axis by axis.
    LinkSolid operator()(const LinkMesh& shape) const {
        LinkSolid solid;
        const TriangleMesh& mesh = meshes.at(shape.mesh);
        const auto corner = [&](std::uint32_t vertex) {
            const Vec3<double> p(mesh.vertices[vertex]);
            return Vec3<double>(Vec3<float>(
                Vec3<double>{p.x * shape.scale.x, p.y * shape.scale.y, p.z * shape.scale.z}));
        };
        for (const auto& [a, b, c] : mesh.triangles)
            solid.inner.push_back({corner(a), corner(b), corner(c)});
        solid.outer = solid.inner;
        return solid;
    }
    LinkSolid operator()(const LinkBox& shape) const {
        const Vec3<double> half = .5 * shape.sides;
        const auto corner = [&](unsigned bits) {
            return Vec3<double>{bits & 1 ? half.x : -half.x, bits & 2 ? half.y : -half.y,
                                bits & 4 ? half.z : -half.z};
        };
        LinkSolid solid;
        for (unsigned axis = 0; axis < 3; ++axis)
            for (const unsigned side : {0u, 1u << axis}) {
                const unsigned u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3;
                solid.inner.push_back({corner(side), corner(side | u), corner(side | u | v)});
                solid.inner.push_back({corner(side), corner(side | u | v), corner(side | v)});
            }
        solid.outer = solid.inner;
        solid.level = [half](Vec3<double> p) {
            return std::max({part(p.x, half.x), part(p.y, half.y), part(p.z, half.z)});
        };
        solid.outer_level = 1 + 0x1p-30;
        return solid;
    }
    LinkSolid operator()(const LinkSphere& shape) const { return capsule(shape.radius, 0); }
    LinkSolid operator()(const LinkCapsule& shape) const {
        return capsule(shape.radius, shape.length);
    }
    LinkSolid operator()(const LinkCylinder& shape) const {
        const double r = shape.radius, half = shape.length / 2;
        const Profile profile{{0, -half}, {r, -half}, {r, half}, {0, half}};
        LinkSolid solid;
        solid.inner = turned_about_z(profile, false);
        solid.outer = turned_about_z(profile, true);
        solid.level = [r, half](Vec3<double> p) {
            return std::max(part(std::hypot(p.x, p.y), r), part(p.z, half));
        };
        solid.outer_level = 1.005; // 1 / cos(pi / 32) = 1.0048
        return solid;
    }

  private:
    static LinkSolid capsule(double radius, double length) {
        LinkSolid solid;
        solid.inner = turned_about_z(round_profile(radius, length, false), false);
        solid.outer = turned_about_z(round_profile(radius, length, true), true);
        solid.level = [radius, half = length / 2](Vec3<double> p) {
            const double beyond = std::max(std::abs(p.z) - half, 0.0);
            return part(std::hypot(std::hypot(p.x, p.y), beyond), radius);
        };
        solid.outer_level = 1.01; // 1 / cos(pi / 32)^2 = 1.0097
        return solid;
    }
};

PosedTriangles placed(const PosedTriangles& triangles, const RigidTransform<double>& pose) {
    PosedTriangles all;
    all.reserve(triangles.size());
    for (const Triangle<double>& t : triangles)
        all.push_back({pose(t.a), pose(t.b), pose(t.c)});
    return all;
}

double norm1(Vec3<double> v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

/// Whether all of t is on one side of the plane of s, beyond what rounding may be off by: eight
/// roundings of products that 2^-46 of that of the lengths is 16 times of. Where that leaves the
/// range of doubles nothing is said.
bool is_on_one_side(const Triangle<double>& s, const Triangle<double>& t) {
    const Vec3<double> u = s.b - s.a, v = s.c - s.a, normal = cross(u, v);
    int above = 0, below = 0;
    for (const Vec3<double> p : {t.a, t.b, t.c}) {
        const Vec3<double> w = p - s.a;
        const double height = dot(normal, w), off = 0x1p-46 * norm1(u) * norm1(v) * norm1(w);
        above += height > off && off > 0x1p-900;
        below += height < -off && off > 0x1p-900;
    }
    return above == 3 || below == 3;
}

/// Those that doubles do not tell apart, rationals do.
bool surfaces_touch(const PosedTriangles& a, const PosedTriangles& b, const Aabb<double>& box_b) {
    for (const Triangle<double>& s : a) {
        const Aabb<double> box = s.bounds();
        if (!overlaps(box, box_b))
            continue;
        for (const Triangle<double>& t : b)
            if (overlaps(box, t.bounds()) && !is_on_one_side(s, t) && !is_on_one_side(t, s) &&
                oracle::intersect(s, t))
                return true;
    }
    return false;
}

/// Whether `holds` is true of a corner, in the frame of the solid.
template <class Holds>
bool any_corner(const PosedTriangles& triangles, const PlacedSolid& of, Holds holds) {
    if (!of.solid->level)
        return false;
    const auto& [r0, r1, r2] = of.pose.rotation;
    const auto held = [&](Vec3<double> p) {
        const Vec3<double> apart = p - of.pose.translation;
        return holds(apart.x * r0 + apart.y * r1 + apart.z * r2);
    };
    return std::ranges::any_of(
        triangles, [&](const Triangle<double>& t) { return held(t.a) || held(t.b) || held(t.c); });
}

} // namespace

PlacedSolid::PlacedSolid(const LinkSolid& of, const RigidTransform<double>& link)
    : solid(&of), pose(compose(link, of.origin)), inner(placed(of.inner, pose)),
      outer(placed(of.outer, pose)) {
    for (const PosedTriangles* side : {&inner, &outer})
        for (const Triangle<double>& t : *side)
            box.extend(t.bounds());
}

bool surely_touch(const PlacedSolid& a, const PlacedSolid& b) {
    const auto in = [](const PlacedSolid& solid) {
        return [&](Vec3<double> p) { return solid.solid->contains(p); };
    };
    return any_corner(b.inner, a, in(a)) || any_corner(a.inner, b, in(b)) ||
           surfaces_touch(a.inner, b.inner, b.box);
}

bool may_touch(const PlacedSolid& a, const PlacedSolid& b) {
    const auto in = [](const PlacedSolid& solid) {
        return [&](Vec3<double> p) { return solid.solid->may_contain(p); };
    };
    return any_corner(b.outer, a, in(a)) || any_corner(a.outer, b, in(b)) ||
           surfaces_touch(a.outer, b.outer, b.box);
}

LinkSolid link_solid(const LinkGeometry& geometry, const std::vector<TriangleMesh>& meshes) {
    LinkSolid solid = std::visit(SolidOf{meshes}, geometry.shape);
    solid.origin = geometry.origin;
    return solid;
}

} // namespace boxwood::bench
