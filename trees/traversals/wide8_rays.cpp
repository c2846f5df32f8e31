// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide8_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/node_rays-inl.h"
#include "trees/queries/rays.h"
#include "trees/traversals/single_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

void Wide8Rays(const RayJob& job) { WalkJob<RayNode<8>>(job); }
SingleRayWalks Wide8SingleRays(std::size_t depth, std::string_view kernel) {
    return WalksAlone<RayNode<8>>(depth, kernel);
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(Wide8Rays);
HWY_EXPORT(Wide8SingleRays);

void walk_rays(const Wide8Layout&, const RayJob& job) { HWY_DYNAMIC_DISPATCH(Wide8Rays)(job); }
void walk_rays(const Wide8LayoutF64&, const RayJob& job) { HWY_DYNAMIC_DISPATCH(Wide8Rays)(job); }
SingleRayWalks single_ray_walks(const Wide8Layout& layout, std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Wide8SingleRays)(layout.depth(), kernel);
}
SingleRayWalks single_ray_walks(const Wide8LayoutF64& layout, std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Wide8SingleRays)(layout.depth(), kernel);
}

} // namespace boxwood
#endif
