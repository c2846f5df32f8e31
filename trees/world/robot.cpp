#include "trees/world/robot.h"

#include "kernels/arithmetic/rounding.h"
#include "kernels/primitives/coordinate_limit.h"
#include "kernels/primitives/rotation.h"
#include "kernels/suggest.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <variant>

namespace boxwood {
namespace {

void check_size(std::size_t given, std::size_t wanted, const char* what) {
    if (given != wanted)
        throw std::invalid_argument(std::to_string(given) + " " + what +
                                    " are given; the robot has " + std::to_string(wanted));
}

/// Rounding to nearest is off by less than one step outward.
Vec3<double> up(Vec3<double> v) {
    for (int axis = 0; axis < 3; ++axis)
        v[axis] = std::nextafter(v[axis], INFINITY);
    return v;
}

Vec3<double> scaled_point(Vec3<double> p, Vec3<double> scale) {
    return {p.x * scale.x, p.y * scale.y, p.z * scale.z};
}

Aabb<double> around_origin(Vec3<double> half) { return {-half, half}; }

/// The box of a shape in its own frame.
struct ShapeBox {
    const LinkDescription& link;
    std::span<const Aabb<float>> mesh_boxes;

    Aabb<double> operator()(const LinkMesh& mesh) const {
        if (mesh.mesh >= mesh_boxes.size())
            throw std::invalid_argument(
                "link '" + link.name + "' has mesh number " + std::to_string(mesh.mesh) + " of " +
                std::to_string(mesh_boxes.size()) + " meshes, which count from 0");
        const Aabb<double> box(mesh_boxes[mesh.mesh]);
        if (!box.is_valid())
            throw std::invalid_argument("link '" + link.name + "': the box of mesh number " +
                                        std::to_string(mesh.mesh) + " is empty or not finite");
        if (mesh.scale == Vec3<double>{1, 1, 1})
            return box;
        Aabb<double> around;
        for (const Vec3<double>& corner : {box.min, box.max}) {
            const Vec3<double> p = scaled_point(corner, mesh.scale);
            around.extend(up(p));
            around.extend(-up(-p));
        }
        return Aabb<double>(round_outward(around)); // rounding is monotone: scaled() lies in it
    }
    Aabb<double> operator()(const LinkBox& box) const { return around_origin(up(.5 * box.sides)); }
    Aabb<double> operator()(const LinkSphere& s) const {
        return around_origin({s.radius, s.radius, s.radius});
    }
    Aabb<double> operator()(const LinkCylinder& c) const {
        return around_origin(up({c.radius, c.radius, c.length / 2}));
    }
    Aabb<double> operator()(const LinkCapsule& c) const {
        return around_origin(up({c.radius, c.radius, c.length / 2 + c.radius}));
    }
};

} // namespace

Robot::Robot(RobotDescription description)
    : description_(std::move(description)), tree_(description_) {
    for (LinkDescription& link : description_.links)
        for (LinkGeometry& geometry : link.geometries)
            for (int step = 0; step < 2; ++step)
                geometry.origin.rotation = orthonormalised(geometry.origin.rotation);
}

const std::string& Robot::value_name(std::size_t value) const {
    return description_.joints[tree_.joints_of_values()[value]].name;
}

std::uint32_t Robot::link(std::string_view name) const {
    const auto all = links();
    const auto found = std::ranges::find(all, name, &LinkDescription::name);
    if (found == all.end())
        throw std::invalid_argument(unknown_name("link", name, names_of(all)));
    return static_cast<std::uint32_t>(found - all.begin());
}

std::size_t Robot::value(std::string_view joint) const {
    const auto found = std::ranges::find(joints(), joint, &JointDescription::name);
    if (found != joints().end()) {
        const auto with_values = tree_.joints_of_values();
        const auto index = static_cast<std::uint32_t>(found - joints().begin());
        const auto value = std::ranges::find(with_values, index);
        if (value != with_values.end())
            return static_cast<std::size_t>(value - with_values.begin());
        throw std::invalid_argument(
            "joint '" + found->name + "' has no value of its own: it " +
            (found->mimic ? "mimics joint '" + joints()[found->mimic->joint].name + "'"
                          : std::string("is fixed")));
    }
    std::vector<std::string_view> movable;
    for (std::size_t i = 0; i < n_values(); ++i)
        movable.emplace_back(value_name(i));
    throw std::invalid_argument(unknown_name("joint", joint, movable));
}

std::vector<double> Robot::rest() const {
    std::vector<double> values;
    for (const ValueRange& range : ranges())
        values.push_back(std::clamp(0.0, range.lower, range.upper));
    return values;
}

void Robot::poses(std::span<const double> values, std::span<RigidTransform<double>> poses,
                  const RigidTransform<double>& root) const {
    check_size(values.size(), n_values(), "joint values");
    check_size(poses.size(), links().size(), "poses of links");
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
            throw std::invalid_argument("the value of joint '" + value_name(i) + "' is " +
                                        std::to_string(values[i]) + "; it must be finite");
    tree_.forward(values, poses, root);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto& turn = poses[i].rotation;
        if (!is_finite(turn[0]) || !is_finite(turn[1]) || !is_finite(turn[2]))
            throw std::invalid_argument("link '" + links()[i].name +
                                        "' is turned by an angle that is not finite: a factor of a "
                                        "mimic joint or a value is too large, or the root's pose "
                                        "is none");
        if (!is_in_range(poses[i].translation))
            throw std::invalid_argument("link '" + links()[i].name +
                                        "' lies beyond 2^60: the root's pose, an origin, a limit, "
                                        "a factor of a mimic joint or a value is too large");
    }
}

