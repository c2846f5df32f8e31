#pragma once

#include "scenes/moving/scene_file.h"
#include "scenes/moving/toml_reader.h"

namespace boxwood {

/// An effect as scene files and sweep files lay it on bodies: "drift", or {name = "drift",
/// share = 0.5, speed = 2}. Throws as TomlReader.
EffectChoice read_effect(const TomlReader& reader, const toml::node& node);

} // namespace boxwood
