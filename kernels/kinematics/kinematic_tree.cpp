/// A description is checked part by part: names, the tree of links, geometry, joints, mimics.
/// Then the joints are put in breadth-first order from the root, so that a link's pose is known
/// before those of the links that hang on it.

#include "kernels/kinematics/kinematic_tree.h"

#include "kernels/primitives/rotation.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>
#include <unordered_set>

namespace boxwood {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

std::string quoted(const LinkDescription& link) { return "link '" + link.name + "'"; }
std::string quoted(const JointDescription& joint) { return "joint '" + joint.name + "'"; }

template <class Named> void check_names(const std::vector<Named>& all, const std::string& what) {
    std::unordered_set<std::string_view> seen;
    for (const Named& one : all) {
        if (one.name.empty())
            refuse("a " + what + " has no name; give each one a name of its own");
        if (!seen.insert(one.name).second)
            refuse(quoted(one) + ": there are two of that name; give each one a name of its own");
    }
}

void check_pose(const RigidTransform<double>& pose, const std::string& whose) {
    bool finite = is_finite(pose.translation);
    for (const Vec3<double>& row : pose.rotation)
        finite &= is_finite(row);
    if (!finite)
        refuse(whose + ": its origin has a number that is not finite");
    if (!(distance_from_orthonormal(pose.rotation) <= 1e-6) ||
        dot(cross(pose.rotation[0], pose.rotation[1]), pose.rotation[2]) < 0)
        refuse(whose + ": the matrix of its origin is no rotation");
}

struct CheckShape {
    const std::string& whose;

    void size(double number, std::string_view what) const {
        if (!std::isfinite(number) || number < 0)
            refuse(whose + ": the " + std::string(what) + " is " + std::to_string(number) +
                   "; it must be finite and not negative");
    }
    void operator()(const LinkMesh& mesh) const {
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(mesh.scale[axis]) || mesh.scale[axis] == 0)
                refuse(whose + ": a mesh is scaled by " + std::to_string(mesh.scale[axis]) +
                       "; a scale must be finite and not 0");
    }
    void operator()(const LinkBox& box) const {
        for (int axis = 0; axis < 3; ++axis)
            size(box.sides[axis], "side of a box");
    }
    void operator()(const LinkSphere& sphere) const { size(sphere.radius, "radius of a sphere"); }
    void operator()(const LinkCylinder& cylinder) const {
        size(cylinder.radius, "radius of a cylinder");
        size(cylinder.length, "length of a cylinder");
    }
    void operator()(const LinkCapsule& capsule) const {
        size(capsule.radius, "radius of a capsule");
        size(capsule.length, "length of a capsule");
    }
};

void check_geometry(const RobotDescription& robot) {
    for (const LinkDescription& link : robot.links) {
        const std::string whose = quoted(link);
        for (const LinkGeometry& geometry : link.geometries) {
            check_pose(geometry.origin, whose);
            std::visit(CheckShape{whose}, geometry.shape);
        }
    }
}

Vec3<double> unit_axis(const JointDescription& joint) {
    const double largest =
        std::max({std::abs(joint.axis.x), std::abs(joint.axis.y), std::abs(joint.axis.z)});
    if (!is_finite(joint.axis) || largest == 0)
        refuse(quoted(joint) + ": its axis is 0 or not finite; give it a direction");
    const Vec3<double> scaled{joint.axis.x / largest, joint.axis.y / largest,
                              joint.axis.z / largest};
    const double size = length(scaled);
    return {scaled.x / size, scaled.y / size, scaled.z / size};
}

ValueRange range_of(const JointDescription& joint) {
    if (joint.kind == JointKind::continuous)
        return {-std::numbers::pi, std::numbers::pi, true};
    if (!std::isfinite(joint.lower) || !std::isfinite(joint.upper))
        refuse(quoted(joint) + ": a limit is not finite; a joint without limits is 'continuous'");
    if (joint.lower > joint.upper)
        refuse(quoted(joint) + ": its lower limit " + std::to_string(joint.lower) +
               " is above the upper one, " + std::to_string(joint.upper));
    return {joint.lower, joint.upper, false};
}

