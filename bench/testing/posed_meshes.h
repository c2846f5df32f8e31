#pragma once

#include "bench/tasks/task.h"
#include "scenes/scene.h"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace boxwood::bench {

/// A small mesh and a copy of it in four places.
inline Scene posed(std::string_view kind, std::size_t n = 700, const char* motion = "") {
    return make_scene({.generator = "sphere_mesh",
                       .n = n,
                       .poses = std::string(kind),
                       .n_poses = 4,
                       .motion = motion});
}

/// Answers of ours that are right.
inline std::unique_ptr<Answers> right_answers(const Task& task, const Scene& scene) {
    Choice choice;
    choice.layout = "obb";
    const auto contender = task.contender(choice).make({&scene, &task});
    auto answers = task.make_answers();
    contender->build();
    contender->query(*answers);
    return answers;
}

} // namespace boxwood::bench
