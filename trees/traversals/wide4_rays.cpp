// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide4_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/node_rays-inl.h"
#include "trees/traversals/ray_traversal.h"
#include "trees/traversals/single_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

void Wide4Rays(const RayJob& job) { TraverseJob<RayNode<4>>(job); }
SingleRayFunctions Wide4SingleRays(std::size_t depth, std::string_view kernel) {
    return SingleRayFunctionsOf<RayNode<4>>(depth, kernel);
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(Wide4Rays);
HWY_EXPORT(Wide4SingleRays);

template <> void traverse_nodes<RayNode<4>>(const RayJob& job) {
    HWY_DYNAMIC_DISPATCH(Wide4Rays)(job);
}
template <>
SingleRayFunctions single_ray_functions_of<RayNode<4>>(std::size_t depth, std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Wide4SingleRays)(depth, kernel);
}

} // namespace boxwood::detail
#endif
