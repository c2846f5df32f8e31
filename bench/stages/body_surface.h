#pragma once

#include "scenes/moving/bodies.h"
#include "trees/dynamic/order_degradation.h"
#include "trees/dynamic/ray_refit.h"
#include "trees/layout.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// The two triangles of each side of a box, by its corners: bit 0 of a corner's number is x, bit 1
/// y, bit 2 z, set if it lies at the maximum.
inline constexpr std::array<std::array<std::uint32_t, 3>, 12> box_triangles{{{0, 2, 1},
                                                                             {1, 2, 3},
                                                                             {4, 5, 6},
                                                                             {5, 7, 6},
                                                                             {0, 1, 4},
                                                                             {1, 5, 4},
                                                                             {2, 6, 3},
                                                                             {3, 6, 7},
                                                                             {0, 4, 2},
                                                                             {2, 4, 6},
                                                                             {1, 3, 5},
                                                                             {3, 7, 5}}};

/// The triangles of a body, by its vertices or the corners of its box.
std::span<const std::array<std::uint32_t, 3>> own_triangles(const Bodies& bodies,
                                                            std::uint32_t body);

/// The triangles of some bodies in floats, as they stand in the scene, and a tree of them for rays.
/// Absent bodies have none.
class BodySurface {
  public:
    /// Of these bodies, ascending. `moves`: a tree that is soon made, and can follow them; else one
    /// made with care, which rays soon pass.
    BodySurface(const Bodies& bodies, std::vector<std::uint32_t> of, bool moves,
                const Executor& executor);

    /// Some of the bodies have changed. Their triangles are written where they are and the tree is
    /// refitted; it is rebuilt if bodies have come or gone, or once it is so loose that for so
    /// many rays a frame it pays. Gives the number of triangles written.
    std::size_t follow(const Bodies& bodies, std::span<const std::uint32_t> changed,
                       std::size_t rays, const Executor& executor);

    /// Nearest hits, ties to the lowest body and then to its lowest triangle: the triangles are
    /// numbered body by body.
    void hits(std::span<const Ray<float>> rays, const Executor& executor,
              std::span<RayHit> out) const;
    /// The body of a triangle, and its triangle of this number.
    std::pair<std::uint32_t, std::uint32_t> place_of(std::uint32_t triangle) const;

    const TriangleMesh& mesh() const { return mesh_; }
    std::size_t bytes() const;

  private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    void make(const Bodies& bodies, const Executor& executor);
    void write_vertices(const Bodies& bodies, std::size_t at);

    bool moves_;
    std::vector<std::uint32_t> of_;             ///< bodies, ascending
    std::vector<std::uint32_t> place_;          ///< by body: in of_, or none; if it moves
    std::vector<std::uint32_t> first_vertex_;   ///< by place, and the number of all
    std::vector<std::uint32_t> first_triangle_; ///< the same
    TriangleMesh mesh_;
    std::unique_ptr<AnyLayout> layout_; ///< of the bodies as they stood when it was made
    TriangleBlocks blocks_;             ///< of the bodies as they stand
    RayRefit refit_;
    OrderDegradation degradation_;
    bool has_degradation_ = false;
    double fresh_ = 0; ///< surface of the tree when it was made
};

} // namespace boxwood::bench
