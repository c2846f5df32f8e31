/// The rays of one layout: BOXWOOD_RAY_NODE is its node, HWY_TARGET_INCLUDE the including file,
/// which is compiled once per instruction set; the best one is chosen at run time.

#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/rays/node_rays-inl.h"
#include "trees/traversals/rays/ray_traversal.h"
#include "trees/traversals/rays/single_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

void layout_rays(const RayJob& job) { traverse_job<BOXWOOD_RAY_NODE>(job); }
SingleRayFunctions single_rays(std::size_t depth, std::string_view kernel) {
    return single_ray_functions_of<BOXWOOD_RAY_NODE>(depth, kernel);
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(layout_rays);
HWY_EXPORT(single_rays);

template <> void traverse_nodes<BOXWOOD_RAY_NODE>(const RayJob& job) {
    HWY_DYNAMIC_DISPATCH(layout_rays)(job);
}
template <>
SingleRayFunctions single_ray_functions_of<BOXWOOD_RAY_NODE>(std::size_t depth,
                                                             std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(single_rays)(depth, kernel);
}

} // namespace boxwood::detail
#endif
