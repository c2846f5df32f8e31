#pragma once

#include "scenes/moving/moving_scene.h"
#include "trees/world/bodies/ledger.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// How much of what could be done for a scene is done. The answers are the same.
enum class Extent : std::uint8_t {
    required,  ///< what the scene requires, for the bodies that it requires
    all_stages ///< every stage that its queries could need, for every body in every frame
};

/// Where a scene is played.
enum class Where : std::uint8_t {
    host,
    device,  ///< trees and pairs on a device: in each frame boxes go up and pairs come down
    resident ///< all on a device: the bodies stay there, and only pairs come down
};

/// One stage of the plan of a scene, which requires it or not whatever the extent.
struct PlannedStage : boxwood::PlannedStage {
    std::string effect{}; ///< that the stage advances; empty for the others
    bool runs = false;    ///< in this extent; what does not run is not made and has no memory
    /// "has no device form where ...", or empty: it has one.
    std::string host_only{};
    bool on_device = false; ///< it runs there
};

/// All stages there are, in the order in which they run: one for each of `effects()`, move, fit,
/// tree, update, box_tree, pairs, filter, transform, mesh_trees, triangle_pairs, surface, aim,
/// rays, points, regions, nearest. On a device also upload, before the first stage there, and
/// download, after pairs.
std::vector<PlannedStage> plan_stages(const MovingScene& scene, Extent extent,
                                      Where where = Where::host);

/// Why the scene cannot be played there, if so: "stage advance_orbit has no device form".
std::optional<std::string> why_not(const MovingScene& scene, Extent extent, Where where);

/// The effect that the stage of this name advances; empty for the others.
std::string_view advanced_effect(std::string_view stage);

/// The stage of this name; there must be one.
const PlannedStage& stage_of(std::span<const PlannedStage> plan, std::string_view name);

} // namespace boxwood::bench
