#pragma once

#include "bench/ours.h"

namespace boxwood::bench {

/// Our contender for a ray ask, by the layout and the kernel and in the ray order of the choice.
std::unique_ptr<Contender> make_rays(const Job& job, BuildFunction build, const LayoutEntry& layout,
                                     const std::string& kernel, bool sorted);

/// The orders in which a batch of rays may be walked: words for `ray_order`.
struct RayOrderEntry {
    std::string_view name, summary;
};
std::span<const RayOrderEntry> ray_orders();

/// Whether an ask's rays may be walked in another order than the given one.
inline bool has_ray_order(Ask ask) { return ask == Ask::rays_closest || ask == Ask::rays_any; }

} // namespace boxwood::bench
