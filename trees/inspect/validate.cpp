#include "trees/inspect/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
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

/// Visits the nodes in index order. What a node's slots must be follows from its ancestors, and
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

/// Whether a point, known to within `error`, lies in one of the boxes.
bool covered(const Vec3<double>& p, const Vec3<double>& error, std::span<const Box> boxes) {
    return std::ranges::any_of(boxes, [&](const Box& box) {
        for (int k = 0; k < 3; ++k)
            if (p[k] + error[k] < static_cast<double>(box.min[k]) ||
                p[k] - error[k] > static_cast<double>(box.max[k]))
                return false;
        return true;
    });
}

/// A point of the triangle that none of the boxes holds, if one is found: where two weights are
/// multiples of 1/16. The sum of three products is off by at most 2^-51 of the largest coordinate.
std::optional<Vec3<double>> uncovered_point(const Triangle<float>& t, std::span<const Box> boxes) {
    const Vec3<double> a(t.a), b(t.b), c(t.c);
    Vec3<double> error;
    for (int k = 0; k < 3; ++k)
        error[k] = 0x1p-51 * std::max({std::abs(a[k]), std::abs(b[k]), std::abs(c[k])});
    for (int i = 0; i <= 16; ++i)
        for (int j = 0; i + j <= 16; ++j) {
            const Vec3<double> p = a * (i / 16.) + b * (j / 16.) + c * ((16 - i - j) / 16.);
            if (!covered(p, error, boxes))
                return p;
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

std::optional<std::string> validate_split(const Tree& tree, const TriangleMesh& mesh) {
    const std::size_t m = tree.size(), n = mesh.triangles.size();
    if (!tree.is_split)
        return "the tree is not marked as split";
    if (const std::size_t nodes = m ? 2 * m - 1 : 0; tree.nodes.size() != nodes)
        return text(tree.nodes.size()) + " nodes, but " + text(m) + " leaves need " + text(nodes);
    if (auto fault = fault_in_shape(tree))
        return fault;

    // The leaf boxes sorted by item.
    std::vector<std::size_t> starts(n + 1, 0);
    for (std::size_t slot = 0; slot < m; ++slot) {
        if (tree.order[slot] >= n)
            return "slot " + text(slot) + ": item " + text(tree.order[slot]) + " of a mesh of " +
                   text(n) + " triangles";
        ++starts[tree.order[slot] + std::size_t{1}];
    }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<Box> parts(m);
    std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const Box& box = tree.nodes[i].box;
        if (!tree.is_leaf(i)) {
            const std::size_t left = Tree::left(i), right = tree.right(i);
            if (!(box == merge(tree.nodes[left].box, tree.nodes[right].box)))
                return "node " + text(i) +
                       ": its box is not exactly the union of its children, nodes " + text(left) +
                       " and " + text(right);
            continue;
        }
        const std::uint32_t item = tree.item(i);
        if (!box.is_valid() || !mesh.triangle(item).bounds().contains(box))
            return "node " + text(i) + ": its box is not part of that of its triangle " +
                   text(item);
        parts[next[item]++] = box;
    }
    for (std::size_t item = 0; item < n; ++item) {
        const auto of_item =
            std::span(parts).subspan(starts[item], starts[item + 1] - starts[item]);
        if (of_item.empty())
            return "triangle " + text(item) + " is in no slot";
        if (const auto p = uncovered_point(mesh.triangle(item), of_item))
            return "triangle " + text(item) + ": none of its " + text(of_item.size()) +
                   " leaf boxes holds its point (" + std::to_string(p->x) + ", " +
                   std::to_string(p->y) + ", " + std::to_string(p->z) + ")";
    }
    return {};
}

} // namespace boxwood