void Robot::interpolate(std::span<const double> from, std::span<const double> to, double t,
                        std::span<double> out) const {
    for (const std::size_t given : {from.size(), to.size(), out.size()})
        check_size(given, n_values(), "joint values");
    for (std::size_t i = 0; i < from.size(); ++i) {
        const double end = ranges()[i].wraps
                               ? from[i] + std::remainder(to[i] - from[i], 2 * std::numbers::pi)
                               : to[i];
        out[i] = std::lerp(from[i], end, t);
    }
}

JointPath::JointPath(const Robot& robot, std::vector<std::vector<double>> states)
    : robot_(&robot), states_(std::move(states)) {
    if (states_.empty())
        throw std::invalid_argument("a path without states; give it one at least");
    for (std::size_t i = 0; i < states_.size(); ++i) {
        check_size(states_[i].size(), robot.n_values(), "joint values");
        for (std::size_t k = 0; k < states_[i].size(); ++k)
            if (!std::isfinite(states_[i][k]))
                throw std::invalid_argument("state " + std::to_string(i) +
                                            " of a path: the value of joint '" +
                                            robot.value_name(k) + "' is not finite");
    }
}

void JointPath::at(double s, std::span<double> out) const {
    const double last = static_cast<double>(size() - 1);
    const double time = s > 0 ? std::min(s, last) : 0; // NaN: the start
    const auto i = static_cast<std::size_t>(time);
    const std::size_t next = std::min(i + 1, size() - 1);
    robot_->interpolate(states_[i], states_[next], time - static_cast<double>(i), out);
}

TriangleMesh scaled(TriangleMesh mesh, Vec3<double> scale) {
    if (scale == Vec3<double>{1, 1, 1})
        return mesh;
    for (Vec3<float>& vertex : mesh.vertices)
        vertex = Vec3<float>(scaled_point(Vec3<double>(vertex), scale));
    if ((scale.x < 0) != ((scale.y < 0) != (scale.z < 0)))
        for (auto& triangle : mesh.triangles)
            std::swap(triangle[1], triangle[2]);
    return mesh;
}

LinkBoxes::LinkBoxes(const Robot& robot, std::span<const Aabb<float>> mesh_boxes) {
    without_flushing([&] {
        for (std::uint32_t i = 0; i < robot.links().size(); ++i) {
            const LinkDescription& link = robot.links()[i];
            first_.push_back(parts_.size());
            if (!link.geometries.empty())
                links_.push_back(i);
            for (const LinkGeometry& geometry : link.geometries)
                parts_.emplace_back(
                    fit(geometry.origin, std::visit(ShapeBox{link, mesh_boxes}, geometry.shape)));
        }
    });
    first_.push_back(parts_.size());
}

void LinkBoxes::boxes(std::span<const RigidTransform<double>> poses,
                      std::span<Aabb<double>> boxes) const {
    check_size(poses.size(), first_.size() - 1, "poses of links");
    check_size(boxes.size(), first_.size() - 1, "boxes of links");
    without_flushing([&] {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            Aabb<double> box;
            for (std::size_t part = first_[i]; part < first_[i + 1]; ++part)
                box.extend(PaddedFit<double>::fit_kept(poses[i], parts_[part]));
            boxes[i] = box;
        }
    });
}

} // namespace boxwood
