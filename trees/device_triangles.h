#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/triangle.h"
#include "kernels/triangle_distance/float_pair.h"
#include "trees/device_memory.h"
#include "trees/queries/sinks.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Kernels of two triangles of floats, for lists of pairs on a device. Throw DeviceError,
/// DeviceOutOfMemory, and std::length_error for 2^32 - 1 pairs or more.
namespace boxwood {

/// The accuracy level (kernels/triangle_triangle/float_pair.h, triangle_distance/float_pair.h).
/// exact decides in integers what certified leaves open.
enum class DeviceAccuracy : std::uint8_t { plain, plain_in_doubles, certified, exact };

/// Triangles on a device: of an indexed mesh, or without `corners` three vertices each.
struct DeviceTriangles {
    DeviceSpan<const Vec3<float>> vertices;
    DeviceSpan<const std::array<std::uint32_t, 3>> corners{};
};

/// What accuracy costs: how many pairs certified leaves open, and how many of them exact decided in
/// its longest integers.
struct UncertainPairs {
    std::uint32_t n = 0, in_longest = 0;
};

/// Answers by pair, right for what follows in the stream.
template <class T> struct DevicePairAnswers {
    DeviceArray<T> of;
    DeviceArray<UncertainPairs> uncertain; ///< one, of certified and exact
};

using DistanceBounds = float_pair::Bounds; ///< lo = hi of plain ones; NaN where not finite

/// Whether triangle pair.a of `a` and pair.b of `b` share a point. All are there: nobody looks.
DevicePairAnswers<Answer> triangles_touch(const DeviceTriangles& a, const DeviceTriangles& b,
                                          DeviceSpan<const Pair> pairs, DeviceAccuracy accuracy,
                                          DevicePlace place = {});
/// Those of the pairs that are not answered no, in their order. Waits.
DeviceArray<Pair> touching_pairs(const DeviceTriangles& a, const DeviceTriangles& b,
                                 DeviceSpan<const Pair> pairs, DeviceAccuracy accuracy,
                                 DevicePlace place = {});
/// How far apart they are.
DevicePairAnswers<DistanceBounds>
triangle_distances(const DeviceTriangles& a, const DeviceTriangles& b, DeviceSpan<const Pair> pairs,
                   DeviceAccuracy accuracy, DevicePlace place = {});

/// From host to host. std::invalid_argument for a pair of a triangle that is not there.
std::vector<Answer> triangles_touch(std::span<const Triangle<float>> a,
                                    std::span<const Triangle<float>> b, std::span<const Pair> pairs,
                                    DeviceAccuracy accuracy, DevicePlace place = {});
std::vector<DistanceBounds> triangle_distances(std::span<const Triangle<float>> a,
                                               std::span<const Triangle<float>> b,
                                               std::span<const Pair> pairs, DeviceAccuracy accuracy,
                                               DevicePlace place = {});

} // namespace boxwood
