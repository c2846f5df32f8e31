/// Every task: to add one, write its file and put its name here.

#include "bench/io/text_table.h"
#include "bench/tasks/task.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#define BOXWOOD_TASKS(X)                                                                           \
    X(pairs)                                                                                       \
    X(tree_pairs)                                                                                  \
    X(rays_closest)                                                                                \
    X(rays_any)                                                                                    \
    X(rays_all)                                                                                    \
    X(triangle_pairs)                                                                              \
    X(moving_pairs)                                                                                \
    X(build)                                                                                       \
    X(points)                                                                                      \
    X(regions)                                                                                     \
    X(nearest)                                                                                     \
    X(closest_points)                                                                              \
    X(collide)                                                                                     \
    X(collide_all)                                                                                 \
    X(distance)                                                                                    \
    X(tolerance)                                                                                   \
    X(contacts)                                                                                    \
    X(continuous)                                                                                  \
    X(robot_self)                                                                                  \
    X(robot_distance)                                                                              \
    X(scene_queries)                                                                               \
    X(triangle_triangle)                                                                           \
    X(triangle_distance)                                                                           \
    X(segment_segment)                                                                             \
    X(point_triangle)                                                                              \
    X(point_segment)                                                                               \
    X(ray_triangle)                                                                                \
    X(ray_box)                                                                                     \
    X(vertex_face)                                                                                 \
    X(edge_edge)                                                                                   \
    X(obb_obb)                                                                                     \
    X(shape_collide)                                                                               \
    X(shape_distance)                                                                              \
    X(signed_shape_distance)                                                                       \
    X(box_fit)

namespace boxwood::bench {

#define BOXWOOD_DECLARE(name) const Task& name##_task();
BOXWOOD_TASKS(BOXWOOD_DECLARE)
#undef BOXWOOD_DECLARE

namespace {

std::vector<const Task*>& registered() {
#define BOXWOOD_ADDRESS(name) &name##_task(),
    static std::vector<const Task*> all{BOXWOOD_TASKS(BOXWOOD_ADDRESS)};
#undef BOXWOOD_ADDRESS
    return all;
}

} // namespace

std::span<const Task* const> tasks() { return registered(); }

const Task* find_task(std::string_view name) {
    const auto found = std::ranges::find(registered(), name, &Task::name);
    return found == registered().end() ? nullptr : *found;
}

void add_task(const Task& task) { registered().push_back(&task); }

std::string Task::title() const { return spaced(name()); }

ContenderEntry Task::contender(const Choice&) const {
    throw std::invalid_argument(fmt::format("no builder and layout answer {}", name()));
}

ContenderEntry Task::kernel_contender(std::string_view kernel) const {
    throw std::invalid_argument(fmt::format("{} is no family of kernels: no {}", name(), kernel));
}

void Task::append_work(std::vector<NamedCount>& counts, const Work* work, bool with_triangles) {
    if (!work)
        return;
    counts.push_back({"node_visits", work->node_visits});
    counts.push_back({"box_tests", work->box_tests});
    if (with_triangles)
        counts.push_back({"triangle_tests", work->triangle_tests});
    counts.push_back({"stack_max", work->stack_max});
}

} // namespace boxwood::bench
