#pragma once

#include "bench/plan/block_reader.h"
#include "bench/tasks/task.h"
#include "scenes/scene.h"

#include <string>
#include <string_view>
#include <vector>

/// The scenes that a block names, by the kind that its tasks take.
namespace boxwood::bench {

/// Keys: scene, n, overlaps. `mesh_is_for`: what triangles are needed for ("aim rays at"), or
/// empty if boxes are enough. None of a scene read from a file where the sweep has none.
std::vector<SceneSpec> still_scenes(const BlockReader& block, std::string_view mesh_is_for = {});

/// Keys: scene, n, overlaps, effects, frames. Every moving scene that is named, and every generator
/// with each of the effects.
std::vector<SceneSpec> moving_scenes(const BlockReader& block);

/// Keys: scene, n, k, scale. Every family that the names stand for and that has cases for the task.
std::vector<SceneSpec> case_scenes(const BlockReader& block, const Task& task);

} // namespace boxwood::bench
