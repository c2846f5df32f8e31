#include "trees/dynamic/dynamic_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace boxwood {
namespace {

/// How much taller one child may be than its sibling: room for lopsided but good trees, none for a
/// chain. A tree of height h has at least N(h) = N(h - 1) + N(max(0, h - 1 - max_imbalance))
/// leaves, with N(0) = 1; up to max_items that is h <= 3.5 log2(n), at most 104.
constexpr int max_imbalance = 8;

int imbalance(int a, int b) { return a < b ? b - a : a - b; }

void require_valid(std::uint32_t item, const Box& box) {
    if (!box.is_valid())
        throw InvalidBox(item, "a NaN, an infinity or min > max; give finite corners, min <= max");
}

/// Half of the extents: the whole of them may be more than any float. In float up to here, as g++
/// 12 makes branches of the minima of a merge that is converted first.
Vec3<double> half_extents(const Box& b) {
    return static_cast<Vec3<double>>(0.5f * b.max - 0.5f * b.min);
}

/// The square of the distance between two centres.
double apart(const Box& a, const Box& b) {
    const auto centre = [](const Box& box) {
        return static_cast<Vec3<double>>(0.5f * box.min + 0.5f * box.max);
    };
    const Vec3<double> d = centre(a) - centre(b);
    return dot(d, d);
}

} // namespace

double DynamicTree::measure(const Box& box) const {
    const auto [x, y, z] = half_extents(box);
    return x * y + y * z + z * x + pad_ * (x + y + z);
}

void DynamicTree::reserve(std::size_t n) {
    node_pairs_.reserve(n);
    slot_of_.reserve(n);
}

void DynamicTree::insert(std::uint32_t item, Box box) {
    require_valid(item, box);
    if (item >= max_items)
        throw std::length_error("item " + std::to_string(item) +
                                ": a tree numbers its items below " + std::to_string(max_items));
    if (contains(item))
        throw std::invalid_argument("item " + std::to_string(item) +
                                    " is in the tree already; move it, or remove it first");
    if (item >= slot_of_.size())
        slot_of_.resize(std::size_t{item} + 1, none);
    attach(item, box);
}

void DynamicTree::remove(std::uint32_t item) {
    require(item);
    detach(item);
}

void DynamicTree::move(std::uint32_t item, Box box, Work* work) {
    const Slot s = require(item);
    require_valid(item, box);
    std::uint64_t nodes = 0;
    if (box_at(parent_of(parent_of(s))).contains(box)) {
        box_at(s) = box;
        nodes = repair(s);
    } else {
        nodes = detach(item);
        nodes += attach(item, box);
    }
    if (work)
        work->node_visits += nodes;
}

void DynamicTree::enlarge(std::uint32_t item, Box box) {
    Slot s = require(item);
    require_valid(item, box);
    if (!box.contains(box_at(s)))
        throw std::invalid_argument(
            "item " + std::to_string(item) +
            ": the box to enlarge it to does not hold the old one; move it");
    box_at(s) = box;
    while (s != root) {
        s = parent_of(s);
        if (box_at(s).contains(box))
            break;
        box_at(s).extend(box);
    }
}

void DynamicTree::clear() {
    node_pairs_.resize(1);
    slot_of_.clear();
    free_ = none;
    size_ = 0;
}

const Box& DynamicTree::box(std::uint32_t item) const { return box_at(require(item)); }

DynamicTree::Slot DynamicTree::require(std::uint32_t item) const {
    if (!contains(item))
        throw std::invalid_argument("item " + std::to_string(item) +
                                    " is not in the tree; insert it first");
    return slot_of_[item];
}

void DynamicTree::put(Slot s, const Box& box, std::uint32_t link, std::uint8_t height) {
    NodePair& pair = node_pairs_[s / 2];
    pair.box[s % 2] = box;
    pair.link[s % 2] = link;
    pair.height[s % 2] = height;
    if (link & leaf_bit)
        slot_of_[link ^ leaf_bit] = s;
    else
        node_pairs_[link].parent = s;
}

std::uint32_t DynamicTree::take_fork() {
    if (free_ == none) {
        node_pairs_.emplace_back();
        return static_cast<std::uint32_t>(node_pairs_.size() - 1);
    }
    return std::exchange(free_, node_pairs_[free_].parent);
}

