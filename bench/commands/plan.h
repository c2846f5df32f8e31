#pragma once

#include "bench/stages/plan_stages.h"
#include "scenes/moving/moving_scene.h"
#include "trees/device_memory.h"
#include "trees/executor.h"

#include <cstddef>
#include <string>

namespace boxwood::bench {

/// The plan of a scene as a table, or as one JSON object.
std::string plan_text(const MovingScene& scene, Extent extent, bool json,
                      Where where = Where::host);

/// Where a scene can be played on a device: resident, if all that it requires has a form there.
/// Throws BadInput if nothing has.
Where where_on_device(const MovingScene& scene);

/// What the stages did in so many frames beyond the start: only those required beside all of them,
/// or beside those required with a device, with the shares of their times. The two are played in
/// turns, frame by frame. Throws std::runtime_error if their answers differ.
std::string played_text(const SceneFile& file, std::size_t frames, const Executor& executor,
                        Where where = Where::host, DevicePlace place = {});

} // namespace boxwood::bench
