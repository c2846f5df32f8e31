#include "kernels/registry.h"

#include "kernels/convex/first_contact.h"
#include "kernels/convex/signed_distance.h"

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

constexpr std::array convex_rows{convex::closed_form_info, convex::gjk_epa_info,
                                 convex::first_contact_info};

template <class Kernels> constexpr auto rows() {
    return []<class... K>(std::type_identity<std::tuple<K...>>) {
        return std::array{KernelInfo{K::info}...};
    }(std::type_identity<Kernels>{});
}
constexpr auto ray_rows = rows<RayKernels>();
constexpr auto triangle_rows = rows<TriangleKernels>();

/// vertex_face, then edge_edge.
constexpr auto motion_rows = []<class... K>(std::type_identity<std::tuple<K...>>) {
    return std::array{KernelInfo{K::vertex_face_info}..., KernelInfo{K::edge_edge_info}...};
}(std::type_identity<ContinuousKernels>{});

template <std::size_t... n> constexpr auto concatenated(const std::array<KernelInfo, n>&... parts) {
    std::array<KernelInfo, (n + ...)> all{};
    auto to = all.begin();
    ((to = std::copy(parts.begin(), parts.end(), to)), ...);
    return all;
}
constexpr auto all_rows =
    concatenated(std::array{closed_overlap}, rows<RayBoxKernels>(), ray_rows, triangle_rows,
                 rows<DistanceKernels>(), rows<SegmentDistanceKernels>(),
                 rows<PointTriangleKernels>(), rows<PointSegmentKernels>(), rows<BoxFitKernels>(),
                 rows<ObbKernels>(), motion_rows, convex_rows);

} // namespace

std::span<const KernelInfo> kernels() { return all_rows; }
std::span<const KernelInfo> ray_kernels() { return ray_rows; }
std::span<const KernelInfo> triangle_kernels() { return triangle_rows; }

} // namespace boxwood
