#pragma once

#include "kernels/primitives/aabb.h"

#include <filesystem>
#include <string_view>
#include <vector>

namespace boxwood {

/// The boxes of bodies frame by frame, as somebody recorded them: as many in each frame.
using Recording = std::vector<std::vector<Aabb<float>>>;

/// What sweep files call the scenes that are read from such files.
inline constexpr std::string_view motion_scene = "motion";

/// From a CSV file with rows of frame,body,min_x,min_y,min_z,max_x,max_y,max_z: frames and bodies
/// count from 0, frames ascend, frame 0 has every body, and a body without a row stays as it was.
/// Throws std::runtime_error, "file:line: ...", for anything else, and for fewer than two frames.
Recording read_recording(const std::filesystem::path& file);

} // namespace boxwood
