#pragma once

#include "trees/buffer.h"
#include "trees/executor.h"
#include "trees/layouts/layouts.h"
#include "trees/tree.h"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace boxwood {

namespace detail {
struct PackedSource;
}

/// Sixteen boxes side by side, 384 bytes: one AVX-512 register per plane.
struct alignas(64) PackedBlock {
    using Real = float;
    static constexpr std::uint32_t width = 16;

    /// Min x, y, z, then max x, y, z of each lane. Unused lanes are (+inf, -inf): they overlap
    /// nothing and no ray hits them.
    float plane[6][width];

    Box lane(std::size_t i) const {
        return {{plane[0][i], plane[1][i], plane[2][i]}, {plane[3][i], plane[4][i], plane[5][i]}};
    }
};
static_assert(sizeof(PackedBlock) == 384);

/// A block as traversals of wide layouts see it (BoxBlock in wide.h): what is not stored follows
/// from where the block is.
struct PackedView {
    using Real = float;
    static constexpr std::uint32_t width = PackedBlock::width;

    /// The items of a leaf, or of an inner block the references that count up from `first`.
    struct Refs {
        const std::uint32_t* items; ///< null in an inner block
        std::uint32_t first;
        std::uint32_t operator[](std::size_t i) const {
            return items ? items[i] : first + static_cast<std::uint32_t>(i);
        }
    };

    const PackedBlock* planes;
    Refs ref;
    std::uint32_t count; ///< lanes in use, from lane 0

    Box lane(std::size_t i) const { return planes->lane(i); }
};

/// The items in a given order, cut every sixteen; the bounds of sixteen blocks make a block of the
/// level above, up to one block. Where a block's children are follows from where it is.
class PackedLayout {
  public:
    using Real = float;
    static constexpr std::uint32_t width = PackedBlock::width;
    static constexpr std::string_view name = "packed";
    static constexpr std::string_view summary =
        "the items in the builder's order, cut every sixteen, without pointers; needs no tree";

    /// Nothing.
    PackedLayout() = default;
    static std::uint32_t lanes_used(std::size_t first, std::size_t n) {
        return n - first < width ? static_cast<std::uint32_t>(n - first) : width;
    }

    /// The boxes of the tree's leaves, in its order.
    PackedLayout(const Tree& tree, const Executor& executor);

    /// Slot i holds item order[i] and its box; the boxes are valid. Throws std::invalid_argument
    /// unless there are as many boxes as entries.
    static PackedLayout of_order(Boxes boxes, std::span<const std::uint32_t> order,
                                 const Executor& executor);

    bool empty() const { return size_ == 0; }
    /// Number of slots.
    std::size_t size() const { return size_; }
    /// Most blocks on a path from the root to a leaf: the number of levels.
    std::size_t depth() const { return depth_; }
    /// Those of all items; there must be some.
    const Box& bounds() const { return bounds_; }
    std::size_t bytes() const { return blocks_.bytes() + items_.bytes(); }

    // What traversals read of any wide layout.
    using Block = PackedView;
    using Leaf = PackedView;
    /// A reference: the index of a block, leaves first, and the top bit set if it is a leaf.
    static constexpr std::uint32_t leaf_bit = 0x80000000u;
    static constexpr bool is_leaf(std::uint32_t ref) { return (ref & leaf_bit) != 0; }
    static constexpr std::uint32_t index(std::uint32_t ref) { return ref & ~leaf_bit; }
    std::uint32_t root() const {
        return depth_ > 1 ? static_cast<std::uint32_t>(blocks_.size() - 1) : leaf_bit;
    }
    PackedView block(std::uint32_t ref) const {
        std::size_t l = 1;
        while (ref >= first_[l + 1])
            ++l;
        const std::size_t child = (ref - first_[l]) * width;
        return {
            &blocks_[ref],
            {nullptr, static_cast<std::uint32_t>(first_[l - 1] + child) | (l == 1 ? leaf_bit : 0)},
            lanes_used(child, level(l - 1).size())};
    }
    PackedView leaf(std::uint32_t ref) const {
        const std::size_t slot = std::size_t{index(ref)} * width;
        return {&blocks_[index(ref)], {&items_[slot], 0}, lanes_used(slot, size_)};
    }
    /// One more than the largest index of a leaf reference.
    std::size_t leaf_slots() const { return first_[1]; }

    /// The blocks of a level; level 0 is that of the leaves, whose lanes are the slots. Lane i of
    /// block b bounds block 16 b + i of the level below.
    std::span<const PackedBlock> level(std::size_t l) const {
        return {blocks_.data() + first_[l], first_[l + 1] - first_[l]};
    }
    /// slot -> item; whole blocks, 0 beyond size().
    std::span<const std::uint32_t> items() const { return items_.span(); }

    // For boxes that move; the memory is used again.

    /// Becomes of_order(boxes, order).
    void take(Boxes boxes, std::span<const std::uint32_t> order, const Executor& executor);
    /// New boxes for the items where they are: all of them; or those in these slots, and of the
    /// blocks above those that change.
    void refit(Boxes boxes, const Executor& executor);
    void refit(Boxes boxes, std::span<const std::uint32_t> slots);
    /// Sum of half the surface areas of all blocks but the root's, over that of the root: what a
    /// traversal has to pass. 0 if the root has none.
    double surface() const;
    /// The first block whose bounds are not exactly those of its lanes, or an unused lane that is
    /// not empty; empty if all is as it should be. O(n).
    std::string fault() const;

  private:
    void hold(std::size_t n);
    /// `order` becomes the items; it may be where they are.
    void make(const detail::PackedSource& boxes, std::span<const std::uint32_t> order,
              const Executor& executor);

    // 16^8 > max_items: there are at most eight levels.
    static constexpr std::size_t max_levels = 8;
    Buffer<PackedBlock> blocks_; ///< leaves first
    Buffer<std::uint32_t> items_;
    std::array<std::size_t, max_levels + 1> first_{}; ///< first block of each level
    std::size_t size_ = 0, depth_ = 0;
    Box bounds_;
};

} // namespace boxwood
