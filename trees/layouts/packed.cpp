#include "trees/layouts/packed.h"
#include "trees/executors/chunks.h"
#include "trees/layouts/detail/model.h"
#include "trees/layouts/detail/packed_blocks.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace boxwood {
using namespace detail;
namespace {

constexpr std::size_t w = PackedLayout::width;

} // namespace

/// Leaves and their level above are made side by side, in parts of 256 slots; what is above those,
/// 1/256 of it all, in one go.
void PackedLayout::make(const PackedSource& source, std::span<const std::uint32_t> order,
                        const Executor& executor) {
    const std::size_t n = source.n;
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
    Buffer<Box> bounds(blocks);
    const auto fill = [&](std::size_t l, std::size_t begin, std::size_t end) {
        const PackedSource below =
            l == 0 ? source
                   : PackedSource{&bounds[first_[l - 1]], sizeof(Box), nullptr, size_of(l - 1)};
        fill_packed(below, begin, end, &blocks_[first_[l]], &bounds[first_[l]]);
    };
    const std::size_t leaves = size_of(0), parts = (leaves + w - 1) / w;
    const std::size_t chunks = std::min(parts, chunks_for(n, executor));
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(parts, chunks, c);
        if (order.data() != items_.data())
            std::copy_n(order.data() + range.begin * w * w,
                        std::min(n, range.end * w * w) - range.begin * w * w,
                        items_.data() + range.begin * w * w);
        fill(0, range.begin * w, std::min(leaves, range.end * w));
        if (depth_ > 1)
            fill(1, range.begin, range.end);
    });
    for (std::size_t l = 2; l < depth_; ++l)
        fill(l, 0, size_of(l));
    bounds_ = bounds[blocks - 1];
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
    hold(n);
    make({boxes.data(), sizeof(Box), order.data(), n}, order, executor);
}

/// Makes room for the items; the lanes beyond them are 0.
void PackedLayout::hold(std::size_t n) {
    const std::size_t lanes = (n + w - 1) / w * w;
    if (items_.size() != lanes)
        items_ = Buffer<std::uint32_t>(lanes);
    std::fill(items_.begin() + n, items_.end(), 0u);
}

void PackedLayout::refit(Boxes boxes, const Executor& executor) {
    make({boxes.data(), sizeof(Box), items_.data(), boxes.size()},
         items_.span().first(boxes.size()), executor);
}

PackedLayout::PackedLayout(const Tree& tree, const Executor& executor) {
    const std::size_t n = tree.size();
    hold(n);
    Buffer<std::uint32_t> leaves(n);
    const std::size_t chunks = chunks_for(n, executor);
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(tree.nodes.size(), chunks, c);
        for (std::size_t i = range.begin; i < range.end; ++i)
            if (tree.is_leaf(i))
                leaves[tree.nodes[i].first] = static_cast<std::uint32_t>(i);
    });
    static_assert(offsetof(TreeNode, box) == 0);
    make({n ? &tree.nodes[0].box : nullptr, sizeof(TreeNode), leaves.data(), n}, tree.order.span(),
         executor);
}

LayoutEntry packed_layout() { return layout_entry<PackedLayout>(); }

} // namespace boxwood
