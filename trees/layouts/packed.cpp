#include "trees/layouts/packed.h"
#include "trees/layouts/model.h"
#include "trees/radix_sort.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace boxwood {
namespace {

constexpr std::size_t w = PackedLayout::width;

/// Fills a block with `count` boxes; returns their bounds.
template <class BoxOf>
Box fill(PackedBlock& block, std::size_t first, std::size_t count, const BoxOf& box_of) {
    Box bounds;
    for (std::size_t lane = 0; lane < count; ++lane) {
        const Box& box = box_of(first + lane);
        for (int axis = 0; axis < 3; ++axis) {
            block.plane[axis][lane] = box.min[axis];
            block.plane[3 + axis][lane] = box.max[axis];
        }
        bounds.extend(box);
    }
    constexpr float inf = std::numeric_limits<float>::infinity();
    for (std::size_t lane = count; lane < w; ++lane)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            block.plane[axis][lane] = inf;
            block.plane[3 + axis][lane] = -inf;
        }
    return bounds;
}

} // namespace

/// Leaves and their level above are made side by side, in parts of 256 slots; what is above those,
/// 1/256 of it all, in one go.
template <class BoxOf>
void PackedLayout::make(std::size_t n, const BoxOf& box_of, const Executor& executor) {
    size_ = n;
    depth_ = 0;
    std::size_t blocks = 0;
    for (std::size_t below = n; below > 1 || depth_ == 0; ++depth_) {
        if (n == 0)
            return;
        below = (below + w - 1) / w;
        first_[depth_] = blocks;
        blocks += below;
    }
    first_[depth_] = blocks;
    if (blocks_.size() != blocks)
        blocks_ = Buffer<PackedBlock>(blocks);

    const auto size_of = [&](std::size_t l) { return first_[l + 1] - first_[l]; };
    Buffer<Box> boxes(size_of(0)); // of the blocks of the last level that was made
    const std::size_t leaves = size_of(0), parts = (leaves + w - 1) / w;
    const std::size_t chunks = std::min(parts, chunks_for(n, executor));
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(leaves, chunks, c);
        for (std::size_t b = range.begin; b < range.end; ++b)
            boxes[b] = fill(blocks_[b], b * w, std::min(w, n - b * w), box_of);
    });
    for (std::size_t l = 1; l < depth_; ++l)
        // In place: block b is written after its sixteen children from 16 b on were read.
        for (std::size_t b = 0; b < size_of(l); ++b)
            boxes[b] = fill(blocks_[first_[l] + b], b * w, std::min(w, size_of(l - 1) - b * w),
                            [&](std::size_t i) { return boxes[i]; });
    bounds_ = boxes[0];
}

PackedLayout PackedLayout::of_order(Boxes boxes, std::span<const std::uint32_t> order,
                                    const Executor& executor) {
    PackedLayout made;
    made.take(boxes, order, executor);
    return made;
}

void PackedLayout::take(Boxes boxes, std::span<const std::uint32_t> order,
                        const Executor& executor) {
    const std::size_t n = order.size();
    if (boxes.size() != n)
        throw std::invalid_argument("packed: one entry of the order per box is wanted");
    const std::size_t lanes = (n + w - 1) / w * w;
    if (items_.size() != lanes)
        items_ = Buffer<std::uint32_t>(lanes);
    std::ranges::copy(order, items_.begin());
    std::fill(items_.begin() + n, items_.end(), 0u);
    refit(boxes, executor);
}

void PackedLayout::refit(Boxes boxes, const Executor& executor) {
    const std::size_t n = boxes.size();
    const std::uint32_t* const order = items_.data();
    make(
        n,
        [&](std::size_t slot) -> const Box& {
            constexpr std::size_t ahead = 32; // the boxes lie anywhere
            __builtin_prefetch(&boxes[order[std::min(slot + ahead, n - 1)]]);
            return boxes[order[slot]];
        },
        executor);
}

PackedLayout::PackedLayout(const Tree& tree, const Executor& executor)
    : items_((tree.size() + w - 1) / w * w) {
    const std::size_t n = tree.size();
    std::ranges::copy(tree.order, items_.begin());
    std::fill(items_.begin() + n, items_.end(), 0u);
    Buffer<std::uint32_t> leaves(n);
    const std::size_t chunks = chunks_for(n, executor);
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(tree.nodes.size(), chunks, c);
        for (std::size_t i = range.begin; i < range.end; ++i)
            if (tree.is_leaf(i))
                leaves[tree.nodes[i].first] = static_cast<std::uint32_t>(i);
    });
    make(
        n, [&](std::size_t slot) -> const Box& { return tree.nodes[leaves[slot]].box; }, executor);
}

LayoutEntry packed_layout() { return layout_entry<PackedLayout>(); }

} // namespace boxwood
