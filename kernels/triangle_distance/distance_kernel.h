#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/segment.h"
#include "kernels/primitives/triangle.h"
#include "kernels/triangle_triangle/triangle_kernel.h"

#include <concepts>
#include <cstdint>
#include <span>

namespace boxwood {

/// The minimum distance of two closed sets, scene units, and where it is taken.
/// A certified kernel promises lo <= true distance <= hi, and 0 <= lo; `distance` lies between. Of
/// its witnesses each is within 2^-44 M of its side, M the largest |coordinate| of both, and their
/// distance within 2^-44 M of [lo, hi]; if the two touch 2^-22 M, as where thin ones cross is
/// ill-conditioned. Denormals: 2^-1070 more.
/// A kernel without a bound sets lo = hi = distance. If NaN went in, all three are NaN.
struct Distance {
    double distance = 0, lo = 0, hi = 0;
    Vec3<double> point_a{}, point_b{}; ///< witnesses, one on each side
    std::uint8_t tier = 0;             ///< of the level that decided, 0 is the cheapest
};

/// Distance kernels, by what they take. Each may be degenerate. K::Real is what it reads.
template <class K>
concept TriangleDistanceKernel = DescribedKernel<K> &&
    requires(const Triangle<typename K::Real>& a, const Triangle<typename K::Real>& b) {
    { K::distance(a, b) } -> std::same_as<Distance>;
};
template <class K>
concept SegmentDistanceKernel = DescribedKernel<K> &&
    requires(const Segment<typename K::Real>& a, const Segment<typename K::Real>& b) {
    { K::distance(a, b) } -> std::same_as<Distance>;
};
template <class K>
concept PointTriangleKernel = DescribedKernel<K> &&
    requires(Vec3<typename K::Real> a, const Triangle<typename K::Real>& b) {
    { K::distance(a, b) } -> std::same_as<Distance>;
};
template <class K>
concept PointSegmentKernel = DescribedKernel<K> &&
    requires(Vec3<typename K::Real> a, const Segment<typename K::Real>& b) {
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
