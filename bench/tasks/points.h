#pragma once

#include "bench/tasks/contender.h"

namespace boxwood::bench {

/// How many neighbours of each point the ask nearest wants: the scene's k, or 1.
inline std::size_t neighbours_of(const Scene& scene) {
    return static_cast<std::size_t>(scene.spec.k.value_or(1));
}

/// Our contender for an ask of points or regions (is_point_ask).
std::unique_ptr<Contender> make_point_queries(const Job& job, BuildFunction build,
                                              const LayoutEntry& layout);

/// Why a scene has nothing for an ask of points or regions, if so; nothing of no scene (null).
std::optional<std::string> no_queries(const Scene* scene, Ask ask);

} // namespace boxwood::bench
