#include "kernels/registry.h"

#include <algorithm>
#include <array>

namespace boxwood {
namespace {

constexpr KernelInfo closed_overlap{"box_box",
                                    "overlaps",
                                    "closed boxes share a point: six comparisons, no arithmetic",
                                    Promise::exact,
                                    "0: nothing is rounded",
                                    "6 comparisons"};

template <class... K>
constexpr std::array<KernelInfo, sizeof...(K)> rows(std::type_identity<std::tuple<K...>>) {
    return {K::info...};
}
constexpr auto ray_box_rows = rows(std::type_identity<RayBoxKernels>{});
constexpr auto ray_rows = rows(std::type_identity<RayKernels>{});
constexpr auto triangle_rows = rows(std::type_identity<TriangleKernels>{});
constexpr auto distance_rows = rows(std::type_identity<DistanceKernels>{});
constexpr auto segment_distance_rows = rows(std::type_identity<SegmentDistanceKernels>{});
constexpr auto point_triangle_rows = rows(std::type_identity<PointTriangleKernels>{});
constexpr auto point_segment_rows = rows(std::type_identity<PointSegmentKernels>{});
constexpr auto box_fit_rows = rows(std::type_identity<BoxFitKernels>{});
constexpr auto obb_rows = rows(std::type_identity<ObbKernels>{});

template <class... K>
constexpr std::array<KernelInfo, 2 * sizeof...(K)>
continuous_rows(std::type_identity<std::tuple<K...>>) {
    return {K::vertex_face_info..., K::edge_edge_info...};
}
constexpr auto motion_rows = continuous_rows(std::type_identity<ContinuousKernels>{});

template <std::size_t... n> constexpr auto joined(const std::array<KernelInfo, n>&... parts) {
    std::array<KernelInfo, (n + ...)> all{};
    auto to = all.begin();
    ((to = std::copy(parts.begin(), parts.end(), to)), ...);
    return all;
}
constexpr auto all_rows = joined(std::array{closed_overlap}, ray_box_rows, ray_rows, triangle_rows,
                                 distance_rows, segment_distance_rows, point_triangle_rows,
                                 point_segment_rows, box_fit_rows, obb_rows, motion_rows);

} // namespace

std::span<const KernelInfo> kernels() { return all_rows; }
std::span<const KernelInfo> ray_box_kernels() { return ray_box_rows; }
std::span<const KernelInfo> ray_kernels() { return ray_rows; }
std::span<const KernelInfo> triangle_kernels() { return triangle_rows; }
std::span<const KernelInfo> distance_kernels() { return distance_rows; }
std::span<const KernelInfo> segment_distance_kernels() { return segment_distance_rows; }
std::span<const KernelInfo> point_triangle_kernels() { return point_triangle_rows; }
std::span<const KernelInfo> point_segment_kernels() { return point_segment_rows; }
std::span<const KernelInfo> box_fit_kernels() { return box_fit_rows; }
std::span<const KernelInfo> obb_kernels() { return obb_rows; }
std::span<const KernelInfo> vertex_face_kernels() {
    return std::span(motion_rows).first(motion_rows.size() / 2);
}
std::span<const KernelInfo> edge_edge_kernels() {
    return std::span(motion_rows).last(motion_rows.size() / 2);
}

} // namespace boxwood
