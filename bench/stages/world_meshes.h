#pragma once

#include "bench/stages/playing.h"
#include "trees/buffer.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boxwood::bench {

/// A mesh as a body carries it, in the scene, and a tree of its triangles. Vertices are rounded to
/// floats: these are what all queries are about. Made when it is first wanted.
struct WorldMesh {
    static constexpr std::uint64_t never = ~std::uint64_t{0};

    std::uint32_t body = 0;
    std::vector<Vec3<float>> vertices;
    PackedLayout tree;
    std::uint64_t vertices_of = never, tree_of = never; ///< frames for which they were made
};

/// The world meshes of the bodies that have a mesh. A body's is up to date if it was wanted in this
/// frame.
class WorldMeshes {
  public:
    explicit WorldMeshes(const Bodies& bodies);

    bool has(std::uint32_t body) const { return index_[body] != none; }
    const WorldMesh& of(std::uint32_t body) const { return meshes_[index_[body]]; }

    /// Notes which bodies the frame has changed.
    void note(std::span<const std::uint32_t> changed, std::uint64_t frame);
    /// Whether neither of these bodies, which have meshes, has changed since that frame.
    bool rests(Pair bodies, std::uint64_t frame) const {
        return changed_in_[index_[bodies.a]] <= frame && changed_in_[index_[bodies.b]] <= frame;
    }
    /// The meshes of the bodies in a pair of which both have a mesh, each once; of all if
    /// `full`. They stay listed until the next call.
    std::span<const std::uint32_t> want(std::span<const Pair> pairs, bool full);

    /// Brings the vertices of those wanted up to date; gives the number of vertices moved.
    std::size_t transform(const Bodies& bodies, bool full, const Executor& executor);
    /// The same with their trees, and triangles. A tree keeps the order of its first frame, that of
    /// the mesh in its own frame, and is refitted.
    std::size_t update_trees(const Bodies& bodies, bool full, const Executor& executor);

    std::size_t vertex_bytes() const;
    std::size_t tree_bytes() const;

  private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    std::vector<std::uint32_t> index_; ///< by body
    std::vector<WorldMesh> meshes_;
    std::vector<std::uint64_t> changed_in_; ///< by mesh body: the last frame that changed it
    std::vector<std::uint8_t> is_wanted_;   ///< by mesh body
    std::vector<std::uint32_t> wanted_, stale_;
    std::vector<Buffer<std::uint32_t>> orders_; ///< by mesh: triangles along a curve, once wanted
};

} // namespace boxwood::bench
