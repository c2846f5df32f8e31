#include "trees/queries/self_pairs.h"
#include "trees/queries/tree_pairs.h"
#include "trees/traversals/binary_tree.h"
#include "trees/traversals/pair_traversal.h"

namespace boxwood::detail {
namespace {

/// What opening a pair of nodes leads to: within one tree a node against itself gives both children
/// against themselves and against each other; two nodes give the children of one against the other.
/// The larger surface is opened, on a tie the one of more items. Calls test(a, b) for boxes to
/// test.
template <bool Self, class T, class Test>
void open_nodes(const T& a, const T& b, Pair nodes, const Test& test) {
    if (Self && nodes.a == nodes.b) {
        test(left_of(a, nodes.a), right_of(a, nodes.a));
        return;
    }
    const double area_x = a.bounds(nodes.a).half_area(), area_y = b.bounds(nodes.b).half_area();
    const bool larger =
        area_x > area_y || (area_x == area_y && a.items_below(nodes.a) >= b.items_below(nodes.b));
    if (b.is_leaf(nodes.b) || (!a.is_leaf(nodes.a) && larger)) {
        test(left_of(a, nodes.a), nodes.b);
        test(right_of(a, nodes.a), nodes.b);
    } else {
        test(nodes.a, left_of(b, nodes.b));
        test(nodes.a, right_of(b, nodes.b));
    }
}

template <bool Self, bool Counted, class T>
void traverse(PairTraversal& state, const T& a, const T& b) {
    Pair nodes{};
    while (state.next(nodes)) {
        const bool same = Self && nodes.a == nodes.b;
        if (same) {
            // Leaves first on the stack are taken last; a leaf against itself is nothing.
            for (const std::uint32_t child : {right_of(a, nodes.a), left_of(a, nodes.a)})
                if (!a.is_leaf(child))
                    state.push({child, child});
        }
        state.count<Counted>(same ? 1 : 2);
        open_nodes<Self>(a, b, nodes, [&](std::uint32_t i, std::uint32_t j) {
            if (!overlaps(a.bounds(i), b.bounds(j)))
                return;
            if (!a.is_leaf(i) || !b.is_leaf(j)) {
                state.push({i, j});
                return;
            }
            const Pair items{a.item(i), b.item(j)};
            state.emit(Self && items.b < items.a ? Pair{items.b, items.a} : items);
        });
    }
}

/// `work`, if given, is added to, and wants one thread.
template <bool Self, class T>
void pairs(const T& a, const T& b, const Executor& executor, PairSink& sink, Work* work) {
    std::vector<Pair> tasks;
    const bool can_start =
        Self ? a.size() > 1 : !a.empty() && !b.empty() && overlaps(a.bounds(0), b.bounds(0));
    if (can_start && !Self && a.size() == 1 && b.size() == 1) {
        // Two lone leaves: nothing to open.
        const Pair pair{a.item(0), b.item(0)};
        sink.begin(1, true);
        sink.take(0, {&pair, 1});
        sink.end();
        if (work)
            *work += {.box_tests = 1, .answers = 1};
        return;
    }
    if (can_start) {
        constexpr std::size_t min_count = Self ? 64 : 2; // no step of such nodes meets two leaves
        const auto weight = [&](Pair nodes) -> std::size_t {
            const std::size_t x = a.items_below(nodes.a), y = b.items_below(nodes.b);
            return x < min_count || y < min_count ? 0 : x + y;
        };
        tasks = share_out(Pair{0, 0}, weight, [&](Pair nodes, std::vector<Pair>& out) {
            if (Self && nodes.a == nodes.b)
                for (const std::uint32_t child : {left_of(a, nodes.a), right_of(a, nodes.a)})
                    if (!a.is_leaf(child)) // a leaf against itself is nothing
                        out.push_back({child, child});
            if (work)
                ++work->node_visits;
            open_nodes<Self>(a, b, nodes, [&](std::uint32_t i, std::uint32_t j) {
                if (work)
                    ++work->box_tests;
                if (overlaps(a.bounds(i), b.bounds(j)))
                    out.push_back({i, j});
            });
        });
    }
    run_tasks(tasks, executor, sink, work, [&](PairTraversal& state) {
        work ? traverse<Self, true>(state, a, b) : traverse<Self, false>(state, a, b);
    });
}

} // namespace

} // namespace boxwood::detail

namespace boxwood {

#define X(name, L)                                                                                 \
    void self_pairs(const L& tree, const Executor& executor, PairSink& sink, Work* work) {         \
        detail::pairs<true>(detail::tree_of(tree), detail::tree_of(tree), executor, sink, work);   \
    }                                                                                              \
    void tree_pairs(const L& a, const L& b, const Executor& executor, PairSink& sink,              \
                    Work* work) {                                                                  \
        detail::pairs<false>(detail::tree_of(a), detail::tree_of(b), executor, sink, work);        \
    }
BOXWOOD_BINARY_TREES(X)
#undef X

} // namespace boxwood
