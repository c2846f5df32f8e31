// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/builders/lbvh.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/builders/detail/radix_items.h"
#include "trees/builders/lbvh.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

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
    HWY_INLINE void extend(const TreeNode& node, std::uint32_t first, std::uint32_t count) {
        const V other = hn::Load(df, &node.box.min.x);
        const V box =
            hn::IfThenElse(hn::FirstN(df, 3), hn::Min(node_, other), hn::Max(node_, other));
        node_ = with_items(box, first, count);
    }
    HWY_INLINE void store(TreeNode& to) const { hn::Store(node_, df, &to.box.min.x); }
};
#else
class NodeLanes {
    TreeNode node_;

  public:
    NodeLanes(const Box& box, std::uint32_t slot) : node_{box, slot, 1} {}
    void extend(const TreeNode& node, std::uint32_t first, std::uint32_t count) {
        node_.box.extend(node.box);
        node_.first = first;
        node_.count = count;
    }
    void store(TreeNode& to) const { to = node_; }
};
#endif

/// Writes a subtree from its last node to its first. Depth-first order backwards is: the right
/// child, the left child, the node. So each item in turn becomes the leftmost of all subtrees that
/// are complete: those to its right that part from it at a lower bit than the item to its left.
template <class Items>
void write_tree(const Items& items, const Box* boxes, const RadixPart& part, Tree& tree) {
    constexpr std::uint32_t ahead = 16;
    constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();
    // Where complete subtrees part, from right to left. Each lies at a lower bit than the one
    // before: of 63 of codes and 30 of places at most.
    std::uint64_t partings[96] = {never};
    std::uint64_t* nearest = partings;
    TreeNode* at = tree.nodes.data() + part.node + 2 * std::size_t{part.count()} - 1;
    std::uint32_t* const order = tree.order.data();
    for (std::uint32_t i = part.end; i-- > part.begin;) {
        if (i >= ahead)
            __builtin_prefetch(boxes + items.item(i - ahead));
        const std::uint32_t item = items.item(i);
        order[i] = item;
        NodeLanes node(boxes[item], i);
        node.store(*--at);
        const std::uint64_t left = i > part.begin ? items.parting(i) : never;
        std::uint32_t count = 1;
        while (*nearest < left) {
            --nearest;
            const TreeNode& right = at[2 * std::size_t{count} - 1];
            count += right.count;
            node.extend(right, i, count);
            node.store(*--at);
        }
        *++nearest = left;
    }
}

void write_coarse(const CoarseItems& items, const Box* boxes, const RadixPart& part, Tree& tree) {
    write_tree(items, boxes, part, tree);
}
void write_fine(const FineItems& items, const Box* boxes, const RadixPart& part, Tree& tree) {
    write_tree(items, boxes, part, tree);
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(write_coarse);
HWY_EXPORT(write_fine);
} // namespace boxwood::detail

namespace boxwood {
using namespace detail;

namespace {

/// The first slot of the right child of a subtree of two or more items.
template <class Items> std::uint32_t middle(const Items& items, const RadixPart& part) {
    const std::uint32_t last = part.end - 1;
    const std::uint64_t differing = items.differing(part.begin, last);
    if (differing == 0)
        return last & ~(std::bit_floor(part.begin ^ last) - 1);
    const std::uint64_t bit = std::bit_floor(differing);
    std::uint32_t lower = part.begin, upper = last;
    while (upper - lower > 1) {
        const std::uint32_t between = lower + (upper - lower) / 2;
        (items.has(between, bit) ? upper : lower) = between;
    }
    return upper;
}

/// Subtrees to share out, and `top`, the subtrees that these are parts of.
template <class Items>
std::vector<RadixPart> cut(const Items& items, std::uint32_t n, std::vector<RadixPart>& top) {
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

template <class Items, class Write>
Tree radix_tree(const Items& items, Boxes boxes, const Write& write, const Executor& executor) {
    Tree tree(boxes.size());
    std::vector<RadixPart> top;
    const auto parts = cut(items, static_cast<std::uint32_t>(boxes.size()), top);
    executor.for_each(parts.size(),
                      [&](std::size_t i) { write(items, boxes.data(), parts[i], tree); });
    std::ranges::sort(top, std::ranges::greater{}, &RadixPart::node);
    for (const RadixPart& part : top) {
        const TreeNode& left = tree.nodes[Tree::left(part.node)];
        const TreeNode& right = tree.nodes[part.node + 2 * std::size_t{left.count}];
        tree.nodes[part.node] = {merge(left.box, right.box), part.begin, part.count()};
    }
    return tree;
}

} // namespace

Tree LbvhBuilder::build(Boxes boxes, const Executor& executor) const {
    if (boxes.empty())
        return {};
    const MergeableOrder coarse = mergeable_curve_order(boxes, curve, nullptr, executor);
    if (!coarse.records.empty())
        return radix_tree(
            CoarseItems{coarse.records.data()}, boxes,
            [](auto&&... of) {
                HWY_DYNAMIC_DISPATCH(write_coarse)
                (of...);
            },
            executor);
    const CurveOrder fine = curve_order(boxes, curve, executor);
    return radix_tree(
        FineItems{fine.codes.data(), fine.order.data()}, boxes,
        [](auto&&... of) {
            HWY_DYNAMIC_DISPATCH(write_fine)
            (of...);
        },
        executor);
}

Buffer<std::uint32_t> LbvhBuilder::order(Boxes boxes, const Executor& executor) const {
    const MergeableOrder coarse = mergeable_curve_order(boxes, curve, nullptr, executor);
    if (coarse.records.empty())
        return curve_order(boxes, curve, executor).order;
    Buffer<std::uint32_t> order(boxes.size());
    std::ranges::transform(coarse.records, order.begin(),
                           [](std::uint64_t record) { return static_cast<std::uint32_t>(record); });
    return order;
}

BuilderEntry lbvh_builder() { return builder_entry<LbvhBuilder>(); }

} // namespace boxwood
#endif
