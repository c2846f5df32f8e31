#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boxwood::detail {

/// One of each `max_items` equal parts of the items 0 .. n - 1, ascending, all of them if they are
/// fewer: somewhere in its part, so that no pattern in the numbers goes unseen.
inline std::vector<std::uint32_t> sampled_items(std::size_t n, std::size_t max_items) {
    std::vector<std::uint32_t> items(std::min(max_items, n));
    for (std::size_t i = 0; i < items.size(); ++i) {
        const std::size_t begin = n * i / items.size(), end = n * (i + 1) / items.size();
        items[i] = static_cast<std::uint32_t>(begin + (i * 2654435769u >> 8) % (end - begin));
    }
    return items;
}

} // namespace boxwood::detail
