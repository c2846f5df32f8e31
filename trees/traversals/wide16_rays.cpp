// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide16_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/node_rays-inl.h"
#include "trees/traversals/ray_traversal.h"
#include "trees/traversals/single_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

void Wide16Rays(const RayJob& job) { TraverseJob<RayNode<16>>(job); }
SingleRayFunctions Wide16SingleRays(std::size_t depth, std::string_view kernel) {
    return SingleRayFunctionsOf<RayNode<16>>(depth, kernel);
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(Wide16Rays);
HWY_EXPORT(Wide16SingleRays);

template <> void traverse_nodes<RayNode<16>>(const RayJob& job) {
    HWY_DYNAMIC_DISPATCH(Wide16Rays)(job);
}
template <>
SingleRayFunctions single_ray_functions_of<RayNode<16>>(std::size_t depth,
                                                        std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Wide16SingleRays)(depth, kernel);
}

} // namespace boxwood::detail
#endif
