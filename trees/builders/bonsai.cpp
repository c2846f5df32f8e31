#include "trees/builders/bonsai.h"

#include "trees/builders/sweep_sah.h"
#include "trees/ordering/curve_order.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace boxwood {
namespace {

/// The items along the curve, by codes that tell nearly all of them apart.
class Curved {
  public:
    Curved(Boxes boxes, const Executor& executor)
        : coarse_(mergeable_curve_order(boxes, Curve::morton, nullptr, executor).records) {
        if (coarse_.empty())
            fine_ = curve_order(boxes, Curve::morton, executor);
    }
    /// Ascending; neighbours part by the first bit in which their keys differ.
    std::span<const std::uint64_t> keys() const {
        return coarse_.empty() ? fine_.codes.span() : coarse_.span();
    }
    std::uint32_t item(std::uint32_t i) const {
        return coarse_.empty() ? fine_.order[i] : static_cast<std::uint32_t>(coarse_[i]);
    }

  private:
    Buffer<std::uint64_t> coarse_; ///< a code above an item in each
    CurveOrder fine_;
};

/// Places [begin, end) on the curve.
struct Cell {
    std::uint32_t begin, end;
    std::uint32_t count() const { return end - begin; }
};

/// The largest cells of at most so many items, in order; items with the same key are halved.
std::vector<Cell> cells_of(std::span<const std::uint64_t> keys, std::uint32_t max_items_of_cell) {
    // Each cell that waits lies at a lower bit than the one before: 64, and 30 halves at most.
    std::vector<Cell> cells, waiting{{0, static_cast<std::uint32_t>(keys.size())}};
    while (!waiting.empty()) {
        const Cell cell = waiting.back();
        waiting.pop_back();
        if (cell.count() <= max_items_of_cell) {
            cells.push_back(cell);
            continue;
        }
        std::uint32_t middle = cell.begin + cell.count() / 2;
        if (const std::uint64_t bit = std::bit_floor(keys[cell.begin] ^ keys[cell.end - 1])) {
            const auto within = keys.subspan(cell.begin, cell.count());
            const auto upper = std::ranges::partition_point(
                within, [&](std::uint64_t key) { return (key & bit) == 0; });
            middle = cell.begin + static_cast<std::uint32_t>(upper - within.begin());
        }
        waiting.push_back({middle, cell.end});
        waiting.push_back({cell.begin, middle});
    }
    return cells;
}

/// A subtree of a mini-tree, which becomes a leaf of the top tree.
struct Subtree {
    std::uint32_t mini, node;
};

/// The mini-trees, or where their roots have more than `prune` times the mean area, the largest
/// subtrees that have not.
std::vector<Subtree> pruned(std::span<const Tree> minis, double prune) {
    double sum = 0;
    for (const Tree& mini : minis)
        sum += mini.nodes[0].box.half_area();
    // A little more, so that equal roots are not larger than their mean.
    const double max_area = (1 + 0x1p-20) * prune * sum / static_cast<double>(minis.size());
    std::vector<Subtree> subtrees, waiting;
    for (std::uint32_t m = 0; m < minis.size(); ++m) {
        const Tree& mini = minis[m];
        waiting.push_back({m, 0});
        while (!waiting.empty()) {
            const Subtree subtree = waiting.back();
            waiting.pop_back();
            if (mini.is_leaf(subtree.node) ||
                mini.nodes[subtree.node].box.half_area() <= max_area) {
                subtrees.push_back(subtree);
                continue;
            }
            waiting.push_back({m, static_cast<std::uint32_t>(mini.right(subtree.node))});
            waiting.push_back({m, subtree.node + 1});
        }
    }
    return subtrees;
}

/// Where a subtree goes: its first node and slot, and its items.
struct Place {
    std::uint32_t node, first, count;
};

/// Where the nodes of the top tree and the subtrees at its leaves go in the whole tree.
std::vector<Place> places(const Tree& top, std::span<const Subtree> subtrees,
                          std::span<const Tree> minis) {
    std::vector<Place> at(top.nodes.size(), Place{});
    for (std::size_t i = at.size(); i-- > 0;) {
        if (top.is_leaf(i)) {
            const Subtree subtree = subtrees[top.item(i)];
            at[i].count = minis[subtree.mini].nodes[subtree.node].count;
        } else
            at[i].count = at[Tree::left(i)].count + at[top.right(i)].count;
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (top.is_leaf(i))
            continue;
        Place &left = at[Tree::left(i)], &right = at[top.right(i)];
        left.node = at[i].node + 1;
        left.first = at[i].first;
        right.node = at[i].node + 2 * left.count;
        right.first = at[i].first + left.count;
    }
    return at;
}

} // namespace

Tree BonsaiBuilder::build(Boxes boxes, const Executor& executor) const {
    if (boxes.empty())
        return {};
    const Curved curved(boxes, executor);
    const auto cells = cells_of(curved.keys(), static_cast<std::uint32_t>(group));

    // More bins cost 3 % of the time and gain nothing in cells this small.
    const BinnedSahBuilder binned{.bins = 16,
                                  .agglomerate_below = agglomerate_below,
                                  .leaf_size = leaf_size,
                                  .unsplit_below = unsplit_below};
    std::vector<Tree> minis(cells.size());
    executor.for_each(cells.size(), [&](std::size_t i) {
        Buffer<Box> own(cells[i].count());
        for (std::uint32_t k = 0; k < own.size(); ++k)
            own[k] = boxes[curved.item(cells[i].begin + k)];
        minis[i] = binned.build(own.span(), serial());
    });

    const std::vector<Subtree> subtrees = pruned(minis, prune);
    Buffer<Box> roots(subtrees.size());
    for (std::size_t i = 0; i < subtrees.size(); ++i)
        roots[i] = minis[subtrees[i].mini].nodes[subtrees[i].node].box;
    const Tree top = SweepSahBuilder{}.build(roots.span(), executor);

    Tree tree(boxes.size());
    const std::vector<Place> at = places(top, subtrees, minis);
    constexpr std::size_t chunk = 64; // nodes of the top tree
    executor.for_each((at.size() + chunk - 1) / chunk, [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(at.size(), (c + 1) * chunk); ++i) {
            const auto [node, first, count] = at[i];
            if (!top.is_leaf(i)) {
                tree.nodes[node] = {top.nodes[i].box, first, count};
                continue;
            }
            const auto [m, root] = subtrees[top.item(i)];
            const Tree& mini = minis[m];
            const std::uint32_t from = mini.nodes[root].first;
            for (std::uint32_t k = 0; k < 2 * count - 1; ++k) {
                const TreeNode& from_node = mini.nodes[root + k];
                tree.nodes[node + k] = {from_node.box, first + (from_node.first - from),
                                        from_node.count};
            }
            for (std::uint32_t k = 0; k < count; ++k)
                tree.order[first + k] = curved.item(cells[m].begin + mini.order[from + k]);
        }
    });
    return tree;
}

BuilderEntry bonsai_builder() { return builder_entry<BonsaiBuilder>(); }

} // namespace boxwood
