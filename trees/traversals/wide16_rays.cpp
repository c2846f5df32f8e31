// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide16_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/node_rays-inl.h"
#include "trees/queries/rays.h"
#include "trees/traversals/single_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

void Wide16Rays(const RayJob& job) { WalkJob<RayNode<16>>(job); }
SingleRayWalks Wide16SingleRays(std::size_t depth, std::string_view kernel) {
    return WalksAlone<RayNode<16>>(depth, kernel);
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(Wide16Rays);
HWY_EXPORT(Wide16SingleRays);

void walk_rays(const Wide16Layout&, const RayJob& job) { HWY_DYNAMIC_DISPATCH(Wide16Rays)(job); }
void walk_rays(const PackedLayout&, const RayJob& job) { HWY_DYNAMIC_DISPATCH(Wide16Rays)(job); }
SingleRayWalks single_ray_walks(const Wide16Layout& layout, std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Wide16SingleRays)(layout.depth(), kernel);
}
SingleRayWalks single_ray_walks(const PackedLayout& layout, std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Wide16SingleRays)(layout.depth(), kernel);
}

} // namespace boxwood
#endif
