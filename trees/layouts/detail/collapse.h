#pragma once

#include "trees/executor.h"
#include "trees/tree.h"

namespace boxwood::detail {

/// A block of a wide tree before it is filled.
struct CollapsedBlock {
    std::uint32_t node;  ///< of the binary tree
    std::uint32_t first; ///< its first child; the others follow
    std::uint32_t count; ///< children; 0 in a leaf
};

/// A binary tree collapsed to a wide one whose blocks, inner ones and leaves, have the least area
/// in all; subtrees of at most `width` items become leaves. Block 0 is the root. Source: Ylitie,
/// Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs".
struct Collapsed {
    Buffer<CollapsedBlock> blocks;
    std::size_t depth = 0; ///< most blocks on a path from the root to a leaf
};

/// The same on every executor. width is 4, 8 or 16.
template <std::uint32_t width> Collapsed collapse(const Tree& tree, const Executor& executor);

extern template Collapsed collapse<4>(const Tree&, const Executor&);
extern template Collapsed collapse<8>(const Tree&, const Executor&);
extern template Collapsed collapse<16>(const Tree&, const Executor&);

} // namespace boxwood::detail
