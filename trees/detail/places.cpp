#include "trees/detail/places.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace boxwood::detail {

std::vector<std::uint32_t> places_of(std::span<const Vec3<float>> vertices) {
    const auto before = [&](std::uint32_t i, std::uint32_t j) {
        const Vec3<float> a = vertices[i], b = vertices[j];
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    std::vector<std::uint32_t> places(vertices.size());
    std::iota(places.begin(), places.end(), 0u);
    std::vector<std::uint32_t> order; // a NaN has no place in it
    order.reserve(vertices.size());
    std::ranges::copy_if(places, std::back_inserter(order), [&](std::uint32_t i) {
        const Vec3<float>& v = vertices[i];
        return !std::isnan(v.x) && !std::isnan(v.y) && !std::isnan(v.z);
    });
    std::ranges::sort(order, before);
    for (std::size_t i = 0; i < order.size(); ++i)
        places[order[i]] =
            i > 0 && !before(order[i - 1], order[i]) ? places[order[i - 1]] : order[i];
    return places;
}

} // namespace boxwood::detail
