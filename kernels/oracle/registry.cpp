#include "kernels/oracle/registry.h"

#include <array>

namespace boxwood::oracle {
namespace {

template <class... Tuples> constexpr auto infos() {
    return []<class... K>(std::type_identity<std::tuple<K...>>) {
        return std::array<KernelInfo, sizeof...(K)>{K::info...};
    }(std::type_identity<decltype(std::tuple_cat(std::declval<Tuples>()...))>{});
}
constexpr auto all =
    infos<RationalTriangleKernels, RationalTriangleDistanceKernels, RationalSegmentDistanceKernels,
          RationalPointTriangleKernels, RationalPointSegmentKernels, RationalRayKernels>();

} // namespace

std::span<const KernelInfo> rational_kernels() { return all; }

} // namespace boxwood::oracle
