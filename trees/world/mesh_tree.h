#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/rigid_transform.h"
#include "kernels/primitives/triangle.h"
#include "trees/buffer.h"
#include "trees/builder.h"
#include "trees/builders/binned_sah.h"
#include "trees/executor.h"
#include "trees/world/detail/bounding_sphere.h"
#include "trees/world/detail/obb_block.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace boxwood {

/// What the tree of a mesh is made of: boxes in any pose, or boxes along the mesh's axes, which are
/// quicker to make and take longer to search.
enum class MeshVolume : std::uint8_t { obb, aabb };

/// All of them by name, in one line; the default one first.
struct MeshVolumeEntry {
    std::string_view name, summary;
    MeshVolume volume;
};
std::span<const MeshVolumeEntry> mesh_volumes();

struct MeshTreeOptions {
    /// By default one that counts in whole leaves, as these hold eight triangles.
    BuildFunction builder =
        BinnedSahBuilder{.agglomerate_below = 8, .leaf_size = 8, .unsplit_below = 8};
    MeshVolume volume = MeshVolume::obb;
    const Executor* executor = nullptr; ///< the caller's thread, if none
};

/// A mesh for questions about pairs of meshes (mesh_pairs.h), in its own frame: eight boxes side by
/// side, leaves of up to eight triangles with corners of their own; about 120 bytes a triangle.
/// Throws InvalidBox for the first triangle with a coordinate that is not finite or is 2^60 or
/// more, and std::invalid_argument for a triangle with a vertex that is not there.
/// Threads: any number of them may query one MeshTree at the same time.
class MeshTree {
  public:
    explicit MeshTree(TriangleMesh mesh = {}, const MeshTreeOptions& options = {});

    const TriangleMesh& mesh() const { return mesh_; }
    std::size_t size() const { return mesh_.triangles.size(); } ///< triangles
    /// A triangle as a pose puts it: corners in doubles, rounded once.
    Triangle<double> triangle(std::uint32_t i, const RigidTransform<double>& pose) const {
        const Triangle<float> t = mesh_.triangle(i);
        return {pose(Vec3<double>(t.a)), pose(Vec3<double>(t.b)), pose(Vec3<double>(t.c))};
    }
    bool empty() const { return size() == 0; }
    std::size_t bytes() const { return blocks_.bytes() + leaves_.bytes(); } ///< without the mesh
    /// Of all triangles, in the mesh's frame; the mesh must not be empty.
    const Aabb<float>& bounds() const { return bounds_; }

    /// The parts beneath, for traversals.
    std::uint32_t root() const { return root_; }
    const detail::BoundingSphere& bounding_sphere() const { return bounding_sphere_; }
    std::size_t depth() const { return depth_; } ///< most blocks on a path from the root to a leaf
    std::span<const detail::ObbBlock> blocks() const { return blocks_.span(); }
    std::span<const detail::TriangleLeaf> leaves() const { return leaves_.span(); }
    const detail::ObbBlock& block(std::uint32_t ref) const { return blocks_[ref]; }
    const detail::TriangleLeaf& leaf(std::uint32_t ref) const {
        return leaves_[detail::index_of(ref)];
    }
    /// The box around what is below a block or in a leaf; not of an empty tree.
    const detail::PosedBox& own(std::uint32_t ref) const {
        return detail::is_leaf(ref) ? leaf(ref).own : block(ref).own;
    }

  private:
    TriangleMesh mesh_;
    Buffer<detail::ObbBlock> blocks_;
    Buffer<detail::TriangleLeaf> leaves_;
    Aabb<float> bounds_;
    detail::BoundingSphere bounding_sphere_;
    std::uint32_t root_ = detail::leaf_bit;
    std::size_t depth_ = 0;
};

} // namespace boxwood
