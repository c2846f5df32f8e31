#include "trees/builders/hilbert.h"

#include <algorithm>
#include <array>
#include <vector>

namespace boxwood {
namespace {

/// Half of the extents, which cannot overflow.
Vec3<float> half_extent(const Box& box) { return .5f * box.max - .5f * box.min; }

/// Whether the boxes are far longer along one axis than along the others: by the mean extents of a
/// sample of at most 1024.
bool are_long(Boxes boxes) {
    constexpr double far = 3; // bars have 20 and planks 1; boxes of random extents have 1.5
    const std::size_t step = boxes.size() / 1024 + 1;
    double middle = 0, longest = 0;
    for (std::size_t i = 0; i < boxes.size(); i += step) {
        const Vec3<float> e = half_extent(boxes[i]);
        const float low = std::min(e.x, e.y), high = std::max(e.x, e.y);
        middle += static_cast<double>(std::max(low, std::min(high, e.z)));
        longest += static_cast<double>(std::max(high, e.z));
    }
    return longest > far * middle;
}

/// Ties to the first. Without branches: of boxes in any order they would be mispredicted.
std::uint32_t longest_axis(const Box& box) {
    const Vec3<float> e = half_extent(box);
    const std::uint32_t y_longer = e.y > e.x;
    const std::uint32_t z_longest = e.z > std::max(e.x, e.y);
    return (y_longer & ~z_longest) | z_longest << 1;
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

GroupOfBox HilbertBuilder::groups(Boxes boxes) { return are_long(boxes) ? longest_axis : nullptr; }

Buffer<std::uint32_t> HilbertBuilder::order(Boxes boxes, const Executor& executor,
                                            const Box* centres) const {
    return block_curve_order(boxes, Curve::hilbert, groups(boxes), executor, centres);
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

BuilderEntry hilbert_builder() {
    BuilderEntry entry = builder_entry<HilbertBuilder>();
    entry.is_reference = true;
    return entry;
}

} // namespace boxwood
