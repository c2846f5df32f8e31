#include "trees/builders/hilbert.h"
#include "trees/curve_order.h"
#include "trees/radix_sort.h"

#include <algorithm>
#include <array>
#include <vector>

namespace boxwood {
namespace {

/// Half of the extents, which cannot overflow.
Vec3<float> half_extent(const Box& box) { return .5f * box.max - .5f * box.min; }

/// Whether the boxes are far longer along one axis than along the others: by the mean extents of a
/// sample of at most 4096.
bool are_long(Boxes boxes) {
    constexpr double far = 3; // bars have 20 and planks 1; boxes of random extents have 1.5
    const std::size_t step = boxes.size() / 4096 + 1;
    double middle = 0, longest = 0;
    for (std::size_t i = 0; i < boxes.size(); i += step) {
        const Vec3<float> half = half_extent(boxes[i]);
        std::array<float, 3> extent{half.x, half.y, half.z};
        std::ranges::sort(extent);
        middle += static_cast<double>(extent[1]);
        longest += static_cast<double>(extent[2]);
    }
    return longest > far * middle;
}

/// Ties to the first.
std::size_t longest_axis(const Box& box) {
    const Vec3<float> e = half_extent(box);
    return e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
}

/// Some of the items along the curve through their own centres.
Buffer<std::uint32_t> order_of(Boxes boxes, std::span<const std::uint32_t> items,
                               const Executor& executor) {
    Buffer<Box> some(items.size());
    const std::size_t chunks = chunks_for(items.size(), executor);
    executor.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(items.size(), chunks, c);
        for (std::size_t i = range.begin; i < range.end; ++i)
            some[i] = boxes[items[i]];
    });
    Buffer<std::uint32_t> order = coarse_curve_order(some.span(), Curve::hilbert, executor);
    for (std::uint32_t& slot : order)
        slot = items[slot];
    return order;
}

/// A subtree still to build: `count` slots from `first`, its top at `node`.
struct Part {
    std::size_t node, first, count;
    /// Slots of the left child: half of them, whole blocks of sixteen if there are more.
    std::size_t left() const {
        constexpr std::size_t block = 16;
        const std::size_t half = (count + 1) / 2;
        return count <= block ? half : (half + block - 1) / block * block;
    }
};

/// Recurses no deeper than log2 n: both children have about half of the slots.
Box build_part(Tree& tree, Boxes boxes, Part part) {
    TreeNode& node = tree.nodes[part.node];
    node.first = static_cast<std::uint32_t>(part.first);
    node.count = static_cast<std::uint32_t>(part.count);
    if (part.count == 1)
        return node.box = boxes[tree.order[part.first]];
    const std::size_t left = part.left();
    node.box = build_part(tree, boxes, {part.node + 1, part.first, left});
    node.box.extend(
        build_part(tree, boxes, {part.node + 2 * left, part.first + left, part.count - left}));
    return node.box;
}

} // namespace

Buffer<std::uint32_t> HilbertBuilder::order(Boxes boxes, const Executor& executor) const {
    if (!are_long(boxes))
        return coarse_curve_order(boxes, Curve::hilbert, executor);
    require_valid(boxes);
    std::array<std::vector<std::uint32_t>, 3> items;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        items[longest_axis(boxes[i])].push_back(static_cast<std::uint32_t>(i));
    Buffer<std::uint32_t> order(boxes.size());
    std::uint32_t* to = order.data();
    for (const std::vector<std::uint32_t>& same : items)
        to = std::ranges::copy(order_of(boxes, same, executor), to).out;
    return order;
}

Tree HilbertBuilder::build(Boxes boxes, const Executor& executor) const {
    Buffer<std::uint32_t> slots = order(boxes, executor);
    Tree tree(boxes.size());
    tree.order = std::move(slots);
    if (tree.empty())
        return tree;
    // The parts of at most 4096 slots, and the nodes above them in depth-first order.
    constexpr std::size_t small = 4096;
    std::vector<Part> open{{0, 0, boxes.size()}}, parts, tops;
    while (!open.empty()) {
        const Part part = open.back();
        open.pop_back();
        if (part.count <= small) {
            parts.push_back(part);
            continue;
        }
        tops.push_back(part);
        const std::size_t left = part.left();
        open.push_back({part.node + 2 * left, part.first + left, part.count - left});
        open.push_back({part.node + 1, part.first, left});
    }
    executor.for_each(parts.size(), [&](std::size_t i) { build_part(tree, boxes, parts[i]); });
    for (std::size_t i = tops.size(); i-- > 0;) {
        const Part& top = tops[i];
        tree.nodes[top.node] = {
            merge(tree.nodes[top.node + 1].box, tree.nodes[top.node + 2 * top.left()].box),
            static_cast<std::uint32_t>(top.first), static_cast<std::uint32_t>(top.count)};
    }
    return tree;
}

BuilderEntry hilbert_builder() { return builder_entry<HilbertBuilder>(); }

} // namespace boxwood