/// Of each link the joint that it hangs on; `none` for the root.
std::vector<std::uint32_t> parent_joints(const RobotDescription& robot) {
    std::vector<std::uint32_t> joint_of(robot.links.size(), none);
    for (std::uint32_t j = 0; j < robot.joints.size(); ++j) {
        const JointDescription& joint = robot.joints[j];
        for (const std::uint32_t link : {joint.parent, joint.child})
            if (link >= robot.links.size())
                refuse(quoted(joint) + ": link number " + std::to_string(link) + " of " +
                       std::to_string(robot.links.size()) + " links, which count from 0");
        if (joint.parent == joint.child)
            refuse(quoted(joint) + " ties " + quoted(robot.links[joint.child]) + " to itself");
        if (joint_of[joint.child] != none)
            refuse(quoted(robot.links[joint.child]) + " hangs on two joints, '" +
                   robot.joints[joint_of[joint.child]].name + "' and '" + joint.name +
                   "'; a robot is a tree, so take one of them away");
        joint_of[joint.child] = j;
    }
    return joint_of;
}

std::uint32_t find_root(const RobotDescription& robot, const std::vector<std::uint32_t>& joint_of) {
    if (robot.links.empty())
        refuse("the robot has no links");
    const auto root = std::ranges::find(joint_of, none);
    if (root == joint_of.end())
        refuse("every link hangs on a joint: the joints make a cycle, and no link is the root");
    const auto second = std::find(root + 1, joint_of.end(), none);
    const auto link = [&](auto at) {
        return quoted(robot.links[static_cast<std::size_t>(at - joint_of.begin())]);
    };
    if (second != joint_of.end())
        refuse("two roots: neither " + link(root) + " nor " + link(second) +
               " hangs on a joint; tie one to the other by a fixed joint");
    return static_cast<std::uint32_t>(root - joint_of.begin());
}

/// Links that were not reached from the root hang on each other in a ring.
[[noreturn]] void refuse_cycle(const RobotDescription& robot,
                               const std::vector<std::uint32_t>& joint_of,
                               const std::vector<bool>& reached) {
    auto link = static_cast<std::uint32_t>(std::ranges::find(reached, false) - reached.begin());
    std::vector<bool> seen(robot.links.size());
    for (; !seen[link]; link = robot.joints[joint_of[link]].parent)
        seen[link] = true;
    refuse(quoted(robot.joints[joint_of[link]]) + " closes a cycle at " +
           quoted(robot.links[link]) + "; a robot is a tree, so take one joint of it away");
}

std::vector<std::uint32_t> breadth_first_joints(const RobotDescription& robot, std::uint32_t root,
                                                const std::vector<std::uint32_t>& joint_of) {
    std::vector<std::vector<std::uint32_t>> joints_below(robot.links.size());
    for (std::uint32_t j = 0; j < robot.joints.size(); ++j)
        joints_below[robot.joints[j].parent].push_back(j);
    std::vector<bool> reached(robot.links.size());
    reached[root] = true;
    std::vector<std::uint32_t> order = joints_below[root];
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::uint32_t child = robot.joints[order[i]].child;
        reached[child] = true;
        order.insert(order.end(), joints_below[child].begin(), joints_below[child].end());
    }
    if (std::ranges::find(reached, false) != reached.end())
        refuse_cycle(robot, joint_of, reached);
    return order;
}

/// The joint that moves this one in the end, and how.
Mimic followed(const RobotDescription& robot, std::uint32_t j) {
    Mimic all{j, 1, 0};
    for (std::size_t links = 0; robot.joints[all.joint].mimic; ++links) {
        const JointDescription& joint = robot.joints[all.joint];
        const Mimic& next = *joint.mimic;
        if (next.joint >= robot.joints.size())
            refuse(quoted(joint) + " mimics joint number " + std::to_string(next.joint) + " of " +
                   std::to_string(robot.joints.size()) + " joints, which count from 0");
        if (robot.joints[next.joint].kind == JointKind::fixed)
            refuse(quoted(joint) + " mimics " + quoted(robot.joints[next.joint]) +
                   ", which is fixed; name one that moves, or make this one fixed, too");
        if (links == robot.joints.size() || next.joint == j)
            refuse(quoted(robot.joints[j]) +
                   " mimics itself, perhaps by way of others; name a joint that moves freely");
        all = {next.joint, all.multiplier * next.multiplier,
               all.multiplier * next.offset + all.offset};
        if (!std::isfinite(all.multiplier) || !std::isfinite(all.offset))
            refuse(quoted(joint) + ": a number of its mimic is not finite");
    }
    return all;
}

} // namespace

