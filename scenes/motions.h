#pragma once

#include "scenes/scene.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace boxwood {

/// A way in which the boxes of a scene move from frame to frame.
struct MotionEntry {
    std::string_view name, summary;
};
std::span<const MotionEntry> motions();

/// Frames of a motion where nothing else is said.
inline constexpr std::size_t default_frames = 20;

/// Throws std::invalid_argument, with a suggestion, for an unknown word.
void check_motion(std::string_view motion);

/// Frames 1 .. n_frames of boxes that are `boxes` in frame 0: the same bits on every machine. Boxes
/// keep their size up to rounding, stay valid, and their centres stay within the bounds of those of
/// frame 0. Throws as `check_motion`.
std::vector<Frame> make_frames(std::string_view motion, std::span<const Aabb<float>> boxes,
                               std::size_t n_frames, std::uint64_t seed);

} // namespace boxwood
