#pragma once

#include "trees/buffer.h"
#include "trees/executor.h"
#include "trees/layouts/layouts.h"
#include "trees/tree.h"

#include <bit>
#include <span>
#include <string_view>

namespace boxwood {

/// An inner node of eight children in two cache lines. Each child box is kept as steps of a grid of
/// 255 cells per axis over the node's own bounds, rounded outward: a plane of q steps is at
///   fl(min + fl(q * scale)), in this order, in floats, never fused.
/// A decoded box contains the exact one; see quantised8.cpp for why.
struct alignas(64) QuantisedBlock {
    using Real = float;
    static constexpr std::uint32_t width = 8;

    std::uint32_t ref[8];     ///< 32 bytes: child references
    Box bounds;               ///< 24 bytes: exact
    float scale[3];           ///< 12 bytes: size of a step
    std::uint32_t count;      ///< children, from lane 0
    std::uint32_t items;      ///< number of items below
    std::uint8_t plane[6][8]; ///< 48 bytes: min x, y, z, then max x, y, z of each lane, in steps

    float decode(int axis, std::uint8_t steps) const {
        const float offset = static_cast<float>(steps) * scale[axis];
        return bounds.min[axis] + offset;
    }
    /// Of a lane in use.
    Box lane(std::size_t i) const {
        return {{decode(0, plane[0][i]), decode(1, plane[1][i]), decode(2, plane[2][i])},
                {decode(0, plane[3][i]), decode(1, plane[4][i]), decode(2, plane[5][i])}};
    }
};
static_assert(sizeof(QuantisedBlock) == 128);

/// A block of up to eight children within `bounds`, all but its references and items.
QuantisedBlock quantised(const Box& bounds, std::span<const Box> children);

/// Up to eight items with their exact boxes, seen where they lie: without gaps, 28 bytes per item
/// and 24 per leaf.
struct PackedLeaf {
    using Real = float;
    static constexpr std::uint32_t width = 8;

    /// plane[k * count + i] holds the bits of plane k of lane i; a load of eight is always safe.
    const std::uint32_t* plane;
    const std::uint32_t* ref; ///< items
    Box bounds;
    std::uint32_t count;

    Box lane(std::size_t i) const {
        const auto at = [&](std::size_t k) { return std::bit_cast<float>(plane[k * count + i]); };
        return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}};
    }
};

/// The eight-wide tree of Wide8Layout in two thirds of its memory: child boxes in 8 bits per
/// plane, item boxes exact and without gaps. Interface as WideLayout.
class Quantised8Layout {
  public:
    using Real = float;
    using Block = QuantisedBlock;
    using Leaf = PackedLeaf;
    static constexpr std::uint32_t width = 8;

    static constexpr std::string_view name = "quantised8";
    static constexpr std::string_view summary =
        "eight child boxes in 8 bits per plane, 128 bytes per node; exact item boxes without gaps";

    /// A child reference: the index of a block, or with the top bit set the index of a leaf.
    static constexpr std::uint32_t leaf_bit = 0x80000000u;
    static constexpr bool is_leaf(std::uint32_t ref) { return (ref & leaf_bit) != 0; }
    static constexpr std::uint32_t index(std::uint32_t ref) { return ref & ~leaf_bit; }

    Quantised8Layout(const Tree& tree, const Executor& executor);

    bool empty() const { return size_ == 0; }
    std::size_t size() const { return size_; }
    std::uint32_t root() const { return root_; }
    /// Those of all items; the tree must not be empty.
    Box bounds() const { return is_leaf(root_) ? leaf(root_).bounds : block(root_).bounds; }
    std::span<const Block> blocks() const { return blocks_.span(); }
    const Block& block(std::uint32_t ref) const { return blocks_[index(ref)]; }
    Leaf leaf(std::uint32_t ref) const {
        const std::uint32_t i = index(ref), first = first_slot_[i], n = first_slot_[i + 1] - first;
        const std::uint32_t* words = words_.data() + word_of(i, first);
        const auto at = [&](std::size_t k) { return std::bit_cast<float>(words[k]); };
        return {words + 6,
                words + 6 + 6 * std::size_t{n},
                {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}},
                n};
    }
    /// One more than the largest index of a leaf reference.
    std::size_t leaf_slots() const { return first_slot_.empty() ? 0 : first_slot_.size() - 1; }
    /// Most blocks on a path from the root to a leaf.
    std::size_t depth() const { return depth_; }
    std::size_t bytes() const { return blocks_.bytes() + words_.bytes() + first_slot_.bytes(); }

  private:
    /// Before leaf i lie i bounds of six words, and `slots` items of seven.
    static constexpr std::size_t word_of(std::size_t i, std::size_t slots) {
        return 6 * i + 7 * slots;
    }

    Buffer<Block> blocks_;
    Buffer<std::uint32_t> words_; ///< leaf after leaf: bounds, six planes, items; then eight spare
    Buffer<std::uint32_t> first_slot_; ///< leaf -> items in leaves before it; the last is size()
    std::size_t size_ = 0;
    std::size_t depth_ = 0;
    std::uint32_t root_ = leaf_bit;
};

} // namespace boxwood
