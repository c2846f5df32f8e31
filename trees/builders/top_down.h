#pragma once

#include "trees/executor.h"
#include "trees/tree.h"

#include <algorithm>
#include <bit>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace boxwood {

/// An item on its way to a leaf: 32 bytes, moved as a whole so that every pass reads memory in
/// order. Bytes 0-15 and 16-31 load as two registers of four floats; the fourth lanes are not
/// coordinates.
struct alignas(16) Prim {
    Vec3<float> min;
    std::uint32_t item;
    Vec3<float> max;
    std::uint32_t unused;

    /// The centre along an axis; halved before adding so that no finite box overflows.
    float centre(int axis) const { return min[axis] * .5f + max[axis] * .5f; }
};
static_assert(sizeof(Prim) == 32);

/// Splits at the middle item along the axis of the largest spread of centres; ties by item index.
std::size_t split_median(std::span<Prim> prims);

/// The loop that top-down builders share; each brings its split alone:
/// `split(prims, scratch) -> size_t` rearranges two or more items and says how many go left, in
/// [1, n - 1]; `scratch` is as long and holds nothing.
///
/// Nodes are numbered by arithmetic (a subtree of m items fills 2m - 1 slots), so subtrees are
/// built in any order, on any thread, with no atomics. A branch deeper than 2 log2(n) + 32 is split
/// at the median from there on, which bounds every depth by 3 log2(n) + 33.
template <class Split>
Tree build_top_down(Boxes boxes, const Executor& executor, const Split& split) {
    struct Range {
        std::uint32_t node, first, count, depth;
    };
    require_valid(boxes);
    const std::size_t n = boxes.size();
    Tree tree(n);
    if (n == 0)
        return tree;
    const std::uint32_t depth_limit = 2 * static_cast<std::uint32_t>(std::bit_width(n)) + 32;

    Buffer<Prim> prims(n), scratch(n);
    constexpr std::size_t chunk = 1 << 14;
    executor.for_each((n + chunk - 1) / chunk, [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i)
            prims[i] = {boxes[i].min, static_cast<std::uint32_t>(i), boxes[i].max, 0};
    });

    const auto halves = [&](Range r) {
        const std::span<Prim> range = prims.span().subspan(r.first, r.count);
        const auto left = static_cast<std::uint32_t>(
            r.count == 2            ? 1
            : r.depth > depth_limit ? split_median(range)
                                    : split(range, scratch.span().subspan(r.first, r.count)));
        return std::pair{Range{r.node + 1, r.first, left, r.depth + 1},
                         Range{r.node + 2 * left, r.first + left, r.count - left, r.depth + 1}};
    };
    const auto write_leaf = [&](Range r) {
        const Prim& p = prims[r.first];
        tree.nodes[r.node] = {{p.min, p.max}, r.first, 1};
        tree.order[r.first] = p.item;
    };
    const auto write_inner = [&](std::size_t node) {
        TreeNode& inner = tree.nodes[node];
        inner.box = merge(tree.nodes[Tree::left(node)].box, tree.nodes[tree.right(node)].box);
    };
    const auto build_subtree = [&](Range root) {
        // The smaller half is taken at once and the larger waits, so 32 entries always suffice.
        Range waiting[32];
        std::size_t n_waiting = 0;
        for (Range r = root;;) {
            if (r.count > 1) {
                tree.nodes[r.node].first = r.first;
                tree.nodes[r.node].count = r.count;
                auto [a, b] = halves(r);
                if (a.count > b.count)
                    std::swap(a, b);
                waiting[n_waiting++] = b;
                r = a;
                continue;
            }
            write_leaf(r);
            if (n_waiting == 0)
                break;
            r = waiting[--n_waiting];
        }
        // Children have higher numbers than their parent: one pass backwards meets them first.
        for (std::size_t node = root.node + 2 * std::size_t{root.count} - 1; node-- > root.node;)
            if (!tree.is_leaf(node))
                write_inner(node);
    };

    // The top of the tree, a level at a time, until there are enough subtrees to share out.
    constexpr std::size_t enough = 64;
    constexpr std::uint32_t small = 2048;
    std::vector<Range> frontier{{0, 0, static_cast<std::uint32_t>(n), 0}}, subtrees, next;
    std::vector<std::uint32_t> top;
    while (!frontier.empty() && frontier.size() + subtrees.size() < enough) {
        std::erase_if(frontier, [&](Range r) {
            if (r.count <= small)
                subtrees.push_back(r);
            return r.count <= small;
        });
        next.assign(2 * frontier.size(), {});
        executor.for_each(frontier.size(), [&](std::size_t i) {
            const Range r = frontier[i];
            tree.nodes[r.node].first = r.first;
            tree.nodes[r.node].count = r.count;
            std::tie(next[2 * i], next[2 * i + 1]) = halves(r);
        });
        for (const Range r : frontier)
            top.push_back(r.node);
        frontier.swap(next);
    }
    subtrees.insert(subtrees.end(), frontier.begin(), frontier.end());
    std::ranges::sort(subtrees, std::ranges::greater{}, &Range::count);
    executor.for_each(subtrees.size(), [&](std::size_t i) { build_subtree(subtrees[i]); });
    std::ranges::sort(top, std::ranges::greater{});
    for (const std::uint32_t node : top)
        write_inner(node);
    return tree;
}

} // namespace boxwood
