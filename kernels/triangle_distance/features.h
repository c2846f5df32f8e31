#pragma once

#include "kernels/triangle_distance/detail/nearest_pair.h"
#include "kernels/triangle_distance/distance_kernel.h"

namespace boxwood {

/// The minimum distance of two triangles over their features, and 0 where they cross, in plain
/// arithmetic. Sizes from 2^-900 to 2^1000 (float: all) make no difference. by_cross: the edges'
/// parameters are solved by their cross product.
template <class RealOf, bool by_cross> struct FeatureDistance {
    using Real = RealOf;

    static Distance distance(const Triangle<Real>& a, const Triangle<Real>& b) {
        return detail::measured<&detail::NearestPairSearch<Real, by_cross>::find>(a, b);
    }
};

struct FeaturesF32 : FeatureDistance<float, false> {
    static constexpr std::string_view name = "features_f32";
    static constexpr KernelInfo info{
        "triangle_distance",
        name,
        "9 pairs of edges (Ericson 2005) and 6 of corner and face, 0 if they cross, in floats",
        Promise::none,
        "none: about u (size / distance)^2, and edges nearly parallel lose more",
        "100 to 900 flops"};
};

struct FeaturesF64 : FeatureDistance<double, false> {
    static constexpr std::string_view name = "features_f64";
    static constexpr KernelInfo info{
        "triangle_distance",
        name,
        "9 pairs of edges (Ericson 2005) and 6 of corner and face, 0 if they cross",
        Promise::none,
        "none: about u size / distance, and edges nearly parallel lose more",
        "100 to 900 flops"};
};

/// The same with the pairs of edges solved by their cross product.
struct CrossProductF64 : FeatureDistance<double, true> {
    static constexpr std::string_view name = "cross_product_f64";
    static constexpr KernelInfo info{
        "triangle_distance",
        name,
        "15 features, edges solved by their cross product, which cancels nothing if they are "
        "nearly parallel",
        Promise::none,
        "relative error about u size / distance (measured, not proven)",
        "130 to 1100 flops"};
};

static_assert(TriangleDistanceKernel<FeaturesF32> && TriangleDistanceKernel<FeaturesF64> &&
              TriangleDistanceKernel<CrossProductF64>);

} // namespace boxwood
