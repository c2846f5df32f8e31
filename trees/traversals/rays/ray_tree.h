#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/ray_triangle/triangle_block.h"
#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"
#include "trees/traversals/rays/ray_range.h"

#include <type_traits>

namespace boxwood::detail {

/// W child boxes side by side, and where they lead: all that a ray reads of an inner node. 128, 256
/// and 448 bytes for W = 4, 8 and 16.
template <std::size_t W> struct alignas(64) RayNode {
    static constexpr std::uint32_t width = W;
    float plane[6][W];    ///< min x, y, z, then max x, y, z of each lane; unused: (+inf, -inf)
    std::uint32_t ref[W]; ///< ray_refs; 0 in unused lanes
};
static_assert(sizeof(RayNode<4>) == 128 && sizeof(RayNode<8>) == 256);

/// A reference is the index of a node, or with `leaf` that of a block of triangles; with `two` the
/// block after it belongs to the same leaf.
namespace ray_refs {
inline constexpr std::uint32_t leaf = 0x80000000u, two = 0x40000000u;
constexpr bool is_leaf(std::uint32_t ref) { return (ref & leaf) != 0; }
constexpr std::uint32_t index(std::uint32_t ref) { return ref & ~(leaf | two); }
} // namespace ray_refs

/// The nodes that rays visit in the layout L: its own for the quantised one; floats rounded outward
/// for doubles.
template <class L>
using RayNodeOf =
    std::conditional_t<std::is_same_v<L, Quantised8Layout>, QuantisedBlock, RayNode<L::width>>;

/// Leaves of four items and fewer are tested four at a time.
template <class Node> inline constexpr std::size_t ray_lanes = Node::width == 4 ? 4 : 8;
template <class Node> using RayBlock = TriangleBlock<ray_lanes<Node>>;

} // namespace boxwood::detail
