#pragma once

#include "scenes/moving/scene_file.h"
#include "scenes/scene.h"

#include <string>

namespace boxwood {

/// The name of a scene for people, beside its registry name:
///   "100,000 uniform boxes, 10 overlaps each"
///   "sphere mesh, 100,000 triangles, primary rays"
///   "100,000 uniform boxes, 10 overlaps each, 1 % drift"
/// Throws std::invalid_argument for an unknown generator.
std::string human_name(const SceneSpec& spec);

/// What a generator of this spec makes, without its number if it has none: "{n} uniform boxes, 10
/// overlaps each".
std::string generator_title(const SceneSpec& spec, const SceneEntry& entry);

/// "drift", "1 % drift" of a share of the bodies, "drift (speed 2)" with other settings.
std::string effect_title(const EffectChoice& effect);

} // namespace boxwood
