// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/quantised8_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/node_rays-inl.h"
#include "trees/traversals/ray_traversal.h"
#include "trees/traversals/single_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

void Quantised8Rays(const RayJob& job) { TraverseJob<QuantisedBlock>(job); }
SingleRayFunctions Quantised8SingleRays(std::size_t depth, std::string_view kernel) {
    return SingleRayFunctionsOf<QuantisedBlock>(depth, kernel);
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(Quantised8Rays);
HWY_EXPORT(Quantised8SingleRays);

template <> void traverse_nodes<QuantisedBlock>(const RayJob& job) {
    HWY_DYNAMIC_DISPATCH(Quantised8Rays)(job);
}
template <>
SingleRayFunctions single_ray_functions_of<QuantisedBlock>(std::size_t depth,
                                                           std::string_view kernel) {
    return HWY_DYNAMIC_DISPATCH(Quantised8SingleRays)(depth, kernel);
}

} // namespace boxwood::detail
#endif
