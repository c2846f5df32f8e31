#pragma once

#include "scenes/moving/scene_file.h"

#include <cstddef>
#include <string>

namespace boxwood::bench {

inline constexpr std::size_t max_in_strip = 200;        ///< bodies
inline constexpr std::size_t max_strip_bytes = 100'000; ///< a file holds those of many scenes

/// The first, the middle and the last frame of a scene side by side, as SVG for the report, meshes
/// by their hulls, drawn with `max_in_strip` bodies where the scene has more, fewer where that is
/// too long a text. Empty if nothing is short enough.
std::string scene_strip(const SceneFile& file);

} // namespace boxwood::bench
