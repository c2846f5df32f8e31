#include "trees/detail/places.h"

#include <algorithm>
#include <numeric>

namespace boxwood::detail {

std::vector<std::uint32_t> places_of(std::span<const Vec3<float>> vertices) {
    const auto before = [&](std::uint32_t i, std::uint32_t j) {
        const Vec3<float> a = vertices[i], b = vertices[j];
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    std::vector<std::uint32_t> order(vertices.size()), places(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, before);
    for (std::size_t i = 0; i < order.size(); ++i)
        places[order[i]] =
            i > 0 && !before(order[i - 1], order[i]) ? places[order[i - 1]] : order[i];
    return places;
}

} // namespace boxwood::detail
