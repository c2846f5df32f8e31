#pragma once

#include "trees/inspect/work.h"
#include "trees/tree.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace boxwood {

/// A binary tree of boxes that takes insertions, removals and moves one at a time, in O(log n)
/// each: greedy surface-area insertion, then rotations on the way up; every box is exactly tight.
/// Items are numbered by the caller, best without large gaps: 4 bytes are kept for every number up
/// to the highest. The same calls in the same order give the same tree everywhere.
///
/// Sources: Bittner, Hapala and Havran 2015 (incremental insertion); Box2D 3 (greedy search); Kopta
/// et al. 2012 (rotations). The bound on the height is that of a relaxed AVL tree.
class DynamicTree {
  public:
    using Real = float;
    static constexpr std::string_view name = "dynamic";

    /// Makes room for n items, so that insertions of items 0 .. n - 1 need no memory.
    void reserve(std::size_t n);

    /// Throws InvalidBox for a box with a NaN, an infinity or min > max, std::invalid_argument for
    /// an item that is in the tree already, and std::length_error for an item of max_items or more.
    void insert(std::uint32_t item, Box box);

    /// Throws std::invalid_argument for an item that is not in the tree.
    void remove(std::uint32_t item);

    /// Gives the item a new box: in its place while the bounds of its grandparent hold that, else
    /// by insertion again. The nodes looked at are added to `work`, if given. Throws as `insert`
    /// and `remove` do.
    void move(std::uint32_t item, Box box, Work* work = nullptr);

    /// Gives the item a box that holds its old one; the shape stays, bounds above grow. Cheaper
    /// than `move`. Throws as it, and std::invalid_argument for a box that does not hold the old
    /// one.
    void enlarge(std::uint32_t item, Box box);

    /// Forgets all items and keeps the memory.
    void clear();

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    bool contains(std::uint32_t item) const {
        return item < slot_of_.size() && slot_of_[item] != none;
    }

    /// The item's box. Throws std::invalid_argument for an item that is not in the tree.
    const Box& box(std::uint32_t item) const;

    /// Edges from the root to the deepest leaf, at most 3.5 log2(size()) after any history.
    std::size_t height() const { return empty() ? 0 : height_at(root); }

    /// Memory held, in bytes.
    std::size_t bytes() const {
        return node_pairs_.capacity() * sizeof(NodePair) +
               slot_of_.capacity() * sizeof(std::uint32_t);
    }

    // Its nodes, for traversals: as those of TreeOf, numbered by where they are, the root being 0.

    bool is_leaf(std::uint32_t node) const { return (link_at(node) & leaf_bit) != 0; }
    std::uint32_t left(std::uint32_t node) const { return 2 * link_at(node); }
    std::uint32_t right(std::uint32_t node) const { return 2 * link_at(node) + 1; }
    std::uint32_t item(std::uint32_t leaf) const { return link_at(leaf) ^ leaf_bit; }
    const Box& bounds(std::uint32_t node) const { return box_at(node); }
    const Box& bounds() const { return box_at(root); }
    /// About so many, as if it were balanced: 1 of a leaf alone.
    std::size_t items_below(std::uint32_t node) const {
        return std::size_t{1} << std::min<int>(height_at(node), 30);
    }
    /// Nodes on the longest path from the root to a leaf.
    std::size_t depth() const { return empty() ? 0 : height() + 1; }

    /// The items in the order of the leaves. O(n).
    Buffer<std::uint32_t> order() const;

    /// The canonical tree of the items as they are now; `order` holds their own numbers, so that
    /// `refit` and `validate` take it only if these are 0 .. size() - 1. O(n).
    Tree to_tree() const;

  private:
    /// A place for a node: slot 2 f + side is that side of node pair f. The node at a slot, its box
    /// and its height are kept there, so that a descent reads one cache line per level.
    using Slot = std::uint32_t;

    /// The two children of an inner node: 64 bytes. NodePair 0 is the exception: its side 0 holds
    /// the root, which has no sibling. A free pair holds the number of the next free one in
    /// `parent`.
    struct alignas(64) NodePair {
        Box box[2];             ///< 48 bytes
        std::uint32_t link[2];  ///< 8 bytes: the node pair of an inner node, or leaf_bit + item
        Slot parent;            ///< 4 bytes: where the node with these children is
        std::uint8_t height[2]; ///< 2 bytes: edges to the deepest leaf below, 0 for a leaf
        std::uint8_t unused[2]; ///< 2 bytes
    };
    static_assert(sizeof(NodePair) == 64);

    static constexpr Slot root = 0;
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    static constexpr std::uint32_t leaf_bit = std::uint32_t{1} << 31;

    Box& box_at(Slot s) { return node_pairs_[s / 2].box[s % 2]; }
    const Box& box_at(Slot s) const { return node_pairs_[s / 2].box[s % 2]; }
    std::uint32_t& link_at(Slot s) { return node_pairs_[s / 2].link[s % 2]; }
    std::uint32_t link_at(Slot s) const { return node_pairs_[s / 2].link[s % 2]; }
    std::uint8_t& height_at(Slot s) { return node_pairs_[s / 2].height[s % 2]; }
    std::uint8_t height_at(Slot s) const { return node_pairs_[s / 2].height[s % 2]; }
    Slot parent_of(Slot s) const { return s == root ? root : node_pairs_[s / 2].parent; }

    /// An eighth of the surface area, xy + yz + zx for half-extents x, y, z, plus pad (x + y + z),
    /// lest boxes on one line all look the same.
    double measure(const Box& box) const;

    Slot require(std::uint32_t item) const;
    std::uint32_t take_fork();
    void put(Slot s, const Box& box, std::uint32_t link, std::uint8_t height);
    // Those that say so return how many nodes they looked at.
    std::uint64_t attach(std::uint32_t item, const Box& box);
    std::uint64_t detach(std::uint32_t item);
    Slot find_sibling(const Box& box, std::uint64_t& nodes) const;
    std::uint64_t repair(Slot s);
    void refit_upward(Slot s);
    bool rotate(Slot s, int old_height);

    std::vector<NodePair> node_pairs_ = std::vector<NodePair>(1); ///< pair 0 is always there
    std::vector<Slot> slot_of_;                                   ///< item -> its leaf, or none
    std::uint32_t free_ = none;                                   ///< first free pair
    std::size_t size_ = 0;
    double pad_ = 0; ///< for measure: 2^-30 of the half-extents of the root, summed
};

} // namespace boxwood
