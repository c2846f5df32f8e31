#pragma once

#include "scenes/moving/scene_file.h"
#include "scenes/scene.h"

#include <span>

namespace boxwood {

/// Frames of a scene of effects where nothing else is said.
inline constexpr std::size_t default_frames = 20;

/// The scene file that nobody wrote: what a generator makes (generator, n, seed and overlaps of
/// the spec), every box a body, and effects laid on all of them. Its name says so:
/// "uniform_overlaps1_drift_speed1_share0_01". Throws std::invalid_argument for an unknown or bad
/// name or setting and for a generator of triangles, which would be one body.
SceneFile effect_scene(const SceneSpec& spec, std::span<const EffectChoice> effects);

} // namespace boxwood
