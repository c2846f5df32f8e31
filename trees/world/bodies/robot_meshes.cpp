#include "trees/world/bodies/robot_meshes.h"

#include "kernels/convex/signed_distance.h"
#include "trees/world/bodies/detail/link_bodies.h"
#include "trees/world/bodies/shape_pairs.h"
#include "trees/world/mesh_pairs.h"
#include "trees/world/mesh_shape.h"

#include <algorithm>
#include <variant>

namespace boxwood {
namespace {

/// Of what is found beyond the limit no more is said than that.
LinkDistance before(double limit, double distance, double lo, double hi) {
    if (!(lo < limit))
        return {.lo = limit};
    return {std::max(0.0, distance), std::max(0.0, lo), std::max(0.0, hi)};
}

} // namespace

std::optional<convex::Shape> solid_of(const LinkShape& shape) {
    struct Make {
        std::optional<convex::Shape> operator()(const LinkMesh&) const { return std::nullopt; }
        std::optional<convex::Shape> operator()(const LinkBox& b) const {
            return convex::Box{0.5 * b.sides};
        }
        std::optional<convex::Shape> operator()(const LinkSphere& s) const {
            return convex::Sphere{s.radius};
        }
        std::optional<convex::Shape> operator()(const LinkCylinder& c) const {
            return convex::Cylinder{c.radius, c.length / 2};
        }
        std::optional<convex::Shape> operator()(const LinkCapsule& c) const {
            return convex::Capsule{c.radius, c.length / 2};
        }
    };
    return std::visit(Make{}, shape);
}

RobotMeshes::RobotMeshes(const Robot& robot, std::span<const TriangleMesh> meshes,
                         const RobotMeshesOptions& options)
    : parts_(robot.links().size()) {
    detail::LinkBodies bodies(meshes, options.are_solid);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const LinkDescription& link = robot.links()[i];
        for (const LinkGeometry& geometry : link.geometries) {
            const BodyShape body = bodies.make(link, geometry.shape);
            const bool is_convex = body.shape_class() == ShapeClass::convex;
            parts_[i].push_back({is_convex ? nullptr : &body.tree(),
                                 is_convex ? body.convex_shape() : convex::Shape{}, body,
                                 geometry.origin, geometry.origin != Pose{}});
        }
    }
}

bool RobotMeshes::has_solid(const Placed& a, const Placed& b) {
    return a.part.body.shape_class() == ShapeClass::solid ||
           b.part.body.shape_class() == ShapeClass::solid;
}

RobotMeshes::Placed RobotMeshes::placed(const Part& part, const Pose& link) {
    return {part, part.turns_or_moves ? compose(link, part.origin) : link};
}

template <class F>
void RobotMeshes::for_each_pair(std::uint32_t a, std::uint32_t b,
                                std::span<const RigidTransform<double>> poses, const F& f) const {
    for (const Part& of_a : parts_[a]) {
        const Placed placed_a = placed(of_a, poses[a]);
        for (const Part& of_b : parts_[b])
            if (f(placed_a, placed(of_b, poses[b])))
                return;
    }
}

bool RobotMeshes::touch(const Placed& a, const Placed& b) {
    if (has_solid(a, b))
        return boxwood::collide(PosedShape{a.part.body, a.pose}, PosedShape{b.part.body, b.pose}) !=
               Answer::no;
    if (a.part.mesh && b.part.mesh)
        return boxwood::collide(*a.part.mesh, *b.part.mesh, relative_pose(a.pose, b.pose));
    if (b.part.mesh)
        return touch(b, a);
    const Decision found =
        a.part.mesh ? boxwood::collide(*a.part.mesh, b.part.shape, relative_pose(a.pose, b.pose))
                    : convex::collide(a.part.shape, a.pose, b.part.shape, b.pose);
    return found.answer != Answer::no;
}

LinkDistance RobotMeshes::distance_of(const Placed& a, const Placed& b, double limit) {
    if (has_solid(a, b)) {
        const BodyDistance d = boxwood::distance(PosedShape{a.part.body, a.pose},
                                                 PosedShape{b.part.body, b.pose}, {.limit = limit});
        return d.found() ? before(limit, d.distance, d.lo, d.hi) : LinkDistance{.lo = limit};
    }
    if (!a.part.mesh && b.part.mesh)
        return distance_of(b, a, limit);
    if (!a.part.mesh) {
        const convex::SignedDistance d =
            convex::signed_distance(a.part.shape, a.pose, b.part.shape, b.pose);
        return before(limit, d.distance, d.lo, d.hi);
    }
    DistanceOptions options;
    options.limit = limit;
    const Pose b_in_a = relative_pose(a.pose, b.pose);
    const MeshDistance d = b.part.mesh
                               ? boxwood::distance(*a.part.mesh, *b.part.mesh, b_in_a, options)
                               : boxwood::distance(*a.part.mesh, b.part.shape, b_in_a, options);
    return d.found() ? before(limit, d.distance, d.lo, d.hi) : LinkDistance{.lo = limit};
}

bool RobotMeshes::collide(std::uint32_t a, std::uint32_t b,
                          std::span<const RigidTransform<double>> poses) const {
    bool found = false;
    for_each_pair(a, b, poses, [&](const Placed& of_a, const Placed& of_b) {
        return found = touch(of_a, of_b);
    });
    return found;
}

LinkDistance RobotMeshes::distance(std::uint32_t a, std::uint32_t b,
                                   std::span<const RigidTransform<double>> poses,
                                   double limit) const {
    LinkDistance least;
    for_each_pair(a, b, poses, [&](const Placed& of_a, const Placed& of_b) {
        const LinkDistance found = distance_of(of_a, of_b, std::min(limit, least.hi));
        least.lo = std::min(least.lo, found.lo);
        if (found.hi < least.hi) {
            least.distance = found.distance;
            least.hi = found.hi;
        }
        return least.hi == 0;
    });
    return least;
}

} // namespace boxwood
