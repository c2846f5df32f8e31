#pragma once

#include "kernels/primitives/triangle.h"
#include "trees/queries/rays.h"
#include "trees/traversals/rays/ray_tree.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boxwood {

/// Keeps what rays read of a layout true to a mesh whose vertices move: triangles stay in their
/// leaves, and the boxes above them are made exact again where they change. Answers are then those
/// of a new layout. For layouts of sixteen lanes: packed and wide16.
class RayRefit {
  public:
    /// Notes where each of so many triangles is: in one leaf each.
    void start(const TriangleBlocks& tree, std::size_t triangles);
    /// The corners of the triangles [first, last) are others.
    void note(std::size_t first, std::size_t last);
    /// Brings the tree that it was started with up to what the mesh is now. The same on every
    /// executor. Throws as triangles_of.
    void refit(TriangleBlocks& tree, const TriangleMesh& mesh, const Executor& executor);

    /// Sum of half the surface areas of all boxes but the root's, over that of the root: what a ray
    /// has to pass. 0 if the root has none.
    static double surface(const TriangleBlocks& tree);
    std::size_t bytes() const;

  private:
    static constexpr std::size_t W = 16;
    using Node = detail::RayNode<W>;
    using Block = detail::RayBlock<Node>;
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    std::vector<std::uint32_t> leaf_of_;    ///< by triangle: the first block of its leaf
    std::vector<std::uint32_t> above_;      ///< by first block of a leaf: node * W + lane, or none
    std::vector<std::uint32_t> above_node_; ///< by node: the same
    std::vector<std::uint8_t> is_noted_;    ///< by first block of a leaf
    std::vector<std::uint8_t> is_stale_;    ///< by node: a lane has changed
    std::vector<std::uint32_t> leaves_;     ///< those noted
};

} // namespace boxwood
