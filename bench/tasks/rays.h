#pragma once

#include "bench/tasks/ours.h"

namespace boxwood::bench {

/// The orders in which rays may be handed over and walked: words for `ray_order`.
struct RayOrderEntry {
    std::string_view name, summary;
    std::string_view traversal; ///< its word in the registry
};
std::span<const RayOrderEntry> ray_orders();

/// Our contender for a ray ask, by the layout and the kernel and in the ray order of the choice.
std::unique_ptr<Contender> make_rays(const Job& job, BuildFunction build, const LayoutEntry& layout,
                                     const std::string& kernel, const RayOrderEntry& order);

/// Whether an ask's rays may be walked in another order than the given one.
inline bool has_ray_order(Ask ask) { return ask == Ask::rays_closest || ask == Ask::rays_any; }

} // namespace boxwood::bench
