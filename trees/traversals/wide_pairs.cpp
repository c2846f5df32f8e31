// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide_pairs.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/queries/self_pairs.h"
#include "trees/queries/tree_pairs.h"
#include "trees/traversals/wide_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

#define X(name, L)                                                                                 \
    void pairs_of_##name(PairTraversal& state, const L& a, const L& b, bool self, bool counted) {  \
        any_pairs(state, a, b, self, counted);                                                     \
    }
BOXWOOD_WIDE_LAYOUTS(X)
#undef X

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
namespace {

#define X(name, L)                                                                                 \
    HWY_EXPORT(pairs_of_##name);                                                                   \
    void traverse(PairTraversal& state, const L& a, const L& b, bool self, bool counted) {         \
        HWY_DYNAMIC_DISPATCH(pairs_of_##name)(state, a, b, self, counted);                         \
    }
BOXWOOD_WIDE_LAYOUTS(X)
#undef X

/// The first tasks of a traversal: pairs of inner blocks are opened, and of two trees also a leaf
/// and an inner block, so that a tree of few items shares out the other.
template <bool Self, class L> std::vector<Pair> first_tasks(const L& a, const L& b, Work* work) {
    if (a.empty() || b.empty())
        return {};
    const auto weight = [&](Pair nodes) -> std::size_t {
        const bool leaf_a = L::is_leaf(nodes.a), leaf_b = L::is_leaf(nodes.b);
        if (Self ? leaf_a || leaf_b : leaf_a && leaf_b)
            return 0;
        return std::size_t{leaf_a ? 0 : a.block(nodes.a).items} +
               (leaf_b ? 0 : b.block(nodes.b).items);
    };
    return share_out({a.root(), b.root()}, weight, [&](Pair nodes, std::vector<Pair>& out) {
        const auto open_one = [&](const auto& block, const auto& leaf, auto pair_with) {
            for (std::uint32_t i = 0; i < block.count; ++i)
                if (overlaps(block.lane(i), leaf))
                    out.push_back(pair_with(block.ref[i]));
            if (work)
                *work += {.node_visits = 1, .box_tests = block.count};
        };
        if (L::is_leaf(nodes.a))
            return open_one(b.block(nodes.b), a.leaf(nodes.a).bounds, [&](std::uint32_t ref) {
                return Pair{nodes.a, ref};
            });
        if (L::is_leaf(nodes.b))
            return open_one(a.block(nodes.a), b.leaf(nodes.b).bounds, [&](std::uint32_t ref) {
                return Pair{ref, nodes.b};
            });
        const auto& x = a.block(nodes.a);
        const auto& y = b.block(nodes.b);
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
    });
}

/// `work`, if given, is added to, and wants one thread.
template <bool Self, class L>
void pairs(const L& a, const L& b, const Executor& executor, PairSink& sink, Work* work) {
    run_tasks(first_tasks<Self>(a, b, work), executor, sink, work,
              [&](PairTraversal& state) { traverse(state, a, b, Self, work != nullptr); });
}

} // namespace

} // namespace boxwood::detail

namespace boxwood {

#define X(name, L)                                                                                 \
    void self_pairs(const L& tree, const Executor& executor, PairSink& sink, Work* work) {         \
        detail::pairs<true>(tree, tree, executor, sink, work);                                     \
    }                                                                                              \
    void tree_pairs(const L& a, const L& b, const Executor& executor, PairSink& sink,              \
                    Work* work) {                                                                  \
        detail::pairs<false>(a, b, executor, sink, work);                                          \
    }
BOXWOOD_WIDE_LAYOUTS(X)
#undef X

} // namespace boxwood
#endif
