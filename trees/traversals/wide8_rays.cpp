// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide8_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/node_rays-inl.h"
#include "trees/traversals/ray_traversal.h"
#include "trees/traversals/single_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

void Wide8Rays(const RayJob& job) { TraverseJob<RayNode<8>>(job); }
SingleRayFunctions Wide8SingleRays(std::size_t depth, std::string_view kernel) {
    return SingleRayFunctionsOf<RayNode<8>>(depth, kernel);
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(Wide8Rays);
HWY_EXPORT(Wide8SingleRays);

template <> void traverse_nodes<RayNode<8>>(const RayJob& job) {
    HWY_DYNAMIC_DISPATCH(Wide8Rays)(job);
}
template <>
SingleRayFunctions single_ray_functions_of<RayNode<8>>(std::size_t depth, std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Wide8SingleRays)(depth, kernel);
}

} // namespace boxwood::detail
#endif
