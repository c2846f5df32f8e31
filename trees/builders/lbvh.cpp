// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/builders/lbvh.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/builders/lbvh.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

#ifndef BOXWOOD_RADIX_TREE
#define BOXWOOD_RADIX_TREE
namespace boxwood {

/// A subtree: its node, and the slots [begin, end) of its items.
struct RadixPart {
    std::uint32_t node, begin, end;
    std::uint32_t count() const { return end - begin; }
};

/// What the items of slots are: their boxes by `order`, their codes ascending.
struct SortedItems {
    const Box* boxes;
    const std::uint32_t* order;
    const std::uint64_t* codes;

    /// How high in the tree the items of slots i - 1 and i part: the first of the bits in which
    /// their codes differ, or below all of these of their slots. Between two of these keys within
    /// one subtree the greater has the higher bit, so they are compared as they are.
    std::uint64_t parting(std::size_t i) const {
        const std::uint64_t differing = codes[i - 1] ^ codes[i];
        return differing ? differing + (std::uint64_t{1} << 32) : (i - 1) ^ i;
    }
};

} // namespace boxwood
#endif

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_MAX_BYTES >= 32
/// A node in one register, as it lies in memory: min, max, first, count.
class NodeLanes {
    static constexpr hn::FixedTag<float, 8> df{};
    static constexpr hn::Repartition<std::uint64_t, decltype(df)> du{};
    using V = hn::Vec<decltype(df)>;
    V node_;

    static HWY_INLINE V with_items(V box, std::uint32_t first, std::uint32_t count) {
        const auto items = hn::BitCast(df, hn::Set(du, std::uint64_t{count} << 32 | first));
        return hn::IfThenElse(hn::FirstN(df, 6), box, items);
    }

  public:
    HWY_INLINE NodeLanes(const Box& box, std::uint32_t slot)
        : node_(with_items(hn::MaskedLoad(hn::FirstN(df, 6), df, &box.min.x), slot, 1)) {}
    HWY_INLINE void Extend(const TreeNode& node, std::uint32_t first, std::uint32_t count) {
        const V other = hn::Load(df, &node.box.min.x);
        const V box =
            hn::IfThenElse(hn::FirstN(df, 3), hn::Min(node_, other), hn::Max(node_, other));
        node_ = with_items(box, first, count);
    }
    HWY_INLINE void Store(TreeNode& to) const { hn::Store(node_, df, &to.box.min.x); }
};
#else
class NodeLanes {
    TreeNode node_;

  public:
    NodeLanes(const Box& box, std::uint32_t slot) : node_{box, slot, 1} {}
    void Extend(const TreeNode& node, std::uint32_t first, std::uint32_t count) {
        node_.box.extend(node.box);
        node_.first = first;
        node_.count = count;
    }
    void Store(TreeNode& to) const { to = node_; }
};
#endif

/// Writes a subtree from its last node to its first. Depth-first order backwards is: the right
/// child, the left child, the node. So each item in turn becomes the leftmost of all subtrees that
/// are complete: those to its right that part from it at a lower bit than the item to its left.
void WriteRadixPart(const SortedItems& items, const RadixPart& part, TreeNode* nodes) {
    constexpr std::uint32_t ahead = 16;
    TreeNode* at = nodes + part.node + 2 * std::size_t{part.count()} - 1;
    for (std::uint32_t i = part.end; i-- > part.begin;) {
        if (i >= ahead)
            __builtin_prefetch(items.boxes + items.order[i - ahead]);
        NodeLanes node(items.boxes[items.order[i]], i);
        node.Store(*--at);
        const std::uint64_t left =
            i > part.begin ? items.parting(i) : std::numeric_limits<std::uint64_t>::max();
        for (std::uint32_t end = i + 1; end < part.end && items.parting(end) < left;) {
            const TreeNode& right = at[2 * std::size_t{end - i} - 1];
            end += right.count;
            node.Extend(right, i, end - i);
            node.Store(*--at);
        }
    }
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(WriteRadixPart);

namespace {

/// The first slot of the right child of a subtree of two or more items.
std::uint32_t middle(const SortedItems& items, const RadixPart& part) {
    const std::uint64_t differing = items.codes[part.begin] ^ items.codes[part.end - 1];
    if (differing == 0) {
        const std::uint32_t last = part.end - 1;
        return last & ~(std::bit_floor(part.begin ^ last) - 1);
    }
    const std::uint64_t bit = std::bit_floor(differing);
    return static_cast<std::uint32_t>(
        std::partition_point(items.codes + part.begin, items.codes + part.end,
                             [&](std::uint64_t code) { return (code & bit) == 0; }) -
        items.codes);
}

/// Subtrees to share out, and `top`, the subtrees that these are parts of.
std::vector<RadixPart> cut(const SortedItems& items, std::uint32_t n, std::vector<RadixPart>& top) {
    const std::uint32_t small = std::max(4096u, n / 64);
    std::vector<RadixPart> parts, waiting{{0, 0, n}};
    while (!waiting.empty()) {
        const RadixPart part = waiting.back();
        waiting.pop_back();
        if (part.count() <= small) {
            parts.push_back(part);
            continue;
        }
        top.push_back(part);
        const std::uint32_t at = middle(items, part);
        waiting.push_back({part.node + 2 * (at - part.begin), at, part.end});
        waiting.push_back({part.node + 1, part.begin, at});
    }
    return parts;
}

} // namespace

Tree LbvhBuilder::build(Boxes boxes, const Executor& executor) const {
    CurveOrder sorted = curve_order(boxes, curve(), executor);
    Tree tree(boxes.size());
    if (tree.empty())
        return tree;
    tree.order = std::move(sorted.order);
    const SortedItems items{boxes.data(), tree.order.data(), sorted.codes.data()};
    std::vector<RadixPart> top;
    const std::vector<RadixPart> parts = cut(items, static_cast<std::uint32_t>(boxes.size()), top);
    executor.for_each(parts.size(), [&](std::size_t i) {
        HWY_DYNAMIC_DISPATCH(WriteRadixPart)(items, parts[i], tree.nodes.data());
    });
    std::ranges::sort(top, std::ranges::greater{}, &RadixPart::node);
    for (const RadixPart& part : top) {
        const TreeNode& left = tree.nodes[Tree::left(part.node)];
        const TreeNode& right = tree.nodes[part.node + 2 * std::size_t{left.count}];
        tree.nodes[part.node] = {merge(left.box, right.box), part.begin, part.count()};
    }
    return tree;
}

Buffer<std::uint32_t> LbvhBuilder::order(Boxes boxes, const Executor& executor) const {
    return coarse_curve_order(boxes, curve(), executor);
}

BuilderEntry lbvh_builder() { return builder_entry<LbvhBuilder>(); }

} // namespace boxwood
#endif
