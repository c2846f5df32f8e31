// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide_pairs.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/layouts/wide.h"
#include "trees/traversals/pair_walk.h"
#include "trees/traversals/self_pairs.h"
#include "trees/traversals/tree_pairs.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 8> df;
constexpr hn::CappedTag<std::uint32_t, 8> du;

/// Lanes [i, i + Lanes(df)) of a block against one box: true where the closed boxes overlap.
HWY_INLINE hn::Mask<decltype(df)> Overlap(const Block8& block, std::size_t i, const Box& box) {
    const auto x = hn::And(hn::Le(hn::Load(df, block.plane[0] + i), hn::Set(df, box.max.x)),
                           hn::Ge(hn::Load(df, block.plane[3] + i), hn::Set(df, box.min.x)));
    const auto y = hn::And(hn::Le(hn::Load(df, block.plane[1] + i), hn::Set(df, box.max.y)),
                           hn::Ge(hn::Load(df, block.plane[4] + i), hn::Set(df, box.min.y)));
    const auto z = hn::And(hn::Le(hn::Load(df, block.plane[2] + i), hn::Set(df, box.max.z)),
                           hn::Ge(hn::Load(df, block.plane[5] + i), hn::Set(df, box.min.z)));
    return hn::And(x, hn::And(y, z));
}

/// The lanes of a block that overlap a box, as bits.
HWY_INLINE std::uint32_t OverlapBits(const Block8& block, const Box& box) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(df)) {
        std::uint8_t part[8] = {};
        hn::StoreMaskBits(df, Overlap(block, i, box), part);
        bits |= std::uint32_t{part[0]} << i;
    }
    return bits;
}

/// How a fixed reference and those of the overlapping lanes become pairs.
enum class Order { fixed_first, fixed_second, lower_first };

/// Appends a pair for each lane of the block that overlaps the box; returns how many. Stores whole
/// registers: up to eight pairs beyond the last are overwritten.
template <Order order>
HWY_INLINE std::size_t Append(const Block8& block, const Box& box, std::uint32_t fixed, Pair* to) {
    std::size_t n = 0;
    const auto f = hn::Set(du, fixed);
    for (std::size_t i = 0; i < 8; i += hn::Lanes(df)) {
        const auto hits = hn::RebindMask(du, Overlap(block, i, box));
        const auto refs = hn::Compress(hn::Load(du, block.ref + i), hits);
        const auto first = order == Order::fixed_first    ? f
                           : order == Order::fixed_second ? refs
                                                          : hn::Min(f, refs);
        const auto second = order == Order::fixed_first    ? refs
                            : order == Order::fixed_second ? f
                                                           : hn::Max(f, refs);
        hn::StoreInterleaved2(first, second, du, reinterpret_cast<std::uint32_t*>(to + n));
        n += hn::CountTrue(du, hits);
    }
    return n;
}

/// All lanes of `a` in the mask against block `b`, or the other way round: whichever has fewer.
template <bool LowerFirst>
HWY_INLINE std::size_t AppendAll(const Block8& a, std::uint32_t mask_a, const Block8& b,
                                 std::uint32_t mask_b, Pair* to) {
    std::size_t n = 0;
    if (std::popcount(mask_a) <= std::popcount(mask_b)) {
        for (; mask_a; mask_a &= mask_a - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(mask_a));
            n += Append < LowerFirst ? Order::lower_first
                                     : Order::fixed_first > (b, a.lane(lane), a.ref[lane], to + n);
        }
    } else {
        for (; mask_b; mask_b &= mask_b - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(mask_b));
            n += Append < LowerFirst ? Order::lower_first
                                     : Order::fixed_second > (a, b.lane(lane), b.ref[lane], to + n);
        }
    }
    return n;
}

/// A block against itself: each pair of lanes once; an inner block's children against themselves
/// too.
template <bool Counted> HWY_INLINE void OpenSelf(PairWalk& state, const Block8& block, bool leaf) {
    state.count<Counted>(8 * (block.count - 1));
    if (!leaf) {
        Pair* to = state.push_to();
        for (std::uint32_t i = block.count; i-- > 0;)
            *to++ = {block.ref[i], block.ref[i]};
        state.pushed(block.count);
    }
    Pair* const start = leaf ? state.emit_to() : state.push_to();
    Pair* to = start;
    for (std::uint32_t i = 0; i + 1 < block.count; ++i) {
        std::uint32_t bits = OverlapBits(block, block.lane(i)) & (0xfeu << i);
        for (; bits; bits &= bits - 1) {
            const std::uint32_t a = block.ref[i], b = block.ref[std::countr_zero(bits)];
            *to++ = leaf && b < a ? Pair{b, a} : Pair{a, b};
        }
    }
    const auto n = static_cast<std::size_t>(to - start);
    leaf ? state.emitted(n) : state.pushed(n);
}

