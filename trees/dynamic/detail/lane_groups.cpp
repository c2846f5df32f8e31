#include "trees/dynamic/detail/lane_groups.h"

#include <algorithm>

namespace boxwood::detail {

void LaneGroups::make(const PackedLayout& tree, std::span<const Groups> by_item) {
    constexpr std::size_t w = PackedLayout::width;
    std::size_t blocks = 0;
    for (std::size_t l = 0; l < tree.depth(); ++l) {
        first_[l] = blocks;
        blocks += tree.level(l).size();
    }
    blocks_.assign(blocks, {});
    for (std::size_t slot = 0; slot < tree.size(); ++slot) {
        const std::uint32_t item = tree.items()[slot];
        const Groups groups = item < by_item.size() ? by_item[item] : Groups{0, 0};
        blocks_[slot / w].own[slot % w] = groups.own;
        blocks_[slot / w].meets[slot % w] = groups.meets;
    }
    for (std::size_t l = 1; l < tree.depth(); ++l)
        for (std::size_t below = 0; below < tree.level(l - 1).size(); ++below) {
            const Groups all = block(l - 1, below).all();
            GroupBlock& above = blocks_[first_[l] + below / w];
            above.own[below % w] = all.own;
            above.meets[below % w] = all.meets;
        }
}

} // namespace boxwood::detail
