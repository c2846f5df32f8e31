#include "bench/explaining/drawing.h"
#include "bench/explaining/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace boxwood::bench {
namespace {

/// The nodes from the root to the leaf of an item.
std::vector<std::size_t> way_to(const Tree& tree, std::uint32_t item) {
    const auto slot =
        static_cast<std::size_t>(std::ranges::find(tree.order, item) - tree.order.begin());
    if (slot == tree.order.size())
        throw std::invalid_argument(fmt::format("the tree holds no item {}", item));
    std::vector<std::size_t> way{0};
    while (!tree.is_leaf(way.back())) {
        const std::size_t left = Tree::left(way.back());
        const TreeNode& node = tree.nodes[left];
        way.push_back(slot < node.first + std::size_t{node.count} ? left : tree.right(way.back()));
    }
    return way;
}

/// "apart along y by 0.25 (1.5 and 1.75)", of the widest gap; "share ..." where there is none.
template <class T> std::string between(const Aabb<T>& a, const Aabb<T>& b) {
    int widest = -1;
    double gap = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto from_to = [&](const Aabb<T>& first, const Aabb<T>& second) {
            return static_cast<double>(second.min[axis]) - static_cast<double>(first.max[axis]);
        };
        const double here = std::max(from_to(a, b), from_to(b, a));
        if (here > gap) {
            gap = here;
            widest = axis;
        }
    }
    if (widest < 0) {
        return fmt::format("share {}", box_text(Aabb<T>{max(a.min, b.min), min(a.max, b.max)}));
    }
    const bool a_first = a.max[widest] < b.min[widest];
    return fmt::format("are apart along {} by {:.6g} ({} and {})", "xyz"[widest], gap,
                       a_first ? a.max[widest] : b.max[widest],
                       a_first ? b.min[widest] : a.min[widest]);
}

std::string node_text(const Tree& tree, std::size_t node) {
    return tree.is_leaf(node) ? fmt::format("leaf of item {}", tree.item(node))
                              : fmt::format("node {} ({} items)", node, tree.nodes[node].count);
}

} // namespace

Explanation explain_pair(const Tree& tree, Boxes boxes, std::uint32_t a, std::uint32_t b,
                         std::span<const Aabb<double>> exact) {
    if (a == b || a >= boxes.size() || b >= boxes.size())
        throw std::invalid_argument(fmt::format(
            "{} and {} are no two of {} items, which count from 0", a, b, boxes.size()));
    const bool is_pair =
        exact.empty() ? overlaps(boxes[a], boxes[b]) : overlaps(exact[a], exact[b]);
    const auto head = [&](const auto& of_a, const auto& of_b) {
        return fmt::format("Items {} and {} {} a pair: their boxes {}.\n  {:<8} {}\n  {:<8} {}\n",
                           a, b, is_pair ? "are" : "are not", between(of_a, of_b), a,
                           box_text(of_a), b, box_text(of_b));
    };
    Explanation answer;
    answer.text = exact.empty() ? head(boxes[a], boxes[b]) : head(exact[a], exact[b]);
    answer.text +=
        fmt::format("\nThe tree: {} items, {} nodes{}. On the way to them:\n", tree.size(),
                    tree.nodes.size(), exact.empty() ? "" : ", of boxes rounded outward to floats");
    const std::vector<std::size_t> to_a = way_to(tree, a), to_b = way_to(tree, b);
    Drawing drawing(fmt::format("items {} and {}: {}", a, b, is_pair ? "a pair" : "no pair"));
    std::size_t depth = 0;
    for (; to_a[depth] == to_b[depth]; ++depth) {
        answer.text +=
            fmt::format("  depth {:<3} {} holds both\n", depth, node_text(tree, to_a[depth]));
        drawing.box(tree.bounds(to_a[depth]), "node");
    }
    // Below, two subtrees are compared; the larger goes on, as long as their boxes overlap.
    std::size_t i = depth, j = depth, compared = 0;
    for (;;) {
        const Box &of_a = tree.bounds(to_a[i]), &of_b = tree.bounds(to_b[j]);
        const bool goes_on = overlaps(of_a, of_b);
        ++compared;
        drawing.box(of_a, "first");
        drawing.box(of_b, "second");
        answer.text +=
            fmt::format("  compared  {} with {}: their boxes {}\n", node_text(tree, to_a[i]),
                        node_text(tree, to_b[j]), between(of_a, of_b));
        if (!goes_on) {
            answer.text += fmt::format("\nSo nothing below them is compared: {} of boxes {} "
                                       "enough.\n",
                                       compared == 1 ? "one comparison"
                                                     : fmt::format("{} comparisons", compared),
                                       compared == 1 ? "was" : "were");
            break;
        }
        const bool a_ends = i + 1 == to_a.size(), b_ends = j + 1 == to_b.size();
        if (a_ends && b_ends && !is_pair) {
            answer.text +=
                "\nSo they are a candidate, and the boxes as they are given, in doubles, "
                "decide: they are apart, and the pair is dropped.\n";
            break;
        }
        if (a_ends && b_ends) {
            answer.text += fmt::format("\nSo the pair is reported, after {} of boxes. A "
                                       "point that both boxes have is enough.\n",
                                       compared == 1 ? "one comparison"
                                                     : fmt::format("{} comparisons", compared));
            break;
        }
        if (b_ends || (!a_ends && tree.nodes[to_a[i]].count >= tree.nodes[to_b[j]].count))
            ++i;
        else
            ++j;
    }
    drawing.box(boxes[a], "item-a", fmt::format("{}", a));
    drawing.box(boxes[b], "item-b", fmt::format("{}", b));
    answer.svg = drawing.svg();
    return answer;
}

} // namespace boxwood::bench
