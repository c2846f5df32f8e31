#pragma once

#include "trees/layout.h"

namespace boxwood {

/// A block of up to eight boxes side by side, 256 bytes: an inner node's child boxes, or a leaf's
/// items. Every walk asks the same of both: one box (or ray) against eight.
struct alignas(64) Block8 {
    float plane[6][8];    ///< 192 bytes: min x, y, z, then max x, y, z of each lane. Unused lanes
                          ///< are (+inf, -inf): they overlap nothing and no ray hits them
    std::uint32_t ref[8]; ///< 32 bytes: a child reference, or in a leaf the item
    Box bounds;           ///< 24 bytes: bounds of all lanes
    std::uint32_t count;  ///< lanes in use, from lane 0; 4 bytes unused

    Box lane(std::uint32_t i) const {
        return {{plane[0][i], plane[1][i], plane[2][i]}, {plane[3][i], plane[4][i], plane[5][i]}};
    }
};
static_assert(sizeof(Block8) == 256);

/// Eight-wide tree: the binary tree collapsed, always opening the child of the largest area;
/// subtrees of at most eight items become leaf blocks. The children of a node lie side by side.
class Wide8Layout {
  public:
    static constexpr std::string_view name = "wide8";
    static constexpr std::string_view summary =
        "eight boxes per 256-byte block, tested together by SIMD; leaves of up to eight items";

    /// A child reference: the index of a block, and the top bit set if that block is a leaf.
    static constexpr std::uint32_t leaf_bit = 0x80000000u;
    static constexpr bool is_leaf(std::uint32_t ref) { return (ref & leaf_bit) != 0; }
    static constexpr std::uint32_t index(std::uint32_t ref) { return ref & ~leaf_bit; }

    Wide8Layout(const Tree& tree, const Executor& executor);

    bool empty() const { return blocks_.empty(); }
    std::size_t size() const { return size_; }
    std::uint32_t root() const { return root_; }
    std::span<const Block8> blocks() const { return blocks_.span(); }
    const Block8& block(std::uint32_t ref) const { return blocks_[index(ref)]; }
    /// Most blocks on a path from the root to a leaf.
    std::size_t depth() const { return depth_; }
    std::size_t bytes() const { return blocks_.bytes(); }

  private:
    Buffer<Block8> blocks_;
    std::size_t size_ = 0;
    std::size_t depth_ = 0;
    std::uint32_t root_ = leaf_bit;
};

} // namespace boxwood
