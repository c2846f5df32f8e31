#pragma once

#include "kernels/boxes/fit.h"
#include "kernels/boxes/sat.h"
#include "kernels/continuous/cubic.h"
#include "kernels/continuous/tight_inclusion.h"
#include "kernels/decision.h"
#include "kernels/features/point_segment.h"
#include "kernels/features/point_triangle.h"
#include "kernels/features/segment_segment.h"
#include "kernels/predicates/rounded.h"
#include "kernels/ray_box/plain.h"
#include "kernels/ray_box/slabs.h"
#include "kernels/ray_triangle/baldwin_weber.h"
#include "kernels/ray_triangle/exact.h"
#include "kernels/ray_triangle/moller_trumbore.h"
#include "kernels/ray_triangle/plucker.h"
#include "kernels/ray_triangle/watertight.h"
#include "kernels/triangle_distance/certified.h"
#include "kernels/triangle_distance/features.h"
#include "kernels/triangle_distance/features_batch.h"
#include "kernels/triangle_triangle/exact.h"
#include "kernels/triangle_triangle/guigue_devillers.h"
#include "kernels/triangle_triangle/guigue_devillers_batch.h"
#include "kernels/triangle_triangle/moller.h"
#include "kernels/triangle_triangle/sat.h"
#include "kernels/triangle_triangle/sat_certified.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace boxwood {

/// The kernels of each family: to add one, write its file and put its type here.
using RayBoxKernels = std::tuple<PlainSlabs, RaySlabs>;
using RayKernels = std::tuple<MollerTrumbore<float>, BaldwinWeber, Plucker, Watertight,
                              MollerTrumbore<double>, ExactRayTriangle>;
using TriangleKernels =
    std::tuple<MollerF32, MollerF64, SatF64, SatCertified, GuigueDevillersF32, GuigueDevillersF64,
               GuigueDevillersFiltered, GuigueDevillersExact, GuigueDevillersF32Batch,
               GuigueDevillersExactF32Batch, GuigueDevillersExactBatch>;
using DistanceKernels =
    std::tuple<FeaturesF32, FeaturesF64, FeaturesF64Batch, CrossProductF64, CertifiedDistance>;
using SegmentDistanceKernels =
    std::tuple<SegmentSegmentF32, SegmentSegmentF64, SegmentSegmentCross>;
using PointTriangleKernels = std::tuple<PointTriangleF32, PointTriangleF64, PointTriangleCross>;
using PointSegmentKernels = std::tuple<PointSegmentF32, PointSegmentF64>;
using BoxFitKernels =
    std::tuple<PlainFit<float>, PlainFit<double>, PaddedFit<float>, PaddedFit<double>>;
using ObbKernels =
    std::tuple<PlainSat<float>, PlainSat<double>, CertifiedSat<float>, CertifiedSat<double>>;
/// Rows vertex_face and edge_edge each.
using ContinuousKernels = std::tuple<CubicF64, TightInclusion>;

/// The ray kernels by name, in the order of RayKernels.
enum class RayKernelName : std::uint8_t {
    moller_trumbore_f32,
    baldwin_weber_f32,
    plucker_f32,
    watertight,
    moller_trumbore_f64,
    exact
};

/// Every kernel of every family: what `boxwood list kernels` prints.
std::span<const KernelInfo> kernels();

/// The rows of ray_triangle and of triangle_triangle: a name for `--kernel` each.
std::span<const KernelInfo> ray_kernels();
std::span<const KernelInfo> triangle_kernels();
inline std::string_view to_string(RayKernelName kernel) {
    return ray_kernels()[static_cast<std::size_t>(kernel)].name;
}

/// Calls f(std::type_identity<K>{}) for the kernel K of `Kernels` (RayKernels, TriangleKernels)
/// whose name is `name`. False if there is none.
template <class Kernels, class F> bool with_kernel(std::string_view name, F&& f) {
    return [&]<class... K>(std::type_identity<std::tuple<K...>>) {
        return ((K::name == name && (f(std::type_identity<K>{}), true)) || ...);
    }(std::type_identity<Kernels>{});
}

} // namespace boxwood
