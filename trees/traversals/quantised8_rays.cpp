// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/quantised8_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/node_rays-inl.h"
#include "trees/queries/rays.h"
#include "trees/traversals/single_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

void Quantised8Rays(const RayJob& job) { WalkJob<QuantisedBlock>(job); }
SingleRayWalks Quantised8SingleRays(std::size_t depth, std::string_view kernel) {
    return WalksAlone<QuantisedBlock>(depth, kernel);
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(Quantised8Rays);
HWY_EXPORT(Quantised8SingleRays);

void walk_rays(const Quantised8Layout&, const RayJob& job) {
    HWY_DYNAMIC_DISPATCH(Quantised8Rays)(job);
}
SingleRayWalks single_ray_walks(const Quantised8Layout& layout, std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Quantised8SingleRays)(layout.depth(), kernel);
}

} // namespace boxwood
#endif