/// Follows one path from the root. Beside a node with box b the new leaf costs size(b + box), for
/// their common parent, and the growth of all boxes above; below it, at least that growth, the
/// growth of b, and the size of `box` itself. Goes to the child with the lower bound and stops when
/// the best place seen is under both. Equal bounds are common, as both children may hold the box:
/// then the nearer centre decides, and at last the lesser height.
DynamicTree::Slot DynamicTree::find_sibling(const Box& box, std::uint64_t& nodes) const {
    const double own = measure(box);
    double merged = measure(merge(box_at(root), box));
    double best_cost = std::numeric_limits<double>::infinity();
    double grown = 0;
    Slot best = root;
    if (height_at(root) <= max_imbalance)
        best_cost = merged;
    for (Slot s = root; !is_leaf(s); ++nodes) {
        grown += merged - measure(box_at(s));
        const Slot child = 2 * link_at(s);
        for (const Slot side : {0u, 1u})
            if (!is_leaf(child + side))
                __builtin_prefetch(&node_pairs_[link_at(child + side)]);
        double beside[2], below[2];
        for (const Slot side : {0u, 1u}) {
            const Box& b = box_at(child + side);
            beside[side] = measure(merge(b, box));
            below[side] = grown + (beside[side] - measure(b)) + own;
            if (grown + beside[side] <= best_cost && height_at(child + side) <= max_imbalance) {
                best_cost = grown + beside[side];
                best = child + side;
            }
        }
        Slot side = below[1] < below[0];
        if (below[0] == below[1]) {
            const double near0 = apart(box_at(child), box), near1 = apart(box_at(child + 1), box);
            side = near0 != near1 ? near1 < near0 : height_at(child + 1) < height_at(child);
        }
        if (best_cost < below[side])
            break;
        s = child + side;
        merged = beside[side];
    }
    return best;
}

std::uint64_t DynamicTree::attach(std::uint32_t item, const Box& box) {
    if (size_ == 0) {
        put(root, box, leaf_bit | item, 0);
        size_ = 1;
        return 1;
    }
    const std::uint32_t f = take_fork();
    ++size_;
    const auto [x, y, z] = half_extents(merge(box_at(root), box));
    pad_ = 0x1p-30 * (x + y + z);
    std::uint64_t nodes = 0;
    const Slot s = find_sibling(box, nodes);
    put(2 * f, box_at(s), link_at(s), height_at(s));
    put(2 * f + 1, box, leaf_bit | item, 0);
    node_pairs_[f].parent = s;
    link_at(s) = f;
    return nodes + repair(2 * f + 1);
}

std::uint64_t DynamicTree::detach(std::uint32_t item) {
    const Slot s = std::exchange(slot_of_[item], none);
    if (--size_ == 0)
        return 1;
    const Slot sibling = s ^ 1;
    const std::uint32_t f = s / 2;
    const Slot parent = node_pairs_[f].parent;
    put(parent, box_at(sibling), link_at(sibling), height_at(sibling));
    node_pairs_[f].parent = std::exchange(free_, f);
    return repair(parent);
}

