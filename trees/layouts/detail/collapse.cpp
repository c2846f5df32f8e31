#include "trees/layouts/detail/collapse.h"

#include <algorithm>
#include <array>
#include <vector>

namespace boxwood::detail {
namespace {

/// [i]: the least cost of the blocks of a subtree of which at most i + 1 stand side by side in
/// the block above.
template <std::uint32_t width> using MinCosts = std::array<float, width>;

/// What every subtree costs at least. The area of each block counts, inner or leaf, in parts of the
/// root's; and a little for the block itself, so that flat and identical boxes fill their blocks.
template <std::uint32_t width> class Costs {
  public:
    Costs(const Tree& tree, std::size_t part, const Executor& executor)
        : tree_(tree), min_costs_(tree.size()) {
        const double area = tree.nodes[0].box.half_area();
        scale_ = area > 0 ? 1 / area : 0;
        each_ = area > 0 ? 0x1p-20f : 1;
        // Subtrees of up to `part` items each on their own, then what is above them.
        std::vector<std::uint32_t> open{0}, parts, top;
        while (!open.empty()) {
            const std::uint32_t node = open.back();
            open.pop_back();
            if (tree.nodes[node].count <= part) {
                parts.push_back(node);
                continue;
            }
            top.push_back(node);
            open.push_back(static_cast<std::uint32_t>(tree.right(node)));
            open.push_back(static_cast<std::uint32_t>(Tree::left(node)));
        }
        executor.for_each(parts.size(), [&](std::size_t i) {
            const std::uint32_t first = parts[i];
            for (std::uint32_t n = first + 2 * tree.nodes[first].count - 1; n-- > first;)
                if (!tree.is_leaf(n))
                    add(n);
        });
        // Children have higher numbers than their parent.
        for (std::size_t i = top.size(); i-- > 0;)
            add(top[i]);
    }

    /// Those of a leaf are made in `own`. Not by value: what was stored number by number just now
    /// is not yet to be had in one piece.
    const MinCosts<width>& of(std::uint32_t node, MinCosts<width>& own) const {
        if (!tree_.is_leaf(node))
            return min_costs_[place(node)];
        own.fill(block(node));
        return own;
    }

    /// How many of at most `count` blocks side by side are best left of the node's middle, the
    /// fewest of equals.
    std::uint32_t left_of(std::uint32_t node, std::uint32_t count) const {
        MinCosts<width> own_left, own_right;
        const auto& left = of(static_cast<std::uint32_t>(Tree::left(node)), own_left);
        const auto& right = of(static_cast<std::uint32_t>(tree_.right(node)), own_right);
        std::uint32_t best = 1;
        for (std::uint32_t k = 2; k < count; ++k)
            if (left[k - 1] + right[count - k - 1] < left[best - 1] + right[count - best - 1])
                best = k;
        return best;
    }

  private:
    /// Inner nodes alone, in their order.
    std::size_t place(std::uint32_t node) const { return node - tree_.nodes[node].first; }
    float block(std::uint32_t node) const {
        return static_cast<float>(tree_.nodes[node].box.half_area() * scale_) + each_;
    }
    void add(std::uint32_t node) {
        MinCosts<width>& min_costs = min_costs_[place(node)];
        if (tree_.nodes[node].count == 2) { // every third node and more
            const auto left = static_cast<std::uint32_t>(Tree::left(node));
            min_costs.fill(std::min(block(node), block(left) + block(left + 1)));
            min_costs[0] = block(node);
            return;
        }
        MinCosts<width> own_left, own_right;
        const auto& left = of(static_cast<std::uint32_t>(Tree::left(node)), own_left);
        const auto& right = of(static_cast<std::uint32_t>(tree_.right(node)), own_right);
        // All ways to a sum one after the other, in a register.
#pragma GCC unroll 16
        for (std::uint32_t i = 1; i < width; ++i) {
            float best = left[0] + right[i - 1];
#pragma GCC unroll 16
            for (std::uint32_t k = 1; k < i; ++k)
                best = std::min(best, left[k] + right[i - 1 - k]);
            min_costs[i] = best;
        }
        // The sums of more blocks are no larger, as those below are not; but one block may be less.
        min_costs[0] = block(node) + (tree_.nodes[node].count > width ? min_costs[width - 1] : 0);
#pragma GCC unroll 16
        for (std::uint32_t i = 1; i < width; ++i)
            min_costs[i] = std::min(min_costs[i], min_costs[0]);
    }

    const Tree& tree_;
    double scale_;
    float each_;
    Buffer<MinCosts<width>> min_costs_;
};

/// The descendants of a node that stand beside each other in one block.
template <std::uint32_t width> struct Cut {
    std::array<std::uint32_t, width> nodes;
    std::uint32_t count = 0;
};

/// The cheapest cut below a node of more than `width` items, in the order of the tree.
template <std::uint32_t width>
Cut<width> cut_below(const Tree& tree, const Costs<width>& costs, std::uint32_t node) {
    Cut<width> cut;
    struct Part {
        std::uint32_t node, blocks;
    };
    std::array<Part, width> open;
    std::uint32_t n_open = 0;
    const auto split = [&](Part p) {
        const std::uint32_t left = costs.left_of(p.node, p.blocks);
        open[n_open++] = {static_cast<std::uint32_t>(tree.right(p.node)), p.blocks - left};
        open[n_open++] = {static_cast<std::uint32_t>(Tree::left(p.node)), left};
    };
    split({node, width});
    while (n_open > 0) {
        Part top = open[--n_open];
        if (top.blocks > 1) {
            MinCosts<width> own;
            const MinCosts<width>& min_costs = costs.of(top.node, own);
            while (top.blocks > 1 && min_costs[top.blocks - 1] == min_costs[top.blocks - 2])
                --top.blocks;
        }
        if (top.blocks > 1)
            split(top);
        else
            cut.nodes[cut.count++] = top.node;
    }
    return cut;
}

struct Open {
    std::uint32_t block, depth;
};

/// Collapses below blocks[root] and appends what comes of it, depth-first, except that the blocks
/// of more than one but at most `left_open` items stay as they are and go to `rest`.
template <std::uint32_t width>
std::size_t collapse_below(const Tree& tree, const Costs<width>& costs,
                           std::vector<CollapsedBlock>& blocks, Open root, std::size_t left_open,
                           std::vector<Open>& rest) {
    std::size_t depth = 0;
    std::vector<Open> open{root};
    while (!open.empty()) {
        const Open top = open.back();
        open.pop_back();
        depth = std::max<std::size_t>(depth, top.depth);
        const std::uint32_t items = tree.nodes[blocks[top.block].node].count;
        if (items <= width)
            continue;
        if (items <= left_open) {
            rest.push_back(top);
            continue;
        }
        const Cut<width> cut = cut_below<width>(tree, costs, blocks[top.block].node);
        const auto first = static_cast<std::uint32_t>(blocks.size());
        blocks[top.block].first = first;
        blocks[top.block].count = cut.count;
        for (std::uint32_t i = 0; i < cut.count; ++i)
            blocks.push_back({cut.nodes[i], 0, 0});
        for (std::uint32_t i = cut.count; i-- > 0;)
            open.push_back({first + i, top.depth + 1});
    }
    return depth;
}

} // namespace

template <std::uint32_t width> Collapsed collapse(const Tree& tree, const Executor& executor) {
    Collapsed made;
    if (tree.empty())
        return made;
    // Cut by the tree alone: the top first, then each subtree below it on its own.
    constexpr std::size_t parts = 64, min_part = 2048;
    const std::size_t part_size = std::max(min_part, tree.size() / parts);
    const Costs<width> costs(tree, part_size, executor);
    std::vector<CollapsedBlock> top{{0, 0, 0}};
    std::vector<Open> subtrees;
    made.depth = collapse_below<width>(tree, costs, top, {0, 1}, part_size, subtrees);
    struct Part {
        std::vector<CollapsedBlock> blocks;
        std::size_t depth, start;
    };
    std::vector<Part> made_parts(subtrees.size());
    executor.for_each(subtrees.size(), [&](std::size_t i) {
        Part& part = made_parts[i];
        const CollapsedBlock root = top[subtrees[i].block];
        part.blocks.reserve(2 * std::size_t{tree.nodes[root.node].count} / width);
        part.blocks.push_back(root);
        std::vector<Open> unused;
        part.depth =
            collapse_below<width>(tree, costs, part.blocks, {0, subtrees[i].depth}, 0, unused);
    });
    std::size_t size = top.size();
    for (Part& part : made_parts) {
        part.start = size;
        size += part.blocks.size() - 1;
        made.depth = std::max(made.depth, part.depth);
    }
    made.blocks = Buffer<CollapsedBlock>(size);
    std::ranges::copy(top, made.blocks.begin());
    executor.for_each(subtrees.size(), [&](std::size_t i) {
        // Block 0 of a part has its place in the top, the others follow `start`.
        const Part& part = made_parts[i];
        for (std::size_t k = 0; k < part.blocks.size(); ++k) {
            CollapsedBlock block = part.blocks[k];
            if (block.count > 0)
                block.first += static_cast<std::uint32_t>(part.start - 1);
            made.blocks[k == 0 ? subtrees[i].block : part.start + k - 1] = block;
        }
    });
    return made;
}

template Collapsed collapse<4>(const Tree&, const Executor&);
template Collapsed collapse<8>(const Tree&, const Executor&);
template Collapsed collapse<16>(const Tree&, const Executor&);

} // namespace boxwood::detail
