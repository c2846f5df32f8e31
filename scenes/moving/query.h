#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/ray.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

class MovingScene;

/// What a scene wants to know of each frame. What a query has no key for is 0 or empty.
struct SceneQuery {
    std::string name{}; ///< a name of `scene_queries()`
    std::string kind{}; ///< of rays, points, regions: a name of `query_kinds()`
    std::size_t n = 0;  ///< number of rays, points or regions
    std::size_t k = 0;  ///< of nearest: neighbours of each
    double size = 0;    ///< of regions: mean side, in mean body sides
};

/// What a query places in the scene.
enum class Probes : std::uint8_t { none, rays, points, regions };

/// A registry row: the keys that the query takes beside its name, and their defaults.
struct SceneQueryEntry {
    std::string_view name, summary;
    std::vector<std::string_view> keys; ///< of kind, n, k, size
    SceneQuery defaults;
    Probes probes = Probes::none;
};
std::span<const SceneQueryEntry> scene_queries();

/// Where the rays, points and regions of a query are.
struct QueryKindEntry {
    std::string_view name, summary;
    bool follows_camera = false; ///< the one that flies through the bounds
};
std::span<const QueryKindEntry> query_kinds();

/// What the query of that name places; none for an unknown one.
Probes probes_of(std::string_view query);

// What a query needs in the scene's present frame, the same bits on every machine: ray, point or
// region i depends on the scene's seed and bounds, the frame and i. They replace what `out` holds.

/// flying: a pinhole camera's; scattered: from anywhere in the bounds in any direction.
void rays_of_frame(const MovingScene& scene, const SceneQuery& query, std::vector<Ray<float>>& out);
/// flying: around the camera; scattered: anywhere in the bounds.
void points_of_frame(const MovingScene& scene, const SceneQuery& query,
                     std::vector<Vec3<float>>& out);
/// Closed boxes around such points, of half to one and a half the size.
void regions_of_frame(const MovingScene& scene, const SceneQuery& query,
                      std::vector<Aabb<float>>& out);

} // namespace boxwood
