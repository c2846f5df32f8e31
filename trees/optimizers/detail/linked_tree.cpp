#include "trees/optimizers/detail/linked_tree.h"

#include "trees/executors/chunks.h"

#include <algorithm>
#include <cmath>

namespace boxwood::detail {

LinkedTree::LinkedTree(const Tree& tree, const Executor& executor)
    : tree_(tree), executor_(executor), links_(2 * tree.size()) {
    double extent = 0;
    for (int k = 0; k < 3; ++k)
        extent = std::max(extent, static_cast<double>(tree.nodes[0].box.max[k]) -
                                      static_cast<double>(tree.nodes[0].box.min[k]));
    const double scale = extent > 0 ? std::exp2(-std::ilogb(extent)) : 1;

    // The k-th inner node in depth-first order has the pair k + 1 for its children: node i, with s
    // leaves before it, has i - s inner nodes before it.
    const std::size_t n = tree.nodes.size(), chunks = chunks_for(n, executor);
    const auto for_nodes = [&](const auto& body) {
        executor.for_each(chunks, [&](std::size_t c) {
            const ChunkRange range(n, chunks, c);
            for (auto i = static_cast<std::uint32_t>(range.begin); i < range.end; ++i)
                body(i, tree.nodes[i]);
        });
    };
    const auto pair_below = [](std::uint32_t i, const TreeNode& node) {
        return 2 * (i - node.first + 1);
    };
    Buffer<std::uint32_t> place(n);
    place[0] = 0;
    for_nodes([&](std::uint32_t i, const TreeNode& node) {
        if (node.count == 1)
            return;
        place[Tree::left(i)] = pair_below(i, node);
        place[tree.right(i)] = pair_below(i, node) + 1;
    });
    links_[1] = {{0, 0, 0}, Link::leaf_bit, {0, 0, 0}, 0};
    links_[0].above = 0;
    for_nodes([&](std::uint32_t i, const TreeNode& node) {
        Link& link = links_[place[i]];
        for (int k = 0; k < 3; ++k) {
            link.min[k] = static_cast<float>(static_cast<double>(node.box.min[k]) * scale);
            link.max[k] = static_cast<float>(static_cast<double>(node.box.max[k]) * scale);
        }
        if (node.count == 1) {
            link.below = Link::leaf_bit | i;
            return;
        }
        link.below = pair_below(i, node);
        links_[link.below].above = links_[link.below + 1].above = place[i];
    });
}

/// The roots of some hundred subtrees that share the leaves, in depth-first order.
std::vector<std::uint32_t> LinkedTree::cut() const {
    constexpr int levels = 9;
    std::vector<std::uint32_t> roots{0}, next;
    for (int level = 0; level < levels && links_.size() >> level > 256; ++level) {
        next.clear();
        for (const std::uint32_t root : roots) {
            const Link& link = links_[root];
            next.push_back(link.is_leaf() ? root : link.below);
            if (!link.is_leaf())
                next.push_back(link.below + 1);
        }
        roots.swap(next);
    }
    return roots;
}

std::uint32_t LinkedTree::leaves_below(std::uint32_t root) const {
    std::vector<std::uint32_t> open{root};
    std::uint32_t n = 0;
    while (!open.empty()) {
        const Link& link = links_[open.back()];
        open.pop_back();
        if (link.is_leaf()) {
            ++n;
        } else {
            open.push_back(link.below + 1);
            open.push_back(link.below);
        }
    }
    return n;
}

namespace {

/// The box and the count of an inner node, once its children have theirs. The right child is the
/// root of the subtree that follows the left one.
void join_children(Tree& tree, std::size_t i) {
    const TreeNode& left = tree.nodes[Tree::left(i)];
    const TreeNode& right = tree.nodes[tree.right(i)];
    tree.nodes[i].box = merge(left.box, right.box);
    tree.nodes[i].count = left.count + right.count;
}

} // namespace

/// A subtree from `node` and `slot` on, in depth-first order.
void LinkedTree::write(std::uint32_t root, std::uint32_t node, std::uint32_t slot,
                       Tree& made) const {
    std::vector<std::uint32_t> open{root};
    std::uint32_t i = node;
    for (; !open.empty(); ++i) {
        const Link& link = links_[open.back()];
        open.pop_back();
        made.nodes[i].first = slot;
        made.nodes[i].count = 0;
        if (link.is_leaf()) {
            const TreeNode& old = tree_.nodes[link.below & ~Link::leaf_bit];
            made.nodes[i] = {old.box, slot, 1};
            made.order[slot++] = tree_.order[old.first];
        } else {
            open.push_back(link.below + 1);
            open.push_back(link.below);
        }
    }
    while (i-- > node)
        if (made.nodes[i].count == 0)
            join_children(made, i);
}

Tree LinkedTree::canonical() const {
    const std::vector<std::uint32_t> parts = cut();
    std::vector<std::uint32_t> leaves(parts.size());
    executor_.for_each(parts.size(), [&](std::size_t p) { leaves[p] = leaves_below(parts[p]); });

    struct Place {
        std::uint32_t node, slot;
    };
    Tree made(tree_.size());
    made.is_split = tree_.is_split;
    std::vector<Place> places;
    std::vector<std::uint32_t> top, open{0};
    Place at{0, 0};
    while (!open.empty()) {
        const std::uint32_t i = open.back();
        open.pop_back();
        if (const std::size_t p = places.size(); i == parts[p]) {
            places.push_back(at);
            at.node += 2 * leaves[p] - 1;
            at.slot += leaves[p];
            continue;
        }
        top.push_back(at.node);
        made.nodes[at.node++].first = at.slot;
        open.push_back(links_[i].below + 1);
        open.push_back(links_[i].below);
    }
    executor_.for_each(parts.size(), [&](std::size_t p) {
        write(parts[p], places[p].node, places[p].slot, made);
    });
    for (std::size_t i = top.size(); i-- > 0;)
        join_children(made, top[i]);
    return made;
}

} // namespace boxwood::detail
