#pragma once

#include "kernels/triangle_distance/distance_kernel.h"

namespace boxwood {

/// Features of eight pairs at a time. It compares them all, so that the time does not depend on the
/// input; one by one it does the same, and FeaturesF64 is faster for a single pair.
struct FeaturesF64Batch {
    using Real = double;
    static constexpr std::string_view name = "features_f64_batch";
    static constexpr KernelInfo info{
        "triangle_distance",
        name,
        "the 15 features and the crossing of eight pairs side by side, in SIMD",
        Promise::none,
        "none: about u size / distance, and edges nearly parallel lose more",
        "about 900 flops, side by side"};

    static Distance distance(const Triangle<double>& a, const Triangle<double>& b);
    /// Bit for bit the same on every instruction set.
    static void distance(std::span<const TrianglePairBlock<double>> blocks,
                         std::span<Distance> distances);
};

static_assert(TriangleDistanceBatchKernel<FeaturesF64Batch>);

} // namespace boxwood
