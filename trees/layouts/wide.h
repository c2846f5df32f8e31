#pragma once

#include "trees/buffer.h"
#include "trees/executor.h"
#include "trees/layouts/layouts.h"
#include "trees/tree.h"

#include <concepts>
#include <span>
#include <string_view>
#include <type_traits>

namespace boxwood {

/// W boxes side by side: an inner node's child boxes, or a leaf's items. Every traversal tests the
/// same in both: one box, point or ray against all lanes. W = 8 takes 256 bytes in floats, 512 in
/// doubles; 4 takes 144 and 16 takes 512.
template <class Real_, std::size_t W> struct alignas(W == 4 ? 16 : 64) BoxBlock {
    using Real = Real_;
    static constexpr std::uint32_t width = W;

    /// Min x, y, z, then max x, y, z of each lane. Unused lanes are (+inf, -inf): they overlap
    /// nothing and no ray hits them.
    Real plane[6][W];
    std::uint32_t ref[W]; ///< a child reference, or in a leaf the item
    Aabb<Real> bounds;    ///< bounds of all lanes
    std::uint32_t count;  ///< lanes in use, from lane 0
    std::uint32_t items;  ///< number of items below

    Aabb<Real> lane(std::size_t i) const {
        return {{plane[0][i], plane[1][i], plane[2][i]}, {plane[3][i], plane[4][i], plane[5][i]}};
    }
};

using Block8 = BoxBlock<float, 8>;
static_assert(sizeof(Block8) == 256 && sizeof(BoxBlock<double, 8>) == 512);
static_assert(sizeof(BoxBlock<float, 4>) == 144 && sizeof(BoxBlock<float, 16>) == 512);

/// W-wide tree: the binary tree collapsed so that its blocks have the least area in all; subtrees
/// of at most W items become leaf blocks. The children of a node lie side by side.
///
/// Traversals are templates over this interface, which Quantised8Layout has too: Real, width,
/// Block, Leaf, is_leaf, index, root, block, leaf, bounds, depth.
template <class Real_, std::size_t W> class WideLayout {
    static_assert(W == 4 || W == 8 || W == 16);

  public:
    using Real = Real_;
    using Block = BoxBlock<Real, W>; ///< what an inner reference leads to
    using Leaf = Block;              ///< what a leaf reference leads to
    static constexpr std::uint32_t width = W;

    static constexpr std::string_view name = std::is_same_v<Real, double> ? "wide8_f64"
                                             : W == 4                     ? "wide4"
                                             : W == 8                     ? "wide8"
                                                                          : "wide16";
    static constexpr std::string_view summary =
        std::is_same_v<Real, double>
            ? "eight boxes of doubles per 512-byte block; pairs of double boxes are exact"
        : W == 4 ? "four boxes per 144-byte block, tested together by SIMD; leaves of up to four"
        : W == 8
            ? "eight boxes per 256-byte block, tested together by SIMD; leaves of up to eight items"
            : "sixteen boxes per 512-byte block, one AVX-512 register per plane; leaves of up to "
              "sixteen items";

    /// A child reference: the index of a block, and the top bit set if that block is a leaf.
    static constexpr std::uint32_t leaf_bit = 0x80000000u;
    static constexpr bool is_leaf(std::uint32_t ref) { return (ref & leaf_bit) != 0; }
    static constexpr std::uint32_t index(std::uint32_t ref) { return ref & ~leaf_bit; }

    WideLayout(const Tree& tree, const Executor& executor);

    /// The tree's shape around these exact boxes of its items. Throws as exact_boxes.
    static WideLayout of_doubles(const Tree& tree, std::span<const Aabb<double>> boxes,
                                 const Executor& executor) requires std::same_as<Real, double>;

    bool empty() const { return blocks_.empty(); }
    /// Number of items.
    std::size_t size() const { return size_; }
    std::uint32_t root() const { return root_; }
    /// Those of all items; the tree must not be empty.
    const Aabb<Real>& bounds() const { return block(root_).bounds; }
    std::span<const Block> blocks() const { return blocks_.span(); }
    const Block& block(std::uint32_t ref) const { return blocks_[index(ref)]; }
    const Leaf& leaf(std::uint32_t ref) const { return blocks_[index(ref)]; }
    /// One more than the largest index of a leaf reference.
    std::size_t leaf_slots() const { return blocks_.size(); }
    /// Most blocks on a path from the root to a leaf.
    std::size_t depth() const { return depth_; }
    std::size_t bytes() const { return blocks_.bytes(); }

  private:
    WideLayout() = default;
    template <class BoxOf> void make(const Tree& tree, const Executor& executor, const BoxOf& box);

    Buffer<Block> blocks_;
    std::size_t size_ = 0;
    std::size_t depth_ = 0;
    std::uint32_t root_ = leaf_bit;
};

/// WideLayout of any kind, and Quantised8Layout.
template <class L>
concept WideTree = requires(const L tree, std::uint32_t ref) {
    typename L::Real;
    tree.block(ref);
    tree.leaf(ref);
    tree.leaf_slots();
};

extern template class WideLayout<float, 4>;
extern template class WideLayout<float, 8>;
extern template class WideLayout<float, 16>;
extern template class WideLayout<double, 8>;

} // namespace boxwood
