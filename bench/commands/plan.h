#pragma once

#include "bench/stages/plan_stages.h"
#include "scenes/moving/moving_scene.h"
#include "trees/executor.h"

#include <cstddef>
#include <string>

namespace boxwood::bench {

/// The plan of a scene as a table, or as one JSON object.
std::string plan_text(const MovingScene& scene, Extent extent, bool json);

/// What the stages did in so many frames beyond the start: only those required beside all of them,
/// with the shares of their times. The two are played in turns, frame by frame.
/// Throws std::runtime_error if their answers differ.
std::string played_text(const SceneFile& file, std::size_t frames, const Executor& executor);

} // namespace boxwood::bench
