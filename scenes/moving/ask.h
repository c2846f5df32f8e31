#pragma once

#include "kernels/aabb.h"
#include "kernels/ray.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

class MovingScene;

/// What a scene file asks of each frame. What an ask has no key for is 0 or empty.
struct SceneAsk {
    std::string name{}; ///< a word of `scene_asks()`
    std::string kind{}; ///< of queries: a word of `query_kinds()`
    std::size_t n = 0;  ///< number of queries
    std::size_t k = 0;  ///< of nearest: neighbours of each
    double size = 0;    ///< of regions: mean side, in mean body sides
};

/// A catalogue row: the keys that the ask takes beside its name, and what they are if not given.
struct SceneAskEntry {
    std::string_view name, summary;
    std::vector<std::string_view> keys; ///< of kind, n, k, size
    SceneAsk defaults;
};
std::span<const SceneAskEntry> scene_asks();

/// How the queries of an ask go through the scene.
struct QueryKindEntry {
    std::string_view name, summary;
};
std::span<const QueryKindEntry> query_kinds();

// The queries of the scene's present frame, the same bits on every machine: query i depends on the
// scene's seed and room, the frame and i. They replace what `out` holds.

/// flying: a pinhole camera's; scattered: from anywhere in the room in any direction.
void rays_of_frame(const MovingScene& scene, const SceneAsk& ask, std::vector<Ray<float>>& out);
/// flying: around the camera; scattered: anywhere in the room.
void points_of_frame(const MovingScene& scene, const SceneAsk& ask, std::vector<Vec3<float>>& out);
/// Closed boxes around such points, of half to one and a half the size.
void regions_of_frame(const MovingScene& scene, const SceneAsk& ask, std::vector<Aabb<float>>& out);

} // namespace boxwood
