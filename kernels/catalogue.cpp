#include "kernels/catalogue.h"

#include <algorithm>
#include <array>

namespace boxwood {
namespace {

constexpr KernelInfo closed_overlap{"box_box", "overlaps",
                                    "closed boxes share a point: six comparisons, no arithmetic",
                                    Promise::exact};

template <class... K>
constexpr std::array<KernelInfo, sizeof...(K)> rows(std::type_identity<std::tuple<K...>>) {
    return {K::info...};
}
constexpr auto ray_rows = rows(std::type_identity<RayKernels>{});
constexpr auto triangle_rows = rows(std::type_identity<TriangleKernels>{});

constexpr auto all_rows = [] {
    std::array<KernelInfo, 2 + ray_rows.size() + triangle_rows.size()> all{closed_overlap,
                                                                           RaySlabs::info};
    const auto end = std::copy(ray_rows.begin(), ray_rows.end(), all.begin() + 2);
    std::copy(triangle_rows.begin(), triangle_rows.end(), end);
    return all;
}();

} // namespace

std::span<const KernelInfo> kernels() { return all_rows; }
std::span<const KernelInfo> ray_kernels() { return ray_rows; }
std::span<const KernelInfo> triangle_kernels() { return triangle_rows; }

} // namespace boxwood
