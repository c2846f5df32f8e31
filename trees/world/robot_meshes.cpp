#include "trees/world/robot_meshes.h"

#include "trees/world/box_mesh.h"
#include "trees/world/mesh_pairs.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <variant>

namespace boxwood {
namespace {

/// What a shape is called that this narrow phase does not know.
std::string name_of_shape(const LinkShape& shape) {
    return std::holds_alternative<LinkSphere>(shape)     ? "sphere"
           : std::holds_alternative<LinkCylinder>(shape) ? "cylinder"
                                                         : "capsule";
}

} // namespace

RobotMeshes::RobotMeshes(const Robot& robot, std::span<const TriangleMesh> meshes)
    : parts_(robot.links().size()) {
    std::map<std::tuple<std::uint32_t, double, double, double>, std::shared_ptr<const MeshTree>>
        trees;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const LinkDescription& link = robot.links()[i];
        for (const LinkGeometry& geometry : link.geometries) {
            std::shared_ptr<const MeshTree> tree;
            if (const auto* mesh = std::get_if<LinkMesh>(&geometry.shape)) {
                if (mesh->mesh >= meshes.size())
                    throw std::invalid_argument("link " + link.name + " names mesh " +
                                                std::to_string(mesh->mesh) + ", and there are " +
                                                std::to_string(meshes.size()));
                auto& shared = trees[{mesh->mesh, mesh->scale.x, mesh->scale.y, mesh->scale.z}];
                if (!shared)
                    shared = std::make_shared<MeshTree>(scaled(meshes[mesh->mesh], mesh->scale));
                tree = shared;
            } else if (const auto* box = std::get_if<LinkBox>(&geometry.shape)) {
                tree = std::make_shared<MeshTree>(box_mesh(box->sides));
            } else {
                throw std::invalid_argument("link " + link.name + " has a " +
                                            name_of_shape(geometry.shape) +
                                            ", and only meshes and boxes are tested so far");
            }
            parts_[i].push_back({std::move(tree), geometry.origin});
        }
    }
}

template <class F>
void RobotMeshes::for_each_pair(std::uint32_t a, std::uint32_t b,
                                std::span<const RigidTransform<double>> poses, const F& f) const {
    for (const Part& of_a : parts_[a]) {
        const Pose pose_a = compose(poses[a], of_a.origin);
        for (const Part& of_b : parts_[b])
            if (f(*of_a.tree, *of_b.tree, relative_pose(pose_a, compose(poses[b], of_b.origin))))
                return;
    }
}

bool RobotMeshes::collide(std::uint32_t a, std::uint32_t b,
                          std::span<const RigidTransform<double>> poses) const {
    bool touch = false;
    for_each_pair(a, b, poses, [&](const MeshTree& of_a, const MeshTree& of_b, const Pose& pose) {
        return touch = boxwood::collide(of_a, of_b, pose);
    });
    return touch;
}

LinkDistance RobotMeshes::distance(std::uint32_t a, std::uint32_t b,
                                   std::span<const RigidTransform<double>> poses,
                                   double limit) const {
    LinkDistance least;
    for_each_pair(a, b, poses, [&](const MeshTree& of_a, const MeshTree& of_b, const Pose& pose) {
        DistanceOptions options;
        options.limit = std::min(limit, least.hi);
        const MeshDistance found = boxwood::distance(of_a, of_b, pose, options);
        if (found.found()) {
            least.lo = std::min(least.lo, found.lo);
            if (found.hi < least.hi) {
                least.distance = found.distance;
                least.hi = found.hi;
            }
        }
        return least.hi == 0;
    });
    return least;
}

} // namespace boxwood
