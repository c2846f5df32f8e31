#include "trees/layouts/wide.h"
#include "trees/layouts/detail/collapse.h"
#include "trees/layouts/detail/exact_boxes.h"
#include "trees/layouts/detail/model.h"

#include <algorithm>

namespace boxwood {
using namespace detail;
namespace {

template <class Real, std::size_t W>
void set_lane(BoxBlock<Real, W>& block, std::uint32_t lane, const Aabb<Real>& box,
              std::uint32_t ref) {
    for (int axis = 0; axis < 3; ++axis) {
        block.plane[axis][lane] = box.min[axis];
        block.plane[3 + axis][lane] = box.max[axis];
    }
    block.ref[lane] = ref;
}

/// box(node): the bounds of a node of the tree.
template <class Real, std::size_t W, class BoxOf>
void fill(BoxBlock<Real, W>& block, const CollapsedBlock& from,
          const Buffer<CollapsedBlock>& blocks, const Tree& tree, const BoxOf& box) {
    using Layout = WideLayout<Real, W>;
    const TreeNode& top = tree.nodes[from.node];
    block.bounds = box(from.node);
    block.items = top.count;
    block.count = from.count > 0 ? from.count : top.count;
    if (from.count == 0) {
        // The last node below is a leaf, so no more than W are written.
        std::uint32_t leaves[W], found = 0;
        for (std::uint32_t i = from.node; found < top.count; ++i) {
            leaves[found] = i;
            found += tree.nodes[i].count == 1;
        }
        for (std::uint32_t lane = 0; lane < top.count; ++lane)
            set_lane(block, lane, box(leaves[lane]), tree.order[top.first + lane]);
    } else {
        for (std::uint32_t lane = 0; lane < from.count; ++lane) {
            const CollapsedBlock& child = blocks[from.first + lane];
            set_lane(block, lane, box(child.node),
                     (from.first + lane) | (child.count == 0 ? Layout::leaf_bit : 0));
        }
    }
    for (std::uint32_t lane = block.count; lane < W; ++lane)
        set_lane(block, lane, Aabb<Real>{}, 0);
}

} // namespace

template <class Real, std::size_t W>
template <class BoxOf>
void WideLayout<Real, W>::make(const Tree& tree, const Executor& executor, const BoxOf& box) {
    const Collapsed collapsed = collapse<width>(tree, executor);
    size_ = tree.size();
    depth_ = collapsed.depth;
    root_ = tree.size() <= width ? leaf_bit : 0;
    blocks_ = Buffer<Block>(collapsed.blocks.size());
    constexpr std::size_t chunk = 512;
    executor.for_each((blocks_.size() + chunk - 1) / chunk, [&](std::size_t c) {
        const std::size_t end = std::min(blocks_.size(), (c + 1) * chunk);
        for (std::size_t i = c * chunk; i < end; ++i)
            fill(blocks_[i], collapsed.blocks[i], collapsed.blocks, tree, box);
    });
}

template <class Real, std::size_t W>
WideLayout<Real, W>::WideLayout(const Tree& tree, const Executor& executor) {
    make(tree, executor,
         [&](std::size_t node) { return static_cast<Aabb<Real>>(tree.nodes[node].box); });
}

template <class Real, std::size_t W>
WideLayout<Real, W>
WideLayout<Real, W>::of_doubles(const Tree& tree, std::span<const Aabb<double>> boxes,
                                const Executor& executor) requires std::same_as<Real, double> {
    const Buffer<Aabb<double>> exact = exact_boxes(tree, boxes);
    WideLayout made;
    made.make(tree, executor,
              [&](std::size_t node) { return static_cast<Aabb<Real>>(exact[node]); });
    return made;
}

template class WideLayout<float, 4>;
template class WideLayout<float, 8>;
template class WideLayout<float, 16>;
template class WideLayout<double, 8>;

LayoutEntry wide4_layout() { return layout_entry<Wide4Layout>(); }
LayoutEntry wide8_layout() { return layout_entry<Wide8Layout>(); }
LayoutEntry wide16_layout() { return layout_entry<Wide16Layout>(); }
LayoutEntry wide8_f64_layout() { return layout_entry<Wide8LayoutF64>(); }

} // namespace boxwood
