#include "bench/tasks/detail/robot_in_scene.h"

#include "scenes/robots/robot_scene.h"
#include "trees/world/propose_pairs.h"

namespace boxwood::bench {
namespace {

std::vector<Aabb<float>> boxes_of(std::span<const TriangleMesh> meshes) {
    std::vector<Aabb<float>> boxes(meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i)
        for (std::size_t t = 0; t < meshes[i].triangles.size(); ++t)
            boxes[i].extend(meshes[i].triangle(t).bounds());
    return boxes;
}

} // namespace

RobotInScene::RobotInScene(const Scene& scene)
    : robot(scene.robot->robot.description), boxes(robot, boxes_of(scene.robot->robot.meshes)),
      allowed(no_allowed_pairs(robot)), meshes_(scene.robot->robot.meshes),
      states_(scene.robot->states) {
    if (!scene.robot->allowed)
        allow_adjacent(robot, allowed);
    else
        for (const AllowedPair& pair : *scene.robot->allowed)
            allowed.allow(pair.a, pair.b, pair.reason, pair.note);
}

} // namespace boxwood::bench