template <bool Self, bool Counted>
void Walk(PairWalk& state, const Block8* blocks_a, const Block8* blocks_b) {
    Pair nodes{};
    while (state.next(nodes)) {
        const bool leaf_a = Wide8Layout::is_leaf(nodes.a), leaf_b = Wide8Layout::is_leaf(nodes.b);
        const Block8& a = blocks_a[Wide8Layout::index(nodes.a)];
        if (Self && nodes.a == nodes.b) {
            OpenSelf<Counted>(state, a, leaf_a);
            continue;
        }
        const Block8& b = blocks_b[Wide8Layout::index(nodes.b)];
        if (leaf_a != leaf_b) {
            // Only the inner block opens.
            state.count<Counted>(8);
            state.pushed(leaf_a
                             ? Append<Order::fixed_first>(b, a.bounds, nodes.a, state.push_to())
                             : Append<Order::fixed_second>(a, b.bounds, nodes.b, state.push_to()));
            continue;
        }
        const std::uint32_t mask_a = OverlapBits(a, b.bounds);
        const std::uint32_t mask_b = mask_a ? OverlapBits(b, a.bounds) : 0;
        if constexpr (Counted) {
            const int broadcasts = std::min(std::popcount(mask_a), std::popcount(mask_b));
            state.count<Counted>(8u * static_cast<unsigned>((mask_a ? 2 : 1) + broadcasts));
        }
        if (leaf_a)
            state.emitted(AppendAll<Self>(a, mask_a, b, mask_b, state.emit_to()));
        else
            state.pushed(AppendAll<false>(a, mask_a, b, mask_b, state.push_to()));
    }
}

void SelfPairs(PairWalk& state, const Block8* blocks) { Walk<true, false>(state, blocks, blocks); }
void SelfPairsCounted(PairWalk& state, const Block8* blocks) {
    Walk<true, true>(state, blocks, blocks);
}
void TreePairs(PairWalk& state, const Block8* a, const Block8* b) {
    Walk<false, false>(state, a, b);
}
void TreePairsCounted(PairWalk& state, const Block8* a, const Block8* b) {
    Walk<false, true>(state, a, b);
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(SelfPairs);
HWY_EXPORT(SelfPairsCounted);
HWY_EXPORT(TreePairs);
HWY_EXPORT(TreePairsCounted);

namespace {

/// The first tasks of a walk: pairs of inner blocks are opened, by the trees alone.
template <bool Self>
std::vector<Pair> first_tasks(const Wide8Layout& a, const Wide8Layout& b, Work* work) {
    if (a.empty() || b.empty())
        return {};
    constexpr std::size_t small = 4096; // fewer items are not worth sharing out
    return share_out({a.root(), b.root()}, [&](Pair nodes, std::vector<Pair>& out) {
        if (a.size() + b.size() < small || Wide8Layout::is_leaf(nodes.a) ||
            Wide8Layout::is_leaf(nodes.b))
            return false;
        const Block8& x = a.block(nodes.a);
        const Block8& y = b.block(nodes.b);
        const bool same = Self && nodes.a == nodes.b;
        for (std::uint32_t i = 0; i < x.count; ++i) {
            if (same)
                out.push_back({x.ref[i], x.ref[i]});
            for (std::uint32_t j = same ? i + 1 : 0; j < y.count; ++j)
                if (overlaps(x.lane(i), y.lane(j)))
                    out.push_back({x.ref[i], y.ref[j]});
        }
        if (work)
            *work += {.node_visits = 1,
                      .box_tests = same ? x.count * (x.count - 1) / 2 : x.count * y.count};
        return true;
    });
}

} // namespace

void self_pairs(const Wide8Layout& tree, const Executor& executor, PairSink& sink) {
    run_tasks(first_tasks<true>(tree, tree, nullptr), executor, sink, nullptr,
              [&](PairWalk& state) {
                  HWY_DYNAMIC_DISPATCH(SelfPairs)
                  (state, tree.blocks().data());
              });
}

Work self_pairs_counted(const Wide8Layout& tree, PairSink& sink) {
    Work work;
    run_tasks(first_tasks<true>(tree, tree, &work), serial(), sink, &work, [&](PairWalk& state) {
        HWY_DYNAMIC_DISPATCH(SelfPairsCounted)(state, tree.blocks().data());
    });
    return work;
}

void tree_pairs(const Wide8Layout& a, const Wide8Layout& b, const Executor& executor,
                PairSink& sink) {
    run_tasks(first_tasks<false>(a, b, nullptr), executor, sink, nullptr, [&](PairWalk& state) {
        HWY_DYNAMIC_DISPATCH(TreePairs)(state, a.blocks().data(), b.blocks().data());
    });
}

Work tree_pairs_counted(const Wide8Layout& a, const Wide8Layout& b, PairSink& sink) {
    Work work;
    run_tasks(first_tasks<false>(a, b, &work), serial(), sink, &work, [&](PairWalk& state) {
        HWY_DYNAMIC_DISPATCH(TreePairsCounted)(state, a.blocks().data(), b.blocks().data());
    });
    return work;
}

} // namespace boxwood
#endif
