#include "trees/world/bodies/robot_bodies.h"

#include "trees/world/bodies/detail/link_bodies.h"

#include <stdexcept>
#include <utility>

namespace boxwood {

RobotBodies::RobotBodies(World& world, const Robot& robot, std::span<const TriangleMesh> meshes,
                         const AllowedPairs& allowed, const RobotBodiesOptions& options)
    : world_(&world), robot_(&robot), link_poses_(robot.links().size()) {
    if (allowed.items() != robot.links().size())
        throw std::invalid_argument("the allowed pairs are of " + std::to_string(allowed.items()) +
                                    " items; the robot has " +
                                    std::to_string(robot.links().size()) + " links");
    try {
        insert(meshes, options);
        allow(allowed);
        place(robot.rest());
    } catch (...) {
        for (const std::uint32_t body : bodies_)
            world.remove(body);
        throw;
    }
}

void RobotBodies::insert(std::span<const TriangleMesh> meshes, const RobotBodiesOptions& options) {
    detail::LinkBodies shapes(meshes, options.are_solid);
    for (std::uint32_t i = 0; i < robot_->links().size(); ++i) {
        const LinkDescription& link = robot_->links()[i];
        for (std::size_t k = 0; k < link.geometries.size(); ++k) {
            const LinkGeometry& geometry = link.geometries[k];
            BodyOptions of;
            of.name = options.prefix + link.name + (k > 0 ? "#" + std::to_string(k + 1) : "");
            of.group = options.group;
            of.mask = options.mask;
            of.margin = options.margin;
            bodies_.push_back(world_->insert(shapes.make(link, geometry.shape), {}, of));
            links_.push_back(i);
            origins_.push_back(geometry.origin);
            link_of_.emplace(bodies_.back(), i);
        }
    }
    poses_.resize(bodies_.size());
}

void RobotBodies::allow(const AllowedPairs& allowed) {
    std::vector<std::vector<std::uint32_t>> of_link(robot_->links().size());
    for (std::size_t k = 0; k < bodies_.size(); ++k)
        of_link[links_[k]].push_back(bodies_[k]);
    for (const std::vector<std::uint32_t>& one : of_link)
        for (std::size_t i = 0; i < one.size(); ++i)
            for (std::size_t j = i + 1; j < one.size(); ++j)
                world_->allow(one[i], one[j], AllowedReason::always, "of one link");
    for (const AllowedPair& pair : allowed.pairs())
        for (const std::uint32_t a : of_link[pair.a])
            for (const std::uint32_t b : of_link[pair.b])
                world_->allow(a, b, pair.reason, pair.note);
}

void RobotBodies::place(std::span<const double> values, const RigidTransform<double>& root) {
    robot_->poses(values, link_poses_, root);
    for (std::size_t k = 0; k < bodies_.size(); ++k)
        poses_[k] = compose(link_poses_[links_[k]], origins_[k]);
    world_->set_poses(bodies_, poses_);
}

std::optional<std::uint32_t> RobotBodies::link_of(std::uint32_t body) const {
    const auto found = link_of_.find(body);
    return found == link_of_.end() ? std::nullopt : std::optional(found->second);
}

} // namespace boxwood