/// Swaps a child of s (down) with a child of its sibling (up) if that makes the sibling smaller, or
/// leaves its size and makes s less tall: (down, (up, stay)) becomes (up, (down, stay)). Of the
/// four choices the one with the largest gain, then with the least height.
///
/// Both imbalances stay within max_imbalance, and the height of s within 1 of what it was before
/// the change below. So one level up again one child has changed by at most 1, and the imbalance
/// found there is at most max_imbalance + 1. Then a rotation is forced, and one that heals it is
/// always there: the taller child T of the taller sibling goes up. With d = height(down), T has
/// height d + max_imbalance and the child that stays one from d to d + max_imbalance: no imbalance
/// after the swap exceeds max_imbalance, and s is as tall as before or 1 less.
bool DynamicTree::rotate(Slot s, int old_height) {
    const std::uint32_t f = link_at(s);
    const NodePair& pair = node_pairs_[f];
    const bool force = imbalance(pair.height[0], pair.height[1]) > max_imbalance;
    double best_gain = force ? -std::numeric_limits<double>::infinity() : 0;
    int best_height = height_at(s);
    Slot best_down = none, best_up = none;
    for (const Slot side : {0u, 1u}) {
        const Slot down = 2 * f + side, sibling = down ^ 1;
        if (is_leaf(sibling))
            continue;
        const NodePair& below = node_pairs_[link_at(sibling)];
        const double size = measure(box_at(sibling));
        for (const Slot up : {0u, 1u}) {
            const Slot stay = up ^ 1;
            const int h_down = pair.height[side], h_up = below.height[up],
                      h_stay = below.height[stay], h_sibling = std::max(h_down, h_stay) + 1,
                      h = std::max(h_sibling, h_up) + 1;
            if (imbalance(h_down, h_stay) > max_imbalance ||
                imbalance(h_sibling, h_up) > max_imbalance || imbalance(h, old_height) > 1)
                continue;
            const double gain = size - measure(merge(box_at(down), below.box[stay]));
            if (gain > best_gain || (gain == best_gain && h < best_height)) {
                best_gain = gain;
                best_height = h;
                best_down = down;
                best_up = 2 * link_at(sibling) + up;
            }
        }
    }
    if (best_down == none)
        return false;
    const Box box = box_at(best_down);
    const std::uint32_t link = link_at(best_down);
    const std::uint8_t height = height_at(best_down);
    put(best_down, box_at(best_up), link_at(best_up), height_at(best_up));
    put(best_up, box, link, height);
    refit_upward(best_down ^ 1);
    refit_upward(s);
    return true;
}

void DynamicTree::refit_upward(Slot s) {
    const NodePair& pair = node_pairs_[link_at(s)];
    box_at(s) = merge(pair.box[0], pair.box[1]);
    height_at(s) = static_cast<std::uint8_t>(std::max(pair.height[0], pair.height[1]) + 1);
}

/// After a change at s: bounds, heights and rotations of the nodes above it. A rotation looks at
/// children and grandchildren, so that after two nodes in a row without change nothing above
/// differs.
std::uint64_t DynamicTree::repair(Slot s) {
    std::uint64_t nodes = 0;
    for (int quiet = 0; s != root && quiet < 2; ++nodes) {
        s = parent_of(s);
        const Box old_box = box_at(s);
        const std::uint8_t old_height = height_at(s);
        refit_upward(s);
        const bool changed = !(box_at(s) == old_box) || height_at(s) != old_height;
        quiet = rotate(s, old_height) || changed ? 0 : quiet + 1;
    }
    return nodes;
}

Buffer<std::uint32_t> DynamicTree::order() const {
    Buffer<std::uint32_t> items(size_);
    std::size_t n = 0;
    std::vector<std::uint32_t> stack;
    if (!empty())
        stack.push_back(link_at(root));
    while (!stack.empty()) {
        const std::uint32_t link = stack.back();
        stack.pop_back();
        if (link & leaf_bit) {
            items[n++] = link ^ leaf_bit;
        } else {
            const NodePair& pair = node_pairs_[link];
            for (const std::uint32_t below : pair.link)
                if (!(below & leaf_bit))
                    __builtin_prefetch(&node_pairs_[below]);
            stack.push_back(pair.link[1]);
            stack.push_back(pair.link[0]);
        }
    }
    return items;
}

Tree DynamicTree::to_tree() const {
    Tree tree(size_);
    if (empty())
        return tree;
    std::vector<Slot> stack{root};
    std::uint32_t leaves = 0;
    for (TreeNode& node : tree.nodes) {
        const Slot s = stack.back();
        stack.pop_back();
        node = {box_at(s), leaves, 1};
        if (is_leaf(s)) {
            tree.order[leaves++] = link_at(s) ^ leaf_bit;
        } else {
            node.count = 0;
            stack.push_back(2 * link_at(s) + 1);
            stack.push_back(2 * link_at(s));
        }
    }
    for (std::size_t i = tree.nodes.size(); i-- > 0;)
        if (tree.nodes[i].count == 0)
            tree.nodes[i].count = tree.nodes[Tree::left(i)].count + tree.nodes[tree.right(i)].count;
    return tree;
}

} // namespace boxwood
