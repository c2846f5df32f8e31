#include "trees/layouts/wide.h"
#include "trees/layouts/model.h"

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

/// Opens the inner descendant of the largest area until the block is full or only leaf blocks
/// remain.
template <std::uint32_t width> Cut<width> cut_below(const Tree& tree, std::uint32_t node) {
    Cut<width> cut{{node}, 1};
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

template <class Real, std::size_t W>
void set_lane(BoxBlock<Real, W>& block, std::uint32_t lane, const Aabb<Real>& box,
              std::uint32_t ref) {
    for (int axis = 0; axis < 3; ++axis) {
        block.plane[axis][lane] = box.min[axis];
        block.plane[3 + axis][lane] = box.max[axis];
    }
    block.ref[lane] = ref;
}

template <class Real> Aabb<Real> box_of(const TreeNode& node) {
    return {Vec3<Real>(node.box.min), Vec3<Real>(node.box.max)};
}

template <class Block> void fill_leaf(Block& block, const Tree& tree, std::uint32_t node) {
    const TreeNode& top = tree.nodes[node];
    const std::size_t end = node + 2 * std::size_t{top.count} - 1;
    std::uint32_t lane = 0;
    for (std::size_t i = node; i < end; ++i)
        if (tree.is_leaf(i))
            set_lane(block, lane++, box_of<typename Block::Real>(tree.nodes[i]), tree.item(i));
}

} // namespace

template <class Real, std::size_t W>
WideLayout<Real, W>::WideLayout(const Tree& tree, const Executor&) : size_(tree.size()) {
    if (tree.empty())
        return;
    struct Open {
        std::uint32_t node, block, depth;
    };
    // Leaf blocks are the topmost nodes of at most W items. An inner block has two children or
    // more, so m leaf blocks have at most m - 1 inner ones above them.
    std::size_t leaves = 0;
    for (std::size_t i = 0; i < tree.nodes.size();) {
        const bool leaf = tree.nodes[i].count <= width;
        leaves += leaf;
        i += leaf ? 2 * std::size_t{tree.nodes[i].count} - 1 : 1;
    }
    blocks_ = Buffer<Block>(2 * leaves - 1);
    root_ = tree.size() <= width ? leaf_bit : 0;

    std::uint32_t used = 1;
    std::vector<Open> open{{0, 0, 1}};
    while (!open.empty()) {
        const Open top = open.back();
        open.pop_back();
        depth_ = std::max<std::size_t>(depth_, top.depth);
        const TreeNode& node = tree.nodes[top.node];
        Block& block = blocks_[top.block];
        block.bounds = box_of<Real>(node);
        if (node.count <= width) {
            block.count = node.count;
            fill_leaf(block, tree, top.node);
        } else {
            const Cut<width> cut = cut_below<width>(tree, top.node);
            block.count = cut.count;
            for (std::uint32_t i = 0; i < cut.count; ++i) {
                const TreeNode& child = tree.nodes[cut.nodes[i]];
                set_lane(block, i, box_of<Real>(child),
                         (used + i) | (child.count <= width ? leaf_bit : 0));
            }
            for (std::uint32_t i = cut.count; i-- > 0;)
                open.push_back({cut.nodes[i], used + i, top.depth + 1});
            used += cut.count;
        }
        for (std::uint32_t lane = block.count; lane < width; ++lane)
            set_lane(block, lane, Aabb<Real>{}, 0);
    }
    blocks_.shrink(used);
}

template class WideLayout<float, 4>;
template class WideLayout<float, 8>;
template class WideLayout<float, 16>;
template class WideLayout<double, 8>;

LayoutEntry wide8_layout() { return layout_entry<Wide8Layout>(); }

} // namespace boxwood
