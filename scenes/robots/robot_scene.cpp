#include "scenes/robots/robot_scene.h"

#include "kernels/kinematics/kinematic_tree.h"
#include "kernels/suggest.h"
#include "scenes/robots/random_values.h"
#include "scenes/robots/srdf.h"

#include <array>
#include <stdexcept>
#include <variant>

namespace boxwood {
namespace {

using Box = Aabb<double>;

Box centred(const Vec3<double>& half) { return {-half, half}; }

/// A shape's box in its own frame.
struct BoxOfShape {
    const std::vector<TriangleMesh>& meshes;

    Box operator()(const LinkMesh& shape) const {
        Box box;
        for (const auto& triangle : meshes[shape.mesh].triangles)
            for (const std::uint32_t vertex : triangle) {
                const Vec3<double> p(meshes[shape.mesh].vertices[vertex]);
                box.extend(
                    Vec3<double>{shape.scale.x * p.x, shape.scale.y * p.y, shape.scale.z * p.z});
            }
        return box;
    }
    Box operator()(const LinkBox& shape) const { return centred(.5 * shape.sides); }
    Box operator()(const LinkSphere& shape) const {
        return centred({shape.radius, shape.radius, shape.radius});
    }
    Box operator()(const LinkCylinder& shape) const {
        return centred({shape.radius, shape.radius, shape.length / 2});
    }
    Box operator()(const LinkCapsule& shape) const {
        return centred({shape.radius, shape.radius, shape.length / 2 + shape.radius});
    }
};

void extend(Aabb<float>& box, const Box& part, const RigidTransform<double>& origin) {
    if (!(part.min.x <= part.max.x)) // of a mesh without triangles
        return;
    for (int corner = 0; corner < 8; ++corner)
        box.extend(Vec3<float>(origin(Vec3<double>{corner & 1 ? part.max.x : part.min.x,
                                                   corner & 2 ? part.max.y : part.min.y,
                                                   corner & 4 ? part.max.z : part.min.z})));
}

} // namespace

RobotStates read_robot_states(const std::filesystem::path& urdf, std::size_t n, std::uint64_t seed,
                              std::string_view kind) {
    if (kind != random_states && kind != states_along)
        throw std::invalid_argument(
            unknown_name("kind of states", kind, std::array{random_states, states_along}));
    RobotStates of{read_urdf(urdf), std::nullopt, {}};
    const std::filesystem::path srdf = std::filesystem::path(urdf).replace_extension(".srdf");
    if (std::filesystem::exists(srdf))
        of.allowed = read_srdf(srdf, of.robot.description).allowed;
    const KinematicTree tree(of.robot.description);
    of.states.assign(n, std::vector<double>(tree.n_values()));
    if (kind == random_states) {
        for (std::size_t i = 0; i < n; ++i)
            random_values(tree.ranges(), seed, i, of.states[i]);
        return of;
    }
    std::vector<double> from(tree.n_values()), to(tree.n_values());
    for (std::size_t i = 0; i < n; ++i) {
        random_values(tree.ranges(), seed, i / steps_along, from);
        random_values(tree.ranges(), seed, i / steps_along + 1, to);
        const double t = static_cast<double>(i % steps_along) / static_cast<double>(steps_along);
        for (std::size_t value = 0; value < to.size(); ++value)
            of.states[i][value] = from[value] + t * (to[value] - from[value]);
    }
    return of;
}

std::vector<Aabb<float>> link_boxes(const UrdfRobot& robot) {
    std::vector<Aabb<float>> boxes;
    for (const LinkDescription& link : robot.description.links) {
        Aabb<float>& box = boxes.emplace_back();
        for (const LinkGeometry& geometry : link.geometries)
            extend(box, std::visit(BoxOfShape{robot.meshes}, geometry.shape), geometry.origin);
    }
    return boxes;
}

} // namespace boxwood
