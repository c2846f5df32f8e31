#include "trees/layouts/wide8.h"
#include "trees/layouts/model.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace boxwood {
namespace {

constexpr std::uint32_t width = 8;

/// The up to eight descendants of a node that stand beside each other in one block.
struct Cut {
    std::array<std::uint32_t, width> nodes;
    std::uint32_t count;
};

/// Opens the inner descendant of the largest area until there are eight or only leaf blocks remain.
Cut cut_below(const Tree& tree, std::uint32_t node) {
    Cut cut{{node}, 1};
    std::array<double, width> areas{};
    const auto openable = [&](std::uint32_t n) {
        return tree.nodes[n].count > width ? tree.nodes[n].box.half_area() : -1;
    };
    areas[0] = 0;
    while (cut.count < width) {
        const auto widest = static_cast<std::uint32_t>(
            std::max_element(areas.begin(), areas.begin() + cut.count) - areas.begin());
        if (areas[widest] < 0)
            break;
        const std::uint32_t opened = cut.nodes[widest];
        const auto left = static_cast<std::uint32_t>(Tree::left(opened));
        const auto right = static_cast<std::uint32_t>(tree.right(opened));
        // The order of the tree is kept: the pair takes the place of its parent.
        for (std::uint32_t i = cut.count; i > widest + 1; --i) {
            cut.nodes[i] = cut.nodes[i - 1];
            areas[i] = areas[i - 1];
        }
        cut.nodes[widest] = left;
        cut.nodes[widest + 1] = right;
        areas[widest] = openable(left);
        areas[widest + 1] = openable(right);
        ++cut.count;
    }
    return cut;
}

void set_lane(Block8& block, std::uint32_t lane, const Box& box, std::uint32_t ref) {
    for (int axis = 0; axis < 3; ++axis) {
        block.plane[axis][lane] = box.min[axis];
        block.plane[3 + axis][lane] = box.max[axis];
    }
    block.ref[lane] = ref;
}

void fill_leaf(Block8& block, const Tree& tree, std::uint32_t node) {
    const TreeNode& top = tree.nodes[node];
    const std::size_t end = node + 2 * std::size_t{top.count} - 1;
    std::uint32_t lane = 0;
    for (std::size_t i = node; i < end; ++i)
        if (tree.is_leaf(i))
            set_lane(block, lane++, tree.nodes[i].box, tree.item(i));
}

} // namespace

Wide8Layout::Wide8Layout(const Tree& tree, const Executor&) : size_(tree.size()) {
    if (tree.empty())
        return;
    struct Open {
        std::uint32_t node, block, depth;
    };
    // Leaf blocks are the topmost nodes of at most eight items. An inner block has two children or
    // more, so m leaf blocks have at most m - 1 inner ones above them.
    std::size_t leaves = 0;
    for (std::size_t i = 0; i < tree.nodes.size();) {
        const bool leaf = tree.nodes[i].count <= width;
        leaves += leaf;
        i += leaf ? 2 * std::size_t{tree.nodes[i].count} - 1 : 1;
    }
    blocks_ = Buffer<Block8>(2 * leaves - 1);
    root_ = tree.size() <= width ? leaf_bit : 0;

    std::uint32_t used = 1;
    std::vector<Open> open{{0, 0, 1}};
    while (!open.empty()) {
        const Open top = open.back();
        open.pop_back();
        depth_ = std::max<std::size_t>(depth_, top.depth);
        const TreeNode& node = tree.nodes[top.node];
        Block8& block = blocks_[top.block];
        block.bounds = node.box;
        if (node.count <= width) {
            block.count = node.count;
            fill_leaf(block, tree, top.node);
        } else {
            const Cut cut = cut_below(tree, top.node);
            block.count = cut.count;
            for (std::uint32_t i = 0; i < cut.count; ++i) {
                const TreeNode& child = tree.nodes[cut.nodes[i]];
                set_lane(block, i, child.box, (used + i) | (child.count <= width ? leaf_bit : 0));
            }
            for (std::uint32_t i = cut.count; i-- > 0;)
                open.push_back({cut.nodes[i], used + i, top.depth + 1});
            used += cut.count;
        }
        constexpr float inf = std::numeric_limits<float>::infinity();
        for (std::uint32_t lane = block.count; lane < width; ++lane)
            set_lane(block, lane, {{inf, inf, inf}, {-inf, -inf, -inf}}, 0);
    }
    blocks_.shrink(used);
}

LayoutEntry wide8_layout() { return layout_entry<Wide8Layout>(); }

} // namespace boxwood
