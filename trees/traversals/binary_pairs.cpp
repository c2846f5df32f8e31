#include "trees/layouts/binary.h"
#include "trees/traversals/pair_walk.h"
#include "trees/traversals/self_pairs.h"
#include "trees/traversals/tree_pairs.h"

namespace boxwood {
namespace {

/// What opening a pair of nodes leads to: within one tree a node against itself gives both children
/// against themselves and against each other; two nodes give the children of one against the other.
/// The larger surface is opened, on a tie the one of more items. Calls test(a, b) for boxes to
/// test.
template <bool Self, class Test>
void open_nodes(const Tree& a, const Tree& b, Pair nodes, const Test& test) {
    const TreeNode& x = a.nodes[nodes.a];
    const TreeNode& y = b.nodes[nodes.b];
    const auto left = static_cast<std::uint32_t>(Tree::left(nodes.a));
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
        test(nodes.a, static_cast<std::uint32_t>(Tree::left(nodes.b)));
        test(nodes.a, static_cast<std::uint32_t>(b.right(nodes.b)));
    }
}

template <bool Self, bool Counted> void walk(PairWalk& state, const Tree& a, const Tree& b) {
    Pair nodes{};
    while (state.next(nodes)) {
        const bool same = Self && nodes.a == nodes.b;
        if (same) {
            // Leaves first on the stack are taken last; a leaf against itself is nothing.
            const auto left = static_cast<std::uint32_t>(Tree::left(nodes.a));
            const auto right = static_cast<std::uint32_t>(a.right(nodes.a));
            if (a.nodes[right].count > 1)
                state.push({right, right});
            if (a.nodes[left].count > 1)
                state.push({left, left});
        }
        state.count<Counted>(same ? 1 : 2);
        open_nodes<Self>(a, b, nodes, [&](std::uint32_t i, std::uint32_t j) {
            const TreeNode& x = a.nodes[i];
            const TreeNode& y = b.nodes[j];
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

template <bool Self, bool Counted>
void pairs(const Tree& a, const Tree& b, const Executor& executor, PairSink& sink, Work* work) {
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
        // A walk of fewer items is not worth sharing out.
        constexpr std::size_t small = 4096;
        constexpr std::uint32_t least = 64;
        tasks = share_out(Pair{0, 0}, [&](Pair nodes, std::vector<Pair>& out) {
            if (a.size() + b.size() < small || a.nodes[nodes.a].count < least ||
                b.nodes[nodes.b].count < least)
                return false;
            if (Self && nodes.a == nodes.b)
                for (const std::size_t child : {Tree::left(nodes.a), a.right(nodes.a)})
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
            return true;
        });
    }
    run_tasks(tasks, executor, sink, work,
              [&](PairWalk& state) { walk<Self, Counted>(state, a, b); });
}

} // namespace

void self_pairs(const BinaryLayout& tree, const Executor& executor, PairSink& sink) {
    pairs<true, false>(tree.tree(), tree.tree(), executor, sink, nullptr);
}

Work self_pairs_counted(const BinaryLayout& tree, PairSink& sink) {
    Work work;
    pairs<true, true>(tree.tree(), tree.tree(), serial(), sink, &work);
    return work;
}

void tree_pairs(const BinaryLayout& a, const BinaryLayout& b, const Executor& executor,
                PairSink& sink) {
    pairs<false, false>(a.tree(), b.tree(), executor, sink, nullptr);
}

Work tree_pairs_counted(const BinaryLayout& a, const BinaryLayout& b, PairSink& sink) {
    Work work;
    pairs<false, true>(a.tree(), b.tree(), serial(), sink, &work);
    return work;
}

} // namespace boxwood
