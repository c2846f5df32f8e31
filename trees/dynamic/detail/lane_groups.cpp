#include "trees/dynamic/detail/lane_groups.h"

#include <algorithm>

namespace boxwood::detail {
namespace {

/// The share of all pairs of items that may meet by their groups; 1 where these are too many kinds.
double meeting_share(std::span<const Groups> by_item) {
    struct Kind {
        Groups groups;
        double n;
    };
    constexpr std::size_t max_kinds = 32;
    std::vector<Kind> kinds;
    double all = 0, meeting = 0;
    for (const Groups& groups : by_item) {
        if (groups == Groups{0, 0})
            continue;
        auto kind = std::ranges::find(kinds, groups, &Kind::groups);
        if (kind == kinds.end()) {
            if (kinds.size() == max_kinds)
                return 1;
            kind = kinds.insert(kind, {groups, 0});
        }
        ++kind->n;
        ++all;
    }
    for (const Kind& a : kinds)
        for (const Kind& b : kinds)
            meeting += may_meet(a.groups, b.groups) ? a.n * b.n : 0;
    return all > 0 ? meeting / (all * all) : 1;
}

} // namespace

void LaneGroups::make(const PackedLayout& tree, std::span<const Groups> by_item) {
    constexpr std::size_t w = PackedLayout::width;
    keep_most_apart_ = meeting_share(by_item) < 1.0 / 8;
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
