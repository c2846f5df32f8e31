// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide4_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/node_rays-inl.h"
#include "trees/queries/rays.h"
#include "trees/traversals/single_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

void Wide4Rays(const RayJob& job) { WalkJob<RayNode<4>>(job); }
SingleRayWalks Wide4SingleRays(std::size_t depth, std::string_view kernel) {
    return WalksAlone<RayNode<4>>(depth, kernel);
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(Wide4Rays);
HWY_EXPORT(Wide4SingleRays);

void walk_rays(const Wide4Layout&, const RayJob& job) { HWY_DYNAMIC_DISPATCH(Wide4Rays)(job); }
SingleRayWalks single_ray_walks(const Wide4Layout& layout, std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Wide4SingleRays)(layout.depth(), kernel);
}

} // namespace boxwood
#endif
