#pragma once

#include "scenes/scene.h"

namespace boxwood {

/// The registry row of a generator type. A generator NAME is the file generators/NAME.cpp, which
/// defines `SceneEntry NAME_scene()` by this, and the name X(NAME) in registry.cpp.
template <SceneGenerator G> SceneEntry scene_entry() {
    return {G::name, G::human_name, G::summary, G::generate, G::has_mesh, G::uses_overlaps};
}

/// The row of that name. Throws std::invalid_argument, with a suggestion, for an unknown one.
const SceneEntry& scene_generator(std::string_view name);

} // namespace boxwood
