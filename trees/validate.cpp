#include "trees/validate.h"

#include <string_view>
#include <vector>

namespace boxwood {
namespace {

std::string text(std::size_t i) { return std::to_string(i); }

/// The slots and their items; nothing if `order` is a permutation of 0 .. n - 1.
std::optional<std::string> fault_in_order(const Tree& tree) {
    const std::size_t n = tree.size();
    std::vector<std::size_t> slot_of(n, n);
    for (std::size_t slot = 0; slot < n; ++slot) {
        const std::uint32_t item = tree.order[slot];
        if (item >= n)
            return "slot " + text(slot) + ": item " + text(item) + " of a tree of " + text(n) +
                   " items";
        if (slot_of[item] != n)
            return "slot " + text(slot) + ": item " + text(item) + " is in slot " +
                   text(slot_of[item]) + " already";
        slot_of[item] = slot;
    }
    return {};
}

/// Walks the nodes in index order. What a node's slots must be follows from its ancestors, and
/// waits on a stack: each node takes the top, an inner one pushes its right and then its left
/// child. As the stack's counts always fill the nodes still to come, node i + 1 of an inner node i
/// exists.
std::optional<std::string> fault_in_shape(const Tree& tree) {
    struct Slots {
        std::size_t first, count;
    };
    std::vector<Slots> pending{{0, tree.size()}};
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const auto [first, count] = pending.back();
        pending.pop_back();
        if (tree.nodes[i].first != first || tree.nodes[i].count != count)
            return "node " + text(i) + ": first " + text(tree.nodes[i].first) + ", count " +
                   text(tree.nodes[i].count) +
                   "; its place in the depth-first order asks for first " + text(first) +
                   ", count " + text(count);
        if (count == 1)
            continue;
        const std::size_t left = tree.nodes[i + 1].count;
        if (left == 0 || left >= count)
            return "node " + text(i + 1) + ": count " + text(left) +
                   " of a left child whose parent, node " + text(i) + ", has " + text(count);
        pending.push_back({first + left, count - left});
        pending.push_back({first, left});
    }
    return {};
}

std::optional<std::string> fault_in_boxes(const Tree& tree, Boxes boxes, Bounds bounds) {
    const std::string_view verb = bounds == Bounds::tight ? " is not exactly " : " does not hold ";
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const bool leaf = tree.is_leaf(i);
        const Box below = leaf
                              ? boxes[tree.item(i)]
                              : merge(tree.nodes[Tree::left(i)].box, tree.nodes[tree.right(i)].box);
        const Box& box = tree.nodes[i].box;
        if (bounds == Bounds::tight ? box == below : box.contains(below))
            continue;
        return "node " + text(i) + ": its box" + std::string(verb) +
               (leaf ? "the box of its item " + text(tree.item(i))
                     : "the union of its children, nodes " + text(Tree::left(i)) + " and " +
                           text(tree.right(i)));
    }
    return {};
}

} // namespace

std::optional<std::string> validate(const Tree& tree, Boxes boxes, Bounds bounds) {
    const std::size_t n = tree.size();
    if (n != boxes.size())
        return "the tree holds " + text(n) + " items, but there are " + text(boxes.size()) +
               " boxes";
    if (const std::size_t nodes = n ? 2 * n - 1 : 0; tree.nodes.size() != nodes)
        return text(tree.nodes.size()) + " nodes, but " + text(n) + " items need " + text(nodes);
    if (auto fault = fault_in_order(tree))
        return fault;
    if (auto fault = fault_in_shape(tree))
        return fault;
    return fault_in_boxes(tree, boxes, bounds);
}

} // namespace boxwood