/// Of a turn by q about a unit axis a, Rodrigues' formula: a a^T + sin q [a] + cos q (I - a a^T).
KinematicTree::Step KinematicTree::step_of(const JointDescription& joint) {
    Step step{joint.parent, joint.child};
    step.rotation = orthonormalised(orthonormalised(joint.origin.rotation));
    step.translation = joint.origin.translation;
    const bool turns = joint.kind != JointKind::fixed && joint.kind != JointKind::prismatic;
    step.parallel = !turns && step.rotation == RigidTransform<double>{}.rotation;
    if (joint.kind == JointKind::fixed)
        return step;
    const Vec3<double> a = unit_axis(joint);
    if (joint.kind == JointKind::prismatic) {
        step.slides = true;
        step.slide = RigidTransform<double>{step.rotation}(a);
        return step;
    }
    step.turns = true;
    const Rotation along{{a.x * a, a.y * a, a.z * a}};
    const Rotation across{{Vec3<double>{1, 0, 0} - along[0], Vec3<double>{0, 1, 0} - along[1],
                           Vec3<double>{0, 0, 1} - along[2]}};
    const Rotation turned{{{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}}};
    const Rotation origin = step.rotation;
    step.rotation = product(origin, along);
    step.sine = product(origin, turned);
    step.cosine = product(origin, across);
    return step;
}

KinematicTree::KinematicTree(const RobotDescription& robot)
    : n_links_(robot.links.size()), parents_(n_links_), rigid_parts_(n_links_) {
    check_names(robot.links, "link");
    check_names(robot.joints, "joint");
    const std::vector<std::uint32_t> joint_of = parent_joints(robot);
    root_ = find_root(robot, joint_of);
    parents_[root_] = rigid_parts_[root_] = root_;
    const std::vector<std::uint32_t> order = breadth_first_joints(robot, root_, joint_of);
    check_geometry(robot);

    std::vector<std::uint32_t> value_of(robot.joints.size(), none);
    for (std::uint32_t j = 0; j < robot.joints.size(); ++j) {
        const JointDescription& joint = robot.joints[j];
        if (joint.kind == JointKind::fixed) {
            if (joint.mimic)
                refuse(quoted(joint) + " is fixed and mimics another one; take one away");
            continue;
        }
        const ValueRange range = range_of(joint);
        if (joint.mimic)
            continue;
        value_of[j] = static_cast<std::uint32_t>(ranges_.size());
        ranges_.push_back(range);
        joints_of_values_.push_back(j);
    }

    for (const std::uint32_t j : order) {
        const JointDescription& joint = robot.joints[j];
        check_pose(joint.origin, quoted(joint));
        Step step = step_of(joint);
        parents_[joint.child] = joint.parent;
        rigid_parts_[joint.child] = joint.child;
        if (joint.kind == JointKind::fixed) {
            rigid_parts_[joint.child] = rigid_parts_[joint.parent];
        } else {
            const Mimic by = followed(robot, j);
            step.value = value_of[by.joint];
            step.multiplier = by.multiplier;
            step.offset = by.offset;
        }
        steps_.push_back(step);
    }
}

void KinematicTree::forward(std::span<const double> values, std::span<RigidTransform<double>> poses,
                            const RigidTransform<double>& root) const {
    poses[root_] = root;
    for (const Step& step : steps_) {
        const RigidTransform<double>& parent = poses[step.parent];
        RigidTransform<double>& child = poses[step.child];
        Vec3<double> place = step.translation;
        Rotation turned = step.rotation;
        if (step.turns) {
            const double q = step.multiplier * values[step.value] + step.offset;
            const double s = std::sin(q), c = std::cos(q);
            for (std::size_t i = 0; i < 3; ++i)
                turned[i] = step.rotation[i] + (s * step.sine[i] + c * step.cosine[i]);
        } else if (step.slides) {
            const double q = step.multiplier * values[step.value] + step.offset;
            place = place + q * step.slide;
        }
        child.translation = parent(place);
        child.rotation =
            step.parallel ? parent.rotation : orthonormal_product(parent.rotation, turned);
    }
}

} // namespace boxwood
