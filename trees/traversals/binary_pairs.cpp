#include "trees/layouts/binary.h"
#include "trees/queries/self_pairs.h"
#include "trees/queries/tree_pairs.h"
#include "trees/traversals/pair_traversal.h"

namespace boxwood::detail {
namespace {

/// What opening a pair of nodes leads to: within one tree a node against itself gives both children
/// against themselves and against each other; two nodes give the children of one against the other.
/// The larger surface is opened, on a tie the one of more items. Calls test(a, b) for boxes to
/// test.
template <bool Self, class T, class Test>
void open_nodes(const T& a, const T& b, Pair nodes, const Test& test) {
    const auto& x = a.nodes[nodes.a];
    const auto& y = b.nodes[nodes.b];
    const auto left = static_cast<std::uint32_t>(T::left(nodes.a));
    if (Self && nodes.a == nodes.b) {
        test(left, static_cast<std::uint32_t>(a.right(nodes.a)));
        return;
    }
    const double area_x = x.box.half_area(), area_y = y.box.half_area();
    const bool larger = area_x > area_y || (area_x == area_y && x.count >= y.count);
    if (y.count == 1 || (x.count > 1 && larger)) {
        test(left, nodes.b);
        test(static_cast<std::uint32_t>(a.right(nodes.a)), nodes.b);
    } else {
        test(nodes.a, static_cast<std::uint32_t>(T::left(nodes.b)));
        test(nodes.a, static_cast<std::uint32_t>(b.right(nodes.b)));
    }
}

template <bool Self, bool Counted, class T>
void traverse(PairTraversal& state, const T& a, const T& b) {
    Pair nodes{};
    while (state.next(nodes)) {
        const bool same = Self && nodes.a == nodes.b;
        if (same) {
            // Leaves first on the stack are taken last; a leaf against itself is nothing.
            const auto left = static_cast<std::uint32_t>(T::left(nodes.a));
            const auto right = static_cast<std::uint32_t>(a.right(nodes.a));
            if (a.nodes[right].count > 1)
                state.push({right, right});
            if (a.nodes[left].count > 1)
                state.push({left, left});
        }
        state.count<Counted>(same ? 1 : 2);
        open_nodes<Self>(a, b, nodes, [&](std::uint32_t i, std::uint32_t j) {
            const auto& x = a.nodes[i];
            const auto& y = b.nodes[j];
            if (!overlaps(x.box, y.box))
                return;
            if (x.count > 1 || y.count > 1) {
                state.push({i, j});
                return;
            }
            const Pair items{a.order[x.first], b.order[y.first]};
            state.emit(Self && items.b < items.a ? Pair{items.b, items.a} : items);
        });
    }
}

/// `work`, if given, is added to, and wants one thread.
template <bool Self, class T>
void pairs(const T& a, const T& b, const Executor& executor, PairSink& sink, Work* work) {
    std::vector<Pair> tasks;
    const bool can_start =
        Self ? a.size() > 1 : !a.empty() && !b.empty() && overlaps(a.nodes[0].box, b.nodes[0].box);
    if (can_start && !Self && a.size() == 1 && b.size() == 1) {
        // Two lone leaves: nothing to open.
        const Pair pair{a.order[0], b.order[0]};
        sink.begin(1, true);
        sink.take(0, {&pair, 1});
        sink.end();
        if (work)
            *work += {.box_tests = 1, .answers = 1};
        return;
    }
    if (can_start) {
        constexpr std::uint32_t min_count = Self ? 64 : 2; // no step of such nodes meets two leaves
        const auto weight = [&](Pair nodes) -> std::size_t {
            const std::uint32_t x = a.nodes[nodes.a].count, y = b.nodes[nodes.b].count;
            return x < min_count || y < min_count ? 0 : std::size_t{x} + y;
        };
        tasks = share_out(Pair{0, 0}, weight, [&](Pair nodes, std::vector<Pair>& out) {
            if (Self && nodes.a == nodes.b)
                for (const std::size_t child : {T::left(nodes.a), a.right(nodes.a)})
                    if (!a.is_leaf(child)) // a leaf against itself is nothing
                        out.push_back(
                            {static_cast<std::uint32_t>(child), static_cast<std::uint32_t>(child)});
            if (work)
                ++work->node_visits;
            open_nodes<Self>(a, b, nodes, [&](std::uint32_t i, std::uint32_t j) {
                if (work)
                    ++work->box_tests;
                if (overlaps(a.nodes[i].box, b.nodes[j].box))
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
        detail::pairs<true>(tree.tree(), tree.tree(), executor, sink, work);                       \
    }                                                                                              \
    void tree_pairs(const L& a, const L& b, const Executor& executor, PairSink& sink,              \
                    Work* work) {                                                                  \
        detail::pairs<false>(a.tree(), b.tree(), executor, sink, work);                            \
    }
BOXWOOD_BINARY_LAYOUTS(X)
#undef X

} // namespace boxwood
