#include "trees/layouts/collapse.h"

#include <algorithm>
#include <array>
#include <vector>

namespace boxwood {
namespace {

/// The descendants of a node that stand beside each other in one block.
template <std::uint32_t width> struct Cut {
    std::array<std::uint32_t, width> nodes;
    std::uint32_t count;
};

/// Opens the inner descendant of the largest area until the block is full or only leaves remain.
template <std::uint32_t width> Cut<width> cut_below(const Tree& tree, std::uint32_t node) {
    Cut<width> cut{{node}, 1};
    std::array<double, width> areas{};
    std::array<std::uint32_t, width> counts{};
    const auto openable = [&](std::uint32_t n) {
        if (tree.nodes[n].count <= width)
            return -1.0;
        __builtin_prefetch(&tree.nodes[tree.right(n)]); // far away, and wanted soon
        return tree.nodes[n].box.half_area();
    };
    while (cut.count < width) {
        // On a tie the one of more items, so that flat and identical boxes stay balanced.
        std::uint32_t widest = 0;
        for (std::uint32_t i = 1; i < cut.count; ++i) {
            const bool more = counts[i] > counts[widest];
            const bool wider = areas[i] > areas[widest] || (areas[i] == areas[widest] && more);
            widest = wider ? i : widest;
        }
        if (areas[widest] < 0)
            break;
        const std::uint32_t opened = cut.nodes[widest];
        const auto left = static_cast<std::uint32_t>(Tree::left(opened));
        const auto right = static_cast<std::uint32_t>(tree.right(opened));
        // The order of the tree is kept: the pair takes the place of its parent.
        for (std::uint32_t i = cut.count; i > widest + 1; --i) {
            cut.nodes[i] = cut.nodes[i - 1];
            areas[i] = areas[i - 1];
            counts[i] = counts[i - 1];
        }
        cut.nodes[widest] = left;
        cut.nodes[widest + 1] = right;
        areas[widest] = openable(left);
        areas[widest + 1] = openable(right);
        counts[widest] = tree.nodes[left].count;
        counts[widest + 1] = tree.nodes[right].count;
        ++cut.count;
    }
    return cut;
}

struct Open {
    std::uint32_t block, depth;
};

/// Collapses below blocks[root] and appends what comes of it, depth-first, except that the blocks
/// of more than one but at most `left_open` items stay as they are and go to `rest`.
template <std::uint32_t width>
std::size_t collapse_below(const Tree& tree, std::vector<CollapsedBlock>& blocks, Open root,
                           std::size_t left_open, std::vector<Open>& rest) {
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
        const Cut<width> cut = cut_below<width>(tree, blocks[top.block].node);
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
    constexpr std::size_t parts = 64, least = 2048;
    std::vector<CollapsedBlock> top{{0, 0, 0}};
    std::vector<Open> subtrees, none;
    made.depth =
        collapse_below<width>(tree, top, {0, 1}, std::max(least, tree.size() / parts), subtrees);
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
        part.depth = collapse_below<width>(tree, part.blocks, {0, subtrees[i].depth}, 0, unused);
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

} // namespace boxwood
