// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/builders/detail/ploc_tile.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/builders/detail/ploc_tile.h"

#include <algorithm>
#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The key of a pair (i, j) is the half area of their union with the last six bits of its float
/// replaced by those of i xor j. Both see the same key, and one cluster's keys differ even where
/// areas are equal, for |i - j| < 32. So the least key of all is the least of both its clusters:
/// each round merges some. Among equal areas i and i xor 1 come first: identical boxes halve.
void find_nearest(const PlocTile::View& tile, std::size_t radius) {
    constexpr hn::ScalableTag<float> df;
    constexpr hn::RebindToUnsigned<decltype(df)> du;
    constexpr std::size_t block = 128, halo = 32, lanes = hn::MaxLanes(df);
    // keys[d - 1][halo + i] is the key of (i, i + d) of the block; before it those of the last.
    alignas(64) std::uint32_t keys[31][halo + block];
    const auto none = hn::Set(du, ~0u), place_bits = hn::Set(du, PlocTile::place_bits);
    const auto area_bits = hn::Set(du, 0x7fffffff & ~PlocTile::place_bits);
    for (std::size_t d = 0; d < radius; ++d)
        for (std::size_t i = 0; i < halo; i += lanes)
            hn::Store(none, du, keys[d] + i);
    for (std::size_t first = 0; first < tile.size; first += block) {
        const std::size_t n = std::min(block, tile.size - first);
        for (std::size_t i = 0; i < n; i += lanes) {
            const std::size_t at = first + i;
            const auto load = [&](int k, std::size_t from)
                                  HWY_ATTR { return hn::LoadU(df, tile.at[k] + from); };
            const auto x0 = load(0, at), y0 = load(1, at), z0 = load(2, at);
            const auto x1 = load(3, at), y1 = load(4, at), z1 = load(5, at);
            const auto place = hn::Iota(du, static_cast<std::uint32_t>(at));
            for (std::size_t d = 1; d <= radius; ++d) {
                const auto x = hn::Sub(hn::Max(x1, load(3, at + d)), hn::Min(x0, load(0, at + d)));
                const auto y = hn::Sub(hn::Max(y1, load(4, at + d)), hn::Min(y0, load(1, at + d)));
                const auto z = hn::Sub(hn::Max(z1, load(5, at + d)), hn::Min(z0, load(2, at + d)));
                // Not fused: the same on every instruction set.
                const auto area = hn::Add(hn::Mul(x, y), hn::Mul(hn::Add(x, y), z));
                const auto other = hn::Add(place, hn::Set(du, static_cast<std::uint32_t>(d)));
                hn::Store(hn::Or(hn::And(hn::BitCast(du, area), area_bits),
                                 hn::And(hn::Xor(place, other), place_bits)),
                          du, keys[d - 1] + halo + i);
            }
        }
        for (std::size_t i = 0; i < n; i += lanes) {
            auto min_key = none;
            for (std::size_t d = 1; d <= radius; ++d) {
                const std::uint32_t* const row = keys[d - 1] + halo + i;
                min_key = hn::Min(min_key, hn::Load(du, row));
                min_key = hn::Min(min_key, hn::LoadU(du, row - d));
            }
            hn::StoreU(min_key, du, tile.nearest + first + i);
        }
        for (std::size_t d = 0; d < radius; ++d)
            for (std::size_t i = 0; i < halo; i += lanes)
                hn::Store(hn::Load(du, keys[d] + block + i), du, keys[d] + i);
    }
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(find_nearest);

/// By a power of two, where areas might overflow or vanish.
void PlocTile::scale() {
    // Of numbers that are not negative the greater float has the greater bits.
    std::uint32_t bits = 0;
    for (const Row& row : at_)
        for (std::size_t i = 0; i < size_; ++i)
            bits = std::max(bits, std::bit_cast<std::uint32_t>(row[i]) & 0x7fffffff);
    const float max_extent = std::bit_cast<float>(bits);
    unscale_ = 1;
    if (max_extent == 0 || (max_extent > 0x1p-40f && max_extent < 0x1p40f))
        return;
    const int exponent = std::clamp(std::ilogb(max_extent), -126, 126);
    const float to_one = std::ldexp(1.f, -exponent);
    unscale_ = std::ldexp(1.f, exponent);
    for (Row& row : at_)
        for (std::size_t i = 0; i < size_; ++i)
            row[i] *= to_one;
}

/// The union of a far point and any cluster is larger than that of any two clusters.
void PlocTile::pad() {
    for (Row& row : at_)
        std::fill_n(row + size_, margin, 0x1p60f);
}

/// Merges cluster i with the one `step_of(i)` after it, for each i in turn; 0 leaves it as it is,
/// and a step back drops it. By masks without branches, most of which would be mispredicted.
template <class StepOf> void PlocTile::merge(const StepOf& step_of) {
    const std::size_t n = size_;
    std::size_t out = 0, n_merges = n_merges_;
    const std::uint32_t first_node = first_node_;
    PlocMerge* const merges = merges_;
    for (std::size_t i = 0; i < n; ++i) {
        const std::int32_t step = step_of(static_cast<std::uint32_t>(i));
        const std::uint32_t is_right = static_cast<std::uint32_t>(step) >> 31;
        const std::uint32_t is_left = static_cast<std::uint32_t>(-step) >> 31;
        const std::uint32_t left_mask = 0u - is_left;
        const std::size_t j = i + (static_cast<std::uint32_t>(step) & left_mask);
        const float x0 = std::min(at_[0][i], at_[0][j]), y0 = std::min(at_[1][i], at_[1][j]),
                    z0 = std::min(at_[2][i], at_[2][j]), x1 = std::max(at_[3][i], at_[3][j]),
                    y1 = std::max(at_[4][i], at_[4][j]), z1 = std::max(at_[5][i], at_[5][j]);
        at_[0][out] = x0;
        at_[1][out] = y0;
        at_[2][out] = z0;
        at_[3][out] = x1;
        at_[4][out] = y1;
        at_[5][out] = z1;
        const std::uint32_t node = node_[i], node_j = node_[j], left_count = count_[i];
        const std::uint32_t count = left_count + (count_[j] & left_mask);
        const std::uint32_t merged = first_node + static_cast<std::uint32_t>(n_merges);
        merges[n_merges] = {node, node_j, left_count, count};
        node_[out] = node ^ ((node ^ merged) & left_mask);
        count_[out] = count;
        n_merges += is_left;
        out += 1 - is_right;
    }
    size_ = out;
    n_merges_ = n_merges;
}

void PlocTile::merge_mutual() {
    merge([this](std::uint32_t i) {
        // The key tells the other's place modulo 64: a step between -32 and 31.
        const std::uint32_t key = nearest_[i];
        const auto step = static_cast<std::int32_t>(((i ^ key) - i) << 26) >> 26;
        const std::uint32_t differing = key ^ nearest_[static_cast<std::ptrdiff_t>(i) + step];
        // All bits if the keys are equal, else none.
        const auto mutual =
            static_cast<std::int32_t>((std::uint64_t{differing} - 1) >> 32 & 0xffffffff);
        return step & mutual;
    });
}

void PlocTile::merge_neighbours() {
    merge([n = size_](std::uint32_t i) { return i % 2 == 1 ? -1 : i + 1 < n ? 1 : 0; });
}

std::size_t PlocTile::reduce(std::size_t wanted, std::size_t radius, std::uint32_t first_node,
                             PlocMerge* merges) {
    merges_ = merges;
    n_merges_ = 0;
    first_node_ = first_node;
    scale();
    while (size_ > wanted) {
        const std::size_t before = size_;
        pad();
        HWY_DYNAMIC_DISPATCH(find_nearest)({at_, nearest_, size_}, radius);
        merge_mutual();
        if (size_ > wanted && before - size_ < before / 16)
            merge_neighbours();
    }
    return n_merges_;
}

} // namespace boxwood::detail
#endif
