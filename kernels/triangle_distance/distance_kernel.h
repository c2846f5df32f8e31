#pragma once

#include "kernels/primitives/segment.h"
#include "kernels/primitives/triangle.h"
#include "kernels/triangle_triangle/triangle_kernel.h"
#include "kernels/verdict.h"

#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>

namespace boxwood {

/// The least distance of two closed sets, scene units, and where it is taken.
/// A certified rung promises lo <= true distance <= hi, and 0 <= lo; `distance` lies between.
/// A rung without a bound sets lo = hi = distance. If NaN went in, all three are NaN.
struct Distance {
    double distance = 0, lo = 0, hi = 0;
    Vec3<double> point_a{}, point_b{}; ///< witnesses, one on each side, up to rounding
    std::uint8_t tier = 0;             ///< of the rung that decided, 0 is the cheapest
};

/// Distance kernels, by what they take. Each may be degenerate. K::Real is what it reads.
template <class K>
concept TriangleDistanceKernel = requires(const Triangle<typename K::Real>& a,
                                          const Triangle<typename K::Real>& b) {
    { K::name } -> std::convertible_to<std::string_view>;
    { K::info } -> std::convertible_to<KernelInfo>;
    { K::distance(a, b) } -> std::same_as<Distance>;
};
template <class K>
concept SegmentDistanceKernel = requires(const Segment<typename K::Real>& a,
                                         const Segment<typename K::Real>& b) {
    { K::name } -> std::convertible_to<std::string_view>;
    { K::info } -> std::convertible_to<KernelInfo>;
    { K::distance(a, b) } -> std::same_as<Distance>;
};
template <class K>
concept PointTriangleKernel = requires(Vec3<typename K::Real> a,
                                       const Triangle<typename K::Real>& b) {
    { K::name } -> std::convertible_to<std::string_view>;
    { K::info } -> std::convertible_to<KernelInfo>;
    { K::distance(a, b) } -> std::same_as<Distance>;
};
template <class K>
concept PointSegmentKernel = requires(Vec3<typename K::Real> a,
                                      const Segment<typename K::Real>& b) {
    { K::name } -> std::convertible_to<std::string_view>;
    { K::info } -> std::convertible_to<KernelInfo>;
    { K::distance(a, b) } -> std::same_as<Distance>;
};

/// A TriangleDistanceKernel that also answers many pairs at a time, the same as one by one.
/// distances.size() <= blocks.size() * lanes; lanes beyond it are read but not answered.
template <class K>
concept TriangleDistanceBatchKernel = TriangleDistanceKernel<K> &&
    requires(std::span<const TrianglePairBlock<typename K::Real>> blocks,
             std::span<Distance> distances) {
    K::distance(blocks, distances);
};

} // namespace boxwood
