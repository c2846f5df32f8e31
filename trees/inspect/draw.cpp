#include "trees/inspect/draw.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace boxwood {
namespace {

constexpr std::uint32_t max_named = 8;

/// A quantum for coordinates that leaves the largest of the box four digits, a power of ten.
double quantum_of(const Box& box) {
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const float v : {box.min[axis], box.max[axis]})
            largest = std::max(largest, std::abs(static_cast<double>(v)));
    return largest > 0 ? std::pow(10, std::floor(std::log10(largest)) - 3) : 1;
}

std::string box_text(const Box& box, double quantum) {
    const auto rounded = [&](float v) {
        return std::round(static_cast<double>(v) / quantum) * quantum + 0; // + 0: no "-0"
    };
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
        char part[80];
        std::snprintf(part, sizeof part, "%s%c [%.5g, %.5g]", axis ? "  " : "", "xyz"[axis],
                      rounded(box.min[axis]), rounded(box.max[axis]));
        text += part;
    }
    return text;
}

/// Columns on the terminal of UTF-8 text: its bytes but the continuation bytes.
std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

} // namespace

std::string describe(const Tree& tree, std::size_t node, std::span<const std::string> names) {
    const auto name_of_slot = [&](std::uint32_t slot) {
        const std::uint32_t item = tree.order[slot];
        return names.empty() ? std::to_string(item) : names[item];
    };
    const auto [box, first, count] = tree.nodes[node];
    if (count == 1)
        return name_of_slot(first);
    if (count > max_named)
        return "{" + std::to_string(count) + " items}";
    std::string text = "{";
    for (std::uint32_t slot = first; slot < first + count; ++slot) {
        text += slot == first ? "" : ", "; // one sum of both warns in g++ 12
        text += name_of_slot(slot);
    }
    return text + "}";
}

std::string draw(const Tree& tree, std::span<const std::string> names) {
    if (!names.empty() && names.size() != tree.size())
        throw std::invalid_argument("draw: " + std::to_string(names.size()) + " names for " +
                                    std::to_string(tree.size()) + " items");
    if (tree.empty())
        return "(empty tree)\n";

    struct Line {
        std::size_t node;
        std::string stem;  ///< what stands before the name
        std::string below; ///< what stands before the stems of the children
    };
    // Depth-first with a stack of our own: a tree may be deeper than the call stack.
    std::vector<Line> stack{{0, "", ""}};
    std::vector<std::pair<std::string, std::string>> rows;
    std::size_t widest = 0;
    const double quantum = quantum_of(tree.nodes[0].box);
    while (!stack.empty()) {
        const Line line = std::move(stack.back());
        stack.pop_back();
        rows.emplace_back(line.stem + describe(tree, line.node, names),
                          box_text(tree.nodes[line.node].box, quantum));
        widest = std::max(widest, width(rows.back().first));
        if (tree.is_leaf(line.node))
            continue;
        stack.push_back({tree.right(line.node), line.below + "└── ", line.below + "    "});
        stack.push_back({Tree::left(line.node), line.below + "├── ", line.below + "│   "});
    }
    std::string text;
    for (const auto& [left, right] : rows)
        text += left + std::string(widest - width(left) + 2, ' ') + right + '\n';
    return text;
}

} // namespace boxwood
